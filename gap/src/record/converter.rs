//! Steps of the converters that write a log.
//!
//! What a converter of step q reads on the average, of a value x with white noise sigma before it:
//!
//! ```text
//! x + sum_k (-1)^k q / (pi k) e_k sin(2 pi k x / q)        e_k = exp(-2 (pi k sigma / q)^2)
//! ```
//!
//! (Widrow and Kollar, Quantization Noise, Cambridge 2008, chapter 4, by its characteristic function). With its own noise, over
//! all x, it leaves `(sigma / q)^2 + 1/12 - sum_k (e_k / (pi k))^2 / 2`.

use std::f64::consts::{PI, TAU};

use super::rough::{rough, tails};

/// Noise of a converter, over its step: `1 / sqrt(12)`.
const OF_STEP: f64 = 0.3;
/// A step from so many of the noise on is coarse; with less than this share of it from row to row it is the series itself
/// that goes evenly. From fewer noises on it tells that what writes the log rounds.
const COARSE: f64 = 1.3;
const ROUNDED: f64 = 0.5;
const EVEN: f64 = 0.05;
/// How far from a whole number of steps a change may be.
const OFF: f64 = 0.05;
/// How many steps a difference may have to say whether it is whole, and share of those that must be.
const FEW: f64 = 8.5;
const WHOLE: f64 = 0.95;

/// Waves of what it reads that count.
const WAVES: [f64; 2] = [1.0, 2.0];
/// Least noise before a converter that is counted on, over the step: with less of it one reads by jumps, and no slope leads over
/// those; and the most that leaves any wave.
const LEAST: f64 = 0.25;
const MOST: f64 = 1.0;
/// How well all samples must be on its steps, where 1 is on the dot.
const ON_STEPS: f64 = 0.95;

/// A converter whose steps are as coarse as its noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Converter {
    step: f64,
    /// A value that it reads.
    first: f64,
    /// Heights of its waves: one a step, and two.
    heights: [f64; 2],
}

impl Converter {
    /// That of a series; none where no coarse one writes it.
    pub(super) fn of(values: &[f64], valid: &[bool]) -> Option<Self> {
        let step = step_of(values, valid, COARSE)?;
        let (first, on_steps) = phase(values, valid, step);
        let noise = noise_that_leaves(tails(values, valid) / (step * step));
        let height = |k: f64| step * (PI * k).cos() * share(k, noise) / (PI * k);
        (on_steps > ON_STEPS).then(|| Self { step, first, heights: WAVES.map(height) })
    }

    /// What it reads on the average.
    pub(crate) fn reads(&self, value: f64) -> f64 {
        let (sin, cos) = (TAU * (value - self.first) / self.step).sin_cos();
        let [once, twice] = self.heights;
        value + once * sin + twice * 2.0 * sin * cos
    }
}

/// What noise leaves of a wave.
fn share(wave: f64, noise: f64) -> f64 {
    (-2.0 * (PI * wave * noise).powi(2)).exp()
}

/// Noise before a converter that leaves so much power behind it, both over the step.
fn noise_that_leaves(power: f64) -> f64 {
    let leaves = |noise: f64| {
        let slow = |k: f64| 0.5 * (share(k, noise) / (PI * k)).powi(2);
        noise * noise + 1.0 / 12.0 - WAVES.into_iter().map(slow).sum::<f64>()
    };
    let (mut low, mut high) = (LEAST, MOST);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if leaves(middle) < power { low = middle } else { high = middle }
    }
    low
}

/// The step of which nearly all differences of a few steps are whole multiples, but for so much, from a first guess of it; none
/// where they are not.
pub(crate) fn whole_step(differences: impl Iterator<Item = f64>, first: f64, off: f64) -> Option<f64> {
    let few: Vec<f64> = differences.filter(|difference| *difference < FEW * first).collect();
    let steps = || few.iter().map(|difference| difference / first);
    let whole = steps().filter(|over| (over - over.round()).abs() < off).count() as f64;
    (whole > WHOLE * few.len() as f64).then(|| few.iter().sum::<f64>() / steps().map(f64::round).sum::<f64>())
}

