//! Frequencies at which part of the gimbal's inertia may sit on a spring, and how lightly it is damped.
//!
//! ```text
//! b(f, d) = s^2 / (s^2 + 2 d w s + w^2) phi''        gain(f, d) = (b . drive)^2 / (2 sum |b|^2 seen)        [nats]
//! ```
//!
//! b: the torque of an appendage over its inertia, which is not below zero. A resonance so narrow lies between the points
//! of a coarse grid, and no slope leads to it from further away than its width: what a scan with d = 0.03 shows is
//! looked at again within an octave, at several dampings, in steps of half a width.

use rayon::prelude::*;
use realfft::num_complex::Complex;

use super::path::Path;
use super::whiten::Whitener;
use crate::library::MODE_DAMPING;

/// Range of frequencies, and the step from one to the next.
const FROM_HZ: f64 = 11.0;
const TO_HZ: f64 = 400.0;
const STEP: f64 = 1.03;
/// Resonances that are offered, and the least distance of their frequencies as a factor.
const OFFERED: usize = 4;
const APART: f64 = 1.2;
/// Dampings that are tried where the scan shows something.
const DAMPINGS: [f64; 5] = [0.005, 0.01, 0.02, MODE_DAMPING, 0.06];

/// Frequencies and dampings that a drive speaks for most, but for those that are known [Hz].
pub(crate) fn add_modes(
    known: &mut Vec<[f64; 2]>,
    path: &Path,
    whitener: &Whitener,
    drive: &[f64],
    rate_radps: &[f64],
    period_s: f64,
) {
    let plans = whitener.plans();
    let acceleration = rate_radps.windows(2).map(|pair| (pair[1] - pair[0]) / period_s);
    let length = plans.length() as f64;
    let lines = Lines {
        acceleration: plans.lines(acceleration),
        drive: plans.lines(drive.iter().copied()),
        seen: path.seen().lines().to_vec(),
        step_hz: 1.0 / (length * period_s),
        length,
    };
    let highest_hz = TO_HZ.min(0.4 / period_s);
    let scanned: Vec<f64> =
        std::iter::successors(Some(FROM_HZ), |hz| Some(hz * STEP)).take_while(|hz| *hz < highest_hz).collect();
    let mut all: Vec<(f64, f64)> =
        scanned.into_par_iter().map(|hz| (hz, lines.gain([hz, MODE_DAMPING], [0.0, f64::MAX]))).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut offered: Vec<f64> = Vec::new();
    for (hz, gain) in all {
        let apart = |other: f64| (hz / other).max(other / hz) > APART;
        let is_new = offered.iter().copied().chain(known.iter().map(|mode| mode[0])).all(apart);
        if gain > 0.0 && offered.len() < OFFERED && is_new {
            offered.push(hz);
        }
    }
    known.par_extend(offered.into_par_iter().filter_map(|hz| lines.peak_near(hz)));
}

/// Lines of the gimbal's acceleration, of the drive, and what the channels see.
struct Lines {
    acceleration: Vec<Complex<f64>>,
    drive: Vec<Complex<f64>>,
    seen: Vec<f64>,
    step_hz: f64,
    length: f64,
}

impl Lines {
    /// What a mode of so many hertz and such damping takes, by the lines of a range of frequencies [nats].
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "lines")]
    fn gain(&self, [hz, damping]: [f64; 2], [from_hz, to_hz]: [f64; 2]) -> f64 {
        let line = |hz: f64| ((hz / self.step_hz) as usize).min(self.seen.len());
        let (mut product, mut energy) = (0.0, 0.0);
        for line in line(from_hz)..line(to_hz) {
            let x = line as f64 * self.step_hz / hz;
            let torque = -x * x / Complex::new(1.0 - x * x, 2.0 * damping * x) * self.acceleration[line];
            product += (torque.conj() * self.drive[line]).re;
            energy += torque.norm_sqr() * self.seen[line];
        }
        // half of the lines are there; one transform is divided by its length
        product.max(0.0).powi(2) / (energy * self.length).max(1e-300)
    }

    /// The mode that takes most between two steps of the scan.
    #[allow(clippy::cast_possible_truncation, reason = "a few steps")]
    fn peak_near(&self, scanned_hz: f64) -> Option<[f64; 2]> {
        let octave = [0.5 * scanned_hz, 2.0 * scanned_hz];
        let around = |damping: f64| {
            let steps = ((STEP - 1.0) / (0.5 * damping)).ceil() as i32;
            (-steps..=steps).map(move |step| [scanned_hz * (1.0 + 0.5 * damping * f64::from(step)), damping])
        };
        let all = DAMPINGS.into_iter().flat_map(around).map(|mode| (self.gain(mode, octave), mode));
        all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, mode)| mode)
    }
}
