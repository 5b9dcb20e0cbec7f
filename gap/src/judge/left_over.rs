//! What a fit leaves: excess of the whitened residual over noise, where it stands out most.
//!
//! ```text
//! z = sum (p - 1) n / sqrt(2 N + (N / 10)^2)        p the power of a cell, n its degrees of freedom, N = sum n
//! ```
//!
//! The second part of the root is what the noise itself is known to. Cells are bands of frequency, over the whole log
//! and in windows of it; each channel by itself. Rows at which the bearing turns around are left out: there every error of the
//! logged rate is torque, and how large it is, is known least.

use realfft::RealFftPlanner;

use crate::fit::{Problem, of_channel};

/// Rows of a window.
const WINDOW: usize = 2048;
/// Edges of the bands [Hz].
const EDGES_HZ: [f64; 8] = [0.0, 1.0, 2.5, 6.0, 15.0, 40.0, 110.0, 300.0];
/// Rows before and after one at which the bearing turns around that do not count, and share of a window that must.
const BEFORE: usize = 5;
const AFTER: usize = 60;
const COUNTS: f64 = 0.5;
/// Share to which the power of the noise is known.
const KNOWN_TO: f64 = 0.1;
/// Standard deviations that the largest of the windows exceeds by chance.
const BY_CHANCE: f64 = 4.0;

/// The largest excess [standard deviations].
pub(crate) fn left_over(problem: &Problem, whitened: &[f64]) -> f64 {
    let channels = problem.record.channels.len();
    let valid = steady(problem);
    let period_s = problem.record.inputs.period_s;
    (0..channels)
        .map(|channel| {
            let series: Vec<f64> = of_channel(whitened, channel, channels).collect();
            excess(&series, &valid, period_s)
        })
        .fold(0.0, f64::max)
}

/// Rows that count, away from those at which the bearing turns around.
pub(super) fn steady(problem: &Problem) -> Vec<bool> {
    let turns = &problem.turns;
    let mut steady = problem.whitener.valid.clone();
    for row in (0..turns.len()).filter(|&row| turns[row]) {
        let around = row.saturating_sub(BEFORE)..(row + AFTER).min(turns.len());
        steady[around].fill(false);
    }
    steady
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "lines")]
fn excess(series: &[f64], valid: &[bool], period_s: f64) -> f64 {
    let length = WINDOW.min(series.len());
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut lines = transform.make_output_vec();
    let step_hz = 1.0 / (length as f64 * period_s);
    let places: Vec<usize> = EDGES_HZ.iter().map(|hz| ((hz / step_hz).round() as usize).clamp(1, length / 2)).collect();
    let (mut sums, mut counts) = (vec![0.0; EDGES_HZ.len() - 1], vec![0.0; EDGES_HZ.len() - 1]);
    let mut local: f64 = 0.0;
    for start in (0..=series.len() - length).step_by(length) {
        let there = valid[start..start + length].iter().filter(|valid| **valid).count() as f64 / length as f64;
        if there < COUNTS {
            continue;
        }
        let rows = series[start..start + length].iter().zip(&valid[start..start + length]);
        let mut segment: Vec<f64> = rows.map(|(value, valid)| if *valid { *value } else { 0.0 }).collect();
        if transform.process(&mut segment, &mut lines).is_err() {
            continue;
        }
        for band in 0..sums.len() {
            let range = places[band]..places[band + 1];
            let n = 2.0 * range.len() as f64;
            let power: f64 = lines[range].iter().map(|line| line.norm_sqr() / (length as f64 * there)).sum();
            let above = 2.0 * power - n;
            sums[band] += above;
            counts[band] += n;
            local = local.max(above / scatter(n));
        }
    }
    let whole = sums.iter().zip(&counts).map(|(sum, count)| sum / scatter(*count)).fold(0.0, f64::max);
    whole.max(local - BY_CHANCE)
}

/// Of the excess of a cell with so many degrees of freedom.
fn scatter(count: f64) -> f64 {
    (2.0 * count + (KNOWN_TO * count).powi(2)).max(1.0).sqrt()
}
