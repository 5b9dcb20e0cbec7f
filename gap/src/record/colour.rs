//! The colour of a sensor's noise, by its power where hardly anything moves that is slower than it:
//!
//! ```text
//! colour = mean of P(f), f from 12 to 24 % of half the sampling rate / mean of P(f), f from 60 % on
//! ```
//!
//! in the quietest parts of a signal. White noise has 1, an AR(1) process of 0.5 a colour of 4.9, of 0.9 one of 12, flicker 2.

use crate::window::{hann, spectrum};

/// Colour from which on noise is not white.
pub(super) const COLOURED: f64 = 1.3;
/// Rows of a part, and the share of the parts that are looked at.
const PART: usize = 1024;
const QUIETEST: usize = 5;
/// Power that the middle part may have over that of the quietest: noise goes on as it is, and motion does not.
const AS_IT_WAS: f64 = 1.6;
/// Slow and fast, over half the sampling rate.
const SLOW: [f64; 2] = [0.12, 0.24];
const FAST: [f64; 2] = [0.6, 1.0];

/// Colour of the noise of a signal; 1 where there is none, or motion hides it.
pub(super) fn colour(values: &[f64]) -> f64 {
    let window = hann(PART);
    let powers = values.chunks_exact(PART).filter_map(|part| {
        let mean = part.iter().sum::<f64>() / PART as f64;
        let tapered: Vec<f64> = part.iter().zip(&window).map(|(value, window)| (value - mean) * window).collect();
        let lines = spectrum(&tapered, PART)?;
        Some([SLOW, FAST].map(|band| within(&lines, band)))
    });
    let mut powers: Vec<[f64; 2]> = powers.collect();
    powers.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let middle = powers.get(powers.len() / 2).map_or(0.0, |power| power[0]);
    powers.truncate(powers.len().div_ceil(QUIETEST));
    let [slow, fast] = [0, 1].map(|band| powers.iter().map(|power| power[band]).sum::<f64>() / powers.len() as f64);
    if fast > 0.0 && middle < AS_IT_WAS * slow { slow / fast } else { 1.0 }
}

/// Mean power in a band.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a line")]
fn within(lines: &[f64], band: [f64; 2]) -> f64 {
    let [from, to] = band.map(|share| (share * (lines.len() - 1) as f64) as usize);
    lines[from..to].iter().sum::<f64>() / (to - from) as f64
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::{COLOURED, colour};

    #[test]
    fn closed_form_noise_that_depends_on_the_row_before_has_a_colour_and_white_noise_none() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let mut noise = |memory: f64| -> Vec<f64> {
            let mut last = 0.0;
            let row = |k: u32| {
                last = memory * last + rng.sample::<f64, _>(StandardNormal);
                last + 3.0 * (6e-3 * f64::from(k)).sin()
            };
            (0..20_000).map(row).collect()
        };
        assert!((colour(&noise(0.0)) - 1.0).abs() < 0.3);
        // 1 / (1 + a^2 - 2 a cos w), mean over both bands
        let half = colour(&noise(0.5));
        assert!((half - 4.4).abs() < 1.0, "{half}");
        assert!(half > COLOURED && colour(&vec![0.0; 5000]) < COLOURED);
        let comes_and_goes = |(k, value): (usize, f64)| if k % 10_000 < 3000 { 0.1 * value } else { value };
        let motion: Vec<f64> = noise(0.5).into_iter().enumerate().map(comes_and_goes).collect();
        assert!(colour(&motion) < COLOURED);
    }
}
