//! Steps of the converters that write a log.

use super::rough::{rough, tails};

/// Noise of a converter, over its step: `1 / sqrt(12)`.
const OF_STEP: f64 = 0.3;
/// A step from so many of the noise on is coarse; with less than this share of it from row to row it is the series itself
/// that goes evenly.
const COARSE: f64 = 1.3;
const EVEN: f64 = 0.05;
/// How far from a whole number of steps a change may be, how many steps it may have to say so, and share of those that
/// must be whole.
const OFF: f64 = 0.05;
const FEW: f64 = 8.5;
const WHOLE: f64 = 0.95;

/// Least rms of a converter's noise: differences are silent about it where samples stand on one step most of the time.
pub(crate) fn least_noise(values: &[f64], valid: &[bool]) -> f64 {
    let least_count = least_count(values, valid);
    if least_count.is_finite() { OF_STEP * least_count } else { 0.0 }
}

/// Smallest step between two samples that count.
pub(super) fn least_count(values: &[f64], valid: &[bool]) -> f64 {
    let both = |pair: &(&[f64], &[bool])| pair.1.iter().all(|valid| *valid);
    let steps = values.windows(2).zip(valid.windows(2)).filter(both).map(|(pair, _)| (pair[1] - pair[0]).abs());
    steps.filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min)
}

/// Whether a series changes by whole steps as coarse as its noise.
pub(super) fn is_coarse(values: &[f64]) -> bool {
    let valid = vec![true; values.len()];
    let step = least_count(values, &valid);
    let changes = values.windows(2).map(|pair| (pair[1] - pair[0]).abs() / step);
    let few: Vec<f64> = changes.filter(|change| *change > 0.0 && *change < FEW).collect();
    let whole = few.iter().filter(|change| (**change - change.round()).abs() < OFF).count() as f64;
    let noise = rough(values, &valid);
    whole > WHOLE * few.len() as f64 && COARSE * noise < step && tails(values, &valid).sqrt() > EVEN * step
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::{is_coarse, least_noise};

    #[test]
    fn a_series_is_coarse_where_its_steps_are_larger_than_its_noise() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let noisy: Vec<f64> =
            (0..20_000).map(|k| (f64::from(k) * 1e-3).sin() + 1e-3 * rng.sample::<f64, _>(StandardNormal)).collect();
        let on = |step: f64| -> Vec<f64> { noisy.iter().map(|value| (value / step).round() * step).collect() };
        let even: Vec<f64> = (0..20_000).map(|k| 0.25 * f64::from(k)).collect();
        assert!(is_coarse(&on(2.5e-3)));
        for other in [noisy.clone(), on(4e-4), even, vec![1.0; 20_000]] {
            assert!(!is_coarse(&other));
        }
        // a noise far below the step leaves the step's own
        let (standing, valid) = (on(0.5), vec![true; 20_000]);
        assert!((least_noise(&standing, &valid) - 0.15).abs() < 1e-12);
        assert!(super::rough(&standing, &valid) < 1e-9);
    }
}