/// The value on a grid of steps that samples lie about, and how well they lie on it, where 1 is on the dot.
pub(crate) fn phase(values: &[f64], valid: &[bool], step: f64) -> (f64, f64) {
    let counted = values.iter().zip(valid).filter(|(_, valid)| **valid);
    let waves = counted.map(|(value, _)| (TAU * value / step).sin_cos());
    let (sin, cos, count) = waves.fold((0.0, 0.0, 0.0), |sum, (sin, cos)| (sum.0 + sin, sum.1 + cos, sum.2 + 1.0));
    (f64::atan2(sin, cos) / TAU * step, f64::hypot(sin, cos) / count)
}

/// The step of which a series changes by whole ones, where that is more than so many of its noise.
fn step_of(values: &[f64], valid: &[bool], noises: f64) -> Option<f64> {
    let least = least_count(values, valid);
    let step = whole_step(changes(values, valid), least, OFF)?;
    (noises * rough(values, valid) < least && tails(values, valid).sqrt() > EVEN * least).then_some(step)
}

/// Least rms of a converter's noise: differences are silent about it where samples stand on one step most of the time.
pub(crate) fn least_noise(values: &[f64], valid: &[bool]) -> f64 {
    let least_count = least_count(values, valid);
    if least_count.is_finite() { OF_STEP * least_count } else { 0.0 }
}

/// Smallest step between two samples that count.
pub(super) fn least_count(values: &[f64], valid: &[bool]) -> f64 {
    changes(values, valid).fold(f64::INFINITY, f64::min)
}

/// Changes between two samples that count.
fn changes(values: &[f64], valid: &[bool]) -> impl Iterator<Item = f64> {
    let both = |pair: &(&[f64], &[bool])| pair.1.iter().all(|valid| *valid);
    let pairs = values.windows(2).zip(valid.windows(2)).filter(both);
    pairs.map(|(pair, _)| (pair[1] - pair[0]).abs()).filter(|change| *change > 0.0)
}

/// Whether a series changes by whole steps that are no small part of its noise.
pub(super) fn is_rounded(values: &[f64]) -> bool {
    step_of(values, &vec![true; values.len()], ROUNDED).is_some()
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::{Converter, is_rounded, least_noise};

    #[test]
    fn a_series_is_rounded_where_its_steps_are_no_small_part_of_its_noise() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let noisy: Vec<f64> =
            (0..20_000).map(|k| (f64::from(k) * 1e-3).sin() + 1e-3 * rng.sample::<f64, _>(StandardNormal)).collect();
        let on = |step: f64| -> Vec<f64> { noisy.iter().map(|value| (value / step).round() * step).collect() };
        let even: Vec<f64> = (0..20_000).map(|k| 0.25 * f64::from(k)).collect();
        assert!(is_rounded(&on(2.5e-3)) && is_rounded(&on(7e-4)));
        for other in [noisy.clone(), on(4e-4), even, vec![1.0; 20_000]] {
            assert!(!is_rounded(&other));
        }
        // a noise far below the step leaves the step's own
        let (standing, valid) = (on(0.5), vec![true; 20_000]);
        assert!((least_noise(&standing, &valid) - 0.15).abs() < 1e-12);
        assert!(super::rough(&standing, &valid) < 1e-9);
    }

    #[test]
    fn closed_form_a_converter_reads_what_it_writes_on_the_average() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let (step, sigma) = (2.5, 1.0);
        let mut read = |value: f64| ((value + sigma * rng.sample::<f64, _>(StandardNormal)) / step).round() * step;
        let written: Vec<f64> = (0..60_000).map(|k| read(9.0 * (f64::from(k) * 1e-3).sin())).collect();
        let converter = Converter::of(&written, &vec![true; 60_000]).expect("a coarse one");
        assert!((converter.step - step).abs() < 1e-9 && converter.first.abs() < 1e-6, "{converter:?}");
        for value in [0.1, 0.625, 1.2, 1.9, 4.4] {
            let mean = (0..1_000_000).map(|_| read(value)).sum::<f64>() / 1e6;
            assert!((converter.reads(value) - mean).abs() < 0.006, "{value}: {}, {mean}", converter.reads(value));
        }
    }
}
