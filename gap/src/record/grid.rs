//! The even grid that the rows of a log stand on.
//!
//! ```text
//! place of a row = place of the one before + round(interval / period)
//! time = first + period place                    least squares: jitter of the stamps leaves of the period what it should
//! ```
//!
//! The median of jittered intervals is off by the jitter over the root of their number: over a whole log, by rows.

/// Where the rows of a log stand.
pub(super) struct Grid {
    places: Vec<usize>,
    /// Rows of the grid.
    pub(super) rows: usize,
    /// Those that the log does not have.
    pub(super) filled: usize,
    /// Time between two rows [s].
    pub(super) period_s: f64,
}

/// What the period is off by at least, over itself, to be another.
const OFF: f64 = 1e-6;
/// And at most: the log has no rate.
const FAR_OFF: f64 = 0.02;

impl Grid {
    /// Of the time stamps, about this far apart.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
    pub(super) fn new(time: &[f64], median_s: f64) -> Self {
        let (first_s, period_s) = line(time, median_s);
        let places: Vec<usize> =
            time.iter().map(|time| ((time - first_s) / period_s).round().max(0.0) as usize).collect();
        let rows = places.last().map_or(0, |last| last + 1).min(20 * time.len().max(1));
        Self { filled: rows.saturating_sub(time.len()), places, rows, period_s }
    }

    /// Values on the grid; NaN where there is none.
    pub(super) fn place(&self, values: &[f64]) -> Vec<f64> {
        let mut placed = vec![f64::NAN; self.rows];
        for (place, value) in self.places.iter().zip(values) {
            if let Some(slot) = placed.get_mut(*place) {
                *slot = *value;
            }
        }
        placed
    }
}

/// Time of the first row and period of the grid [s].
fn line(time: &[f64], median_s: f64) -> (f64, f64) {
    let first_s = time.first().copied().unwrap_or(0.0);
    let mut place = 0.0;
    let mut sums = [0.0; 4];
    let mut last_s = first_s;
    for &time_s in time {
        place += ((time_s - last_s) / median_s).round();
        last_s = time_s;
        let since_s = time_s - first_s;
        for (sum, value) in sums.iter_mut().zip([place, since_s, place * place, place * since_s]) {
            *sum += value;
        }
    }
    let rows = time.len().max(1) as f64;
    let [places, times, squares, products] = sums;
    let period_s = (rows * products - places * times) / (rows * squares - places * places);
    let off = (period_s / median_s - 1.0).abs();
    if (OFF..FAR_OFF).contains(&off) {
        (first_s + (times - period_s * places) / rows, period_s)
    } else {
        (first_s, median_s)
    }
}

/// Straight lines over missing samples.
pub(super) fn filled(values: &[f64]) -> Vec<f64> {
    let mut out = values.to_vec();
    let mut last: Option<usize> = None;
    for k in 0..out.len() {
        if !out[k].is_finite() {
            continue;
        }
        match last {
            None => {
                let value = out[k];
                out[..k].fill(value);
            }
            Some(from) if k > from + 1 => {
                for between in from + 1..k {
                    let share = (between - from) as f64 / (k - from) as f64;
                    out[between] = out[from] + share * (out[k] - out[from]);
                }
            }
            Some(_) => {}
        }
        last = Some(k);
    }
    match last {
        Some(from) => {
            let value = out[from];
            out[from..].fill(value);
        }
        None => out.fill(0.0),
    }
    out
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::Grid;

    #[test]
    fn no_row_of_a_long_log_with_jittered_stamps_leaves_its_place() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mut stamp = |k: u32| f64::from(k) * 5e-4 + 3e-6 * (rng.random::<f64>() - 0.5);
        let time: Vec<f64> = (0..60_000).filter(|k| *k != 30_000).map(&mut stamp).collect();
        // as far off as the median of a thousand intervals may be
        let grid = Grid::new(&time, 5e-4 * (1.0 + 2e-4));
        assert!((grid.period_s / 5e-4 - 1.0).abs() < 1e-7);
        assert_eq!((grid.rows, grid.filled), (60_000, 1));
        let placed = grid.place(&time);
        assert!(placed[30_000].is_nan());
        let worst =
            placed.iter().enumerate().filter(|(k, _)| *k != 30_000).map(|(k, at_s)| (at_s - 5e-4 * k as f64).abs());
        assert!(worst.fold(0.0, f64::max) < 2e-6);
    }
}
