//! Lines without the points that nobody could see: a picture's size follows its shape, not the number of samples.

/// Farthest that a left-out point may lie from the line [px].
const LEAST_PX: f64 = 0.3;

/// The line less the points that lie on it; `pixel` is the size of a pixel in both units. After Douglas and Peucker.
pub(super) fn simplified(points: Vec<(f64, f64)>, pixel: (f64, f64)) -> Vec<(f64, f64)> {
    if points.len() < 3 {
        return points;
    }
    let mut kept = vec![false; points.len()];
    kept[0] = true;
    kept[points.len() - 1] = true;
    let mut spans = vec![(0, points.len() - 1)];
    while let Some((first, last)) = spans.pop() {
        let mut farthest = (LEAST_PX, 0);
        for index in first + 1..last {
            let distance = distance_px(points[index], points[first], points[last], pixel);
            if distance > farthest.0 {
                farthest = (distance, index);
            }
        }
        let (_, index) = farthest;
        if index > 0 {
            kept[index] = true;
            spans.extend([(first, index), (index, last)]);
        }
    }
    points.into_iter().zip(kept).filter_map(|(point, kept)| kept.then_some(point)).collect()
}

/// From a point to the stretch between two others.
fn distance_px(point: (f64, f64), from: (f64, f64), to: (f64, f64), pixel: (f64, f64)) -> f64 {
    let px = |a: (f64, f64), b: (f64, f64)| ((a.0 - b.0) / pixel.0, (a.1 - b.1) / pixel.1);
    let (along, off) = (px(to, from), px(point, from));
    let length2 = along.0 * along.0 + along.1 * along.1;
    let share = if length2 > 0.0 { ((off.0 * along.0 + off.1 * along.1) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (off.0 - share * along.0).hypot(off.1 - share * along.1)
}

#[cfg(test)]
mod tests {
    use super::simplified;

    #[test]
    fn closed_form_straight_lines_keep_their_ends_and_peaks_stay() {
        let mut line: Vec<(f64, f64)> = (0..1000).map(|k| (f64::from(k), 2.0 * f64::from(k))).collect();
        assert_eq!(simplified(line.clone(), (1.0, 1.0)).len(), 2);
        line[500].1 += 50.0;
        let kept = simplified(line.clone(), (1.0, 1.0));
        assert!(kept.len() == 5 && kept.contains(&line[500]));
    }
}
