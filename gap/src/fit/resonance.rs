//! Frequencies at which part of the gimbal's inertia may sit on a spring.
//!
//! ```text
//! b(f) = -s^2 / (s^2 + 2 d w s + w^2) phi''        gain(f) = (b . drive)^2 / (2 sum |b|^2 seen)        [nats]
//! ```
//!
//! b: the torque of an appendage with d = 0.03, over its inertia. A resonance so narrow lies between the points of a
//! coarse grid, and no slope leads to it.

use realfft::num_complex::Complex;

use super::path::Path;
use super::whiten::Whitener;
use crate::library::MODE_DAMPING;

/// Range of frequencies, and the step from one to the next.
const FROM_HZ: f64 = 11.0;
const TO_HZ: f64 = 400.0;
const STEP: f64 = 1.03;
/// Frequencies that are offered, and their least distance as a factor.
const OFFERED: usize = 2;
const APART: f64 = 1.2;

/// Frequencies that a drive speaks for most [Hz].
pub(crate) fn frequencies(
    path: &Path,
    whitener: &Whitener,
    drive: &[f64],
    rate_radps: &[f64],
    period_s: f64,
) -> Vec<f64> {
    let plans = whitener.plans();
    let acceleration = rate_radps.windows(2).map(|pair| (pair[1] - pair[0]) / period_s);
    let (acceleration, drive) = (plans.lines(acceleration), plans.lines(drive.iter().copied()));
    let seen = path.seen();
    let step_hz = 1.0 / (plans.length() as f64 * period_s);
    let gain = |hz: f64| {
        let (mut product, mut energy) = (0.0, 0.0);
        for (line, ((acceleration, drive), seen)) in acceleration.iter().zip(&drive).zip(seen.lines()).enumerate() {
            let x = line as f64 * step_hz / hz;
            let torque = x * x / Complex::new(1.0 - x * x, 2.0 * MODE_DAMPING * x) * acceleration;
            product += (torque.conj() * drive).re;
            energy += torque.norm_sqr() * seen;
        }
        // half of the lines are there; one transform is divided by its length
        product * product / (energy * plans.length() as f64).max(1e-300)
    };
    let mut all: Vec<(f64, f64)> = std::iter::successors(Some(FROM_HZ), |hz| Some(hz * STEP))
        .take_while(|hz| *hz < TO_HZ.min(0.4 / period_s))
        .map(|hz| (hz, gain(hz)))
        .collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut offered: Vec<f64> = Vec::new();
    for (hz, _) in all {
        if offered.len() < OFFERED && offered.iter().all(|other| (hz / other).max(other / hz) > APART) {
            offered.push(hz);
        }
    }
    offered
}
