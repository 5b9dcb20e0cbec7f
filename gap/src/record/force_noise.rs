//! Noise of the logged specific force.

use super::colour::{COLOURED, colour};
use super::quiet::white_noise;
use super::rough::rough;

/// Parts of the log, in one of which no vibration hides the noise of the specific force, and what that is at most at
/// these rates [m/s^2]: 90 ug/sqrt(Hz) up to 500 Hz, and five times that where the spectrum has as much wherever it is lowest.
const PARTS: usize = 20;
const ACCEL_NOISE_MPS2: f64 = 0.02;
const WHITE_NOISE_MPS2: f64 = 0.1;
/// The same of coloured noise, where it is slow, over the white noise that it may have been.
const SLOW_OVER_WHITE: f64 = 2.5;
/// Amplitude that coloured noise may have where it is slow, over its rows' and its colour: an AR(1) process of 0.5 has 0.6, one
/// of 0.9 has 1.5, flicker at 1 Hz has 4.
const SLOWER: f64 = 2.0;

/// Noise of one axis as logged: a filter takes little of what is slow out of a force that is slow, too.
#[derive(Debug, Clone, Copy, Default)]
pub struct ForceNoise {
    /// What it has from row to row [m/s2].
    pub white_mps2: f64,
    /// White noise that would have as much where it is slow, of noise that is not white [m/s2].
    pub slow_mps2: f64,
}

impl ForceNoise {
    pub(super) fn logged(accel_mps2: &[f64]) -> Self {
        let most = white_noise(accel_mps2).unwrap_or(0.0).clamp(ACCEL_NOISE_MPS2, WHITE_NOISE_MPS2);
        let white_mps2 = quietest(accel_mps2, most);
        let slow_mps2 = slow(white_mps2, colour(accel_mps2)).min(SLOW_OVER_WHITE * most);
        Self { white_mps2, slow_mps2 }
    }
}

/// Noise of a signal where it is quietest: elsewhere vibration is like noise.
fn quietest(values: &[f64], most: f64) -> f64 {
    let part = values.len().div_ceil(PARTS).max(1);
    values.chunks(part).map(|part| rough(part, &vec![true; part.len()])).fold(most, f64::min)
}

/// White noise that has as much where it is slow as coloured noise.
pub(crate) fn slow(noise: f64, colour: f64) -> f64 {
    if colour > COLOURED { noise * SLOWER * colour } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::ForceNoise;

    /// White noise with something else, row by row.
    fn noise(size: f64, beside: impl Fn(u32) -> f64) -> f64 {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let values: Vec<f64> = (0..20_000).map(|k| size * rng.sample::<f64, _>(StandardNormal) + beside(k)).collect();
        ForceNoise::logged(&values).white_mps2
    }

    #[test]
    fn vibration_of_most_of_a_log_is_no_noise() {
        let white_mps2 = noise(3e-3, |k| if k < 18_000 { (0.9 * f64::from(k)).sin() } else { 0.0 });
        assert!(white_mps2 < 0.01, "{white_mps2}");
    }

    #[test]
    fn noise_of_every_frequency_is_noise_however_large() {
        let white_mps2 = noise(0.06, |k| 9.0 * (2e-3 * f64::from(k)).sin());
        assert!((white_mps2 / 0.06 - 1.0).abs() < 0.2, "{white_mps2}");
    }
}
