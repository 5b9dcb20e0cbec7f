//! A line in time: a torque that beats at a frequency of its own.
//!
//! ```text
//! gain(f) = |sum drive(t) exp(-2 pi i f t)|^2 / (N seen(f))        [nats]        N rows
//! ```

use std::f64::consts::TAU;

use realfft::RealFftPlanner;

use super::group::Group;
use crate::fit::Problem;

/// Frequencies that are looked at [Hz]: no slower than two periods of the log.
const FROM_PERIODS: f64 = 2.0;
const TO_HZ: f64 = 250.0;
/// Finer than one line a log length by this.
const FINER: usize = 4;

/// Sine and cosine of the strongest line in a drive; none where the log is too short for one.
pub(crate) fn line(problem: &Problem, drive: &[f64]) -> Option<Group> {
    let period_s = problem.record.inputs.period_s;
    let length = (FINER * drive.len()).next_power_of_two();
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut series = transform.make_input_vec();
    series[..drive.len()].copy_from_slice(drive);
    let mut lines = transform.make_output_vec();
    transform.process(&mut series, &mut lines).ok()?;
    let step_hz = 1.0 / (length as f64 * period_s);
    let from_hz = FROM_PERIODS / (drive.len() as f64 * period_s);
    let within = |hz: f64| (from_hz..TO_HZ.min(0.4 / period_s)).contains(&hz);
    let seen = problem.path.seen();
    let (_, best_hz) = lines
        .iter()
        .enumerate()
        .map(|(place, line)| (line.norm_sqr(), place as f64 * step_hz))
        .filter(|(_, hz)| within(*hz))
        .map(|(power, hz)| (power / seen.at(hz).max(1e-300), hz))
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    let independent = (TO_HZ.min(0.4 / period_s) - from_hz) * drive.len() as f64 * period_s;
    let wave = |quarter: f64| -> Vec<f64> {
        let at = |row: usize| (TAU * (best_hz * row as f64 * period_s + quarter)).cos();
        (0..drive.len()).map(at).collect()
    };
    Some(Group { of: "a line in time", torques: vec![wave(0.0), wave(-0.25)], choice: independent.max(1.0).ln() })
}
