//! White noise of a series, whatever else there is.

use std::ops::Range;

/// Rows of a block.
const BLOCK: usize = 500;
/// Power of the third differences of white noise over its own, `1 + 9 + 9 + 1`.
const OF_NOISE: f64 = 20.0;

/// Rms of white noise from third differences.
pub(crate) fn rough(values: &[f64], valid: &[bool]) -> f64 {
    let mut steps: Vec<f64> = third_differences(values, valid, 3..values.len()).map(f64::abs).collect();
    if steps.is_empty() {
        return 1.0;
    }
    let middle = steps.len() / 2;
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    (*median / 0.6745 / OF_NOISE.sqrt()).max(1e-12)
}

/// Power of white noise from third differences, tails and all: the median of what blocks have.
pub(crate) fn tails(values: &[f64], valid: &[bool]) -> f64 {
    let power = |from: usize| -> Option<f64> {
        let rows = from + 3..(from + BLOCK).min(values.len());
        let squares: Vec<f64> =
            third_differences(values, valid, rows).map(|difference| difference.powi(2) / OF_NOISE).collect();
        (2 * squares.len() > BLOCK).then(|| squares.iter().sum::<f64>() / squares.len() as f64)
    };
    let mut powers: Vec<f64> = (0..values.len()).step_by(BLOCK).filter_map(power).collect();
    powers.sort_by(f64::total_cmp);
    powers.get(powers.len() / 2).copied().unwrap_or(0.0)
}

/// Those that end in some rows, as far as all their samples count.
fn third_differences<'a>(
    values: &'a [f64],
    valid: &'a [bool],
    rows: Range<usize>,
) -> impl Iterator<Item = f64> + use<'a> {
    rows.filter(|&k| valid[k - 3..=k].iter().all(|valid| *valid))
        .map(|k| values[k] - 3.0 * values[k - 1] + 3.0 * values[k - 2] - values[k - 3])
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{StandardNormal, StudentT};

    use super::{rough, tails};

    #[test]
    fn closed_form_noise_with_tails_has_more_power_than_its_middle_shows() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let valid = vec![true; 30_000];
        let normal: Vec<f64> = valid.iter().map(|_| 2.0 * rng.sample::<f64, _>(StandardNormal)).collect();
        assert!((rough(&normal, &valid) - 2.0).abs() < 0.05);
        assert!((tails(&normal, &valid) - 4.0).abs() < 0.2);
        // Student's t with five degrees of freedom has a variance of 5 / 3
        let law = StudentT::new(5.0).expect("a law");
        let heavy: Vec<f64> = valid.iter().map(|_| rng.sample(law)).collect();
        assert!(rough(&heavy, &valid).powi(2) < 1.55);
        assert!((tails(&heavy, &valid) - 5.0 / 3.0).abs() < 0.12, "{}", tails(&heavy, &valid));
    }
}
