//! Dashed lines.

use super::axis::along;

/// A line cut into dashes along its length.
pub(super) fn dashes(places: &[(i32, i32)], dash: Option<(i32, i32)>) -> Vec<Vec<(i32, i32)>> {
    let Some((on, off)) = dash else { return vec![places.to_vec()] };
    let (on, off) = (f64::from(on), f64::from(off));
    let mut pieces = Vec::new();
    let mut piece: Vec<(i32, i32)> = Vec::new();
    // Length that is left of the dash or the gap under way.
    let (mut drawing, mut left) = (true, on);
    for pair in places.windows(2) {
        let length = f64::from(pair[1].0 - pair[0].0).hypot(f64::from(pair[1].1 - pair[0].1));
        let at = |done: f64| (along(done / length, pair[0].0, pair[1].0), along(done / length, pair[0].1, pair[1].1));
        let mut done = 0.0;
        if drawing && piece.is_empty() {
            piece.push(pair[0]);
        }
        while length - done > left {
            done += left;
            if drawing {
                piece.push(at(done));
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece.push(at(done));
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        left -= length - done;
        if drawing {
            piece.push(pair[1]);
        }
    }
    pieces.push(piece);
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

#[cfg(test)]
mod tests {
    use super::dashes;

    #[test]
    fn closed_form_dashes_share_a_line() {
        let pieces = dashes(&[(0, 0), (15, 0), (30, 0)], Some((8, 4)));
        assert_eq!(pieces, [vec![(0, 0), (8, 0)], vec![(12, 0), (15, 0), (20, 0)], vec![(24, 0), (30, 0)]]);
    }
}
