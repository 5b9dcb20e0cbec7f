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
/// Lines that are turned to one after the other: rounding grows with each.
const AT_ONCE: usize = 50;
/// Lines that are offered.
const OFFERED: usize = 2;

/// Cycles a revolution of the best lines, but for those that are known.
pub(crate) fn add_cycles(
    known: &mut Vec<f64>,
    path: &Path,
    drive: &[f64],
    rel_rad: &[f64],
    valid: &[bool],
    period_s: f64,
) {
    let (low, high) = rel_rad.iter().fold((f64::MAX, f64::MIN), |(low, high), rel| (low.min(*rel), high.max(*rel)));
    let span = high - low;
    if !span.is_finite() || span < LEAST_SPAN_RAD {
        return;
    }
    let finest = TAU / span;
    let step = (0.25 * finest).max(MOST_CYCLES / MOST_LINES as f64);
    let first = finest.max(0.8);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let count = ((MOST_CYCLES - first) / step).max(0.0) as usize;
    let rows: Vec<usize> = (STRIDE..rel_rad.len()).step_by(STRIDE).filter(|&k| valid[k]).collect();
    let turns_ps = |k: usize| (rel_rad[k] - rel_rad[k - STRIDE]) / (STRIDE as f64 * period_s * TAU);
    let turns_ps: Vec<f64> = rows.iter().map(|&k| turns_ps(k).abs()).collect();
    let (drive, rel): (Vec<f64>, Vec<f64>) = rows.iter().map(|&k| (drive[k], rel_rad[k])).unzip();
    let seen = path.seen();
    let some = |lines: &[usize]| -> Vec<(f64, f64)> {
        let cycles = |line: usize| first + line as f64 * step;
        let mut turning = Turning::new(&drive, &rel, cycles(lines[0]), step);
        let gain = |&line: &usize| {
            let (sine, cosine) = turning.next();
            let seen: f64 = turns_ps.iter().map(|turns_ps| seen.at(cycles(line) * turns_ps)).sum();
            (cycles(line), (sine * sine + cosine * cosine) / f64::max(seen, 1e-300))
        };
        lines.iter().map(gain).collect()
    };
    let all: Vec<usize> = (0..count).collect();
    let mut lines: Vec<(f64, f64)> = all.par_chunks(AT_ONCE).flat_map_iter(some).collect();
    lines.sort_by(|a, b| b.1.total_cmp(&a.1));
    let most = known.len() + OFFERED;
    for (cycles, _) in lines {
        if known.len() < most && known.iter().all(|other| (other - cycles).abs() > 2.0 * finest) {
            known.push(cycles);
        }
    }
}

/// `drive exp(i c rel)` at every row, turned on from one c to the next.
struct Turning {
    sine: Vec<f64>,
    cosine: Vec<f64>,
    by_sine: Vec<f64>,
    by_cosine: Vec<f64>,
}

impl Turning {
    fn new(drive: &[f64], rel_rad: &[f64], cycles: f64, step: f64) -> Self {
        let of = |cycles: f64| rel_rad.iter().map(move |rel| (cycles * rel).sin_cos());
        let (by_sine, by_cosine) = of(step).unzip();
        let (sine, cosine) =
            of(cycles).zip(drive).map(|((sine, cosine), drive)| (drive * sine, drive * cosine)).unzip();
        Self { sine, cosine, by_sine, by_cosine }
    }

    /// The sums over all rows; then on.
    fn next(&mut self) -> (f64, f64) {
        let sums = (self.sine.iter().sum(), self.cosine.iter().sum());
        let by = self.by_sine.iter().zip(&self.by_cosine);
        for ((sine, cosine), (by_sine, by_cosine)) in self.sine.iter_mut().zip(&mut self.cosine).zip(by) {
            let turned = *sine * by_cosine + *cosine * by_sine;
            *cosine = *cosine * by_cosine - *sine * by_sine;
            *sine = turned;
        }
        sums
    }
}
