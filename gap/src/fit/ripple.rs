//! Lines of a torque over the gimbal's angle: how many cycles a revolution ripple or cogging may have.
//!
//! ```text
//! gain(c) = |sum drive exp(-i c rel)|^2 / sum seen(c |d(rel)/dt| / 2 pi)        [nats]
//! ```

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::path::Path;

/// Most cycles a revolution, and most lines that are tried.
const MOST_CYCLES: f64 = 150.0;
const MOST_LINES: usize = 1500;
/// Every so many rows are summed: the drive is filtered by the loop, which is slower than that.
const STRIDE: usize = 4;
/// Least motion in which a line is one [rad].
const LEAST_SPAN_RAD: f64 = 0.05;
/// Lines that are offered.
const OFFERED: usize = 2;

/// Cycles a revolution of the best lines.
pub(crate) fn cycles(path: &Path, drive: &[f64], rel_rad: &[f64], valid: &[bool], period_s: f64) -> Vec<f64> {
    let (low, high) = rel_rad.iter().fold((f64::MAX, f64::MIN), |(low, high), rel| (low.min(*rel), high.max(*rel)));
    let span = high - low;
    if !span.is_finite() || span < LEAST_SPAN_RAD {
        return Vec::new();
    }
    let finest = TAU / span;
    let step = (0.25 * finest).max(MOST_CYCLES / MOST_LINES as f64);
    let first = finest.max(0.8);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let count = ((MOST_CYCLES - first) / step).max(0.0) as usize;
    let rows: Vec<(f64, f64, f64)> = (STRIDE..rel_rad.len())
        .step_by(STRIDE)
        .filter(|&k| valid[k])
        .map(|k| (drive[k], rel_rad[k], (rel_rad[k] - rel_rad[k - STRIDE]) / (STRIDE as f64 * period_s * TAU)))
        .collect();
    let gain = |line: usize| {
        let cycles = first + line as f64 * step;
        let (mut sine, mut cosine, mut seen) = (0.0, 0.0, 0.0);
        for &(drive, rel, turns_ps) in &rows {
            let (s, c) = (cycles * rel).sin_cos();
            sine += s * drive;
            cosine += c * drive;
            seen += path.seen(cycles * turns_ps);
        }
        (cycles, (sine * sine + cosine * cosine) / f64::max(seen, 1e-300))
    };
    let mut lines: Vec<(f64, f64)> = (0..count).into_par_iter().map(gain).collect();
    lines.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut found: Vec<f64> = Vec::new();
    for (cycles, _) in lines {
        if found.len() < OFFERED && found.iter().all(|other| (other - cycles).abs() > 2.0 * finest) {
            found.push(cycles);
        }
    }
    found
}
