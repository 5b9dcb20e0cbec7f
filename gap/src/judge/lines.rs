//! A line in time: a torque, or something of the platform that it is a multiple of, beats at a frequency of its own.
//!
//! ```text
//! gain(f) = |sum drive(t) c(t) exp(-2 pi i f t)|^2 / sum |C(f - f')|^2 seen(f')        [nats]        c what beats, C its spectrum
//! ```

use std::f64::consts::TAU;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

use super::group::{Group, On};
use super::on_float::{driven, gain};
use crate::fit::Problem;
use crate::window::spectrum;

/// Frequencies that are looked at [Hz]: no slower than two periods of the log.
const FROM_PERIODS: f64 = 2.0;
const TO_HZ: f64 = 250.0;
/// Finer than one line a log length by this.
const FINER: usize = 4;

/// What beats.
pub(super) struct Carrier {
    /// For the report.
    pub(super) of: &'static str,
    /// Row by row.
    pub(super) series: Vec<f64>,
    /// What it is added to: the gimbal, or the float.
    pub(super) on: On,
}

/// Sine and cosine of the strongest line in a drive that a carrier makes; none where the log is too short for one.
pub(super) fn line(problem: &Problem, drive: &[f64], carrier: &Carrier) -> Option<Group> {
    let period_s = problem.record.inputs.period_s;
    let rows = drive.len();
    let length = (FINER * rows).next_power_of_two();
    let on_float = carrier.on == On::Float;
    let own = if on_float { driven(drive) } else { drive.to_vec() };
    let beating: Vec<f64> = own.iter().zip(&carrier.series).map(|(drive, carrier)| drive * carrier).collect();
    let step_hz = 1.0 / (length as f64 * period_s);
    let seen = problem.path.seen();
    let seen_at = |place: usize| {
        let cycles_a_row = place as f64 / length as f64;
        seen.at(place as f64 * step_hz) * if on_float { gain(cycles_a_row) } else { 1.0 }
    };
    let energy = spread(&spectrum(&carrier.series, length)?, &(0..=length / 2).map(seen_at).collect::<Vec<_>>())?;
    let from_hz = FROM_PERIODS / (rows as f64 * period_s);
    let to_hz = TO_HZ.min(0.4 / period_s);
    let (_, best_hz) = spectrum(&beating, length)?
        .iter()
        .zip(&energy)
        .enumerate()
        .map(|(place, (power, energy))| (power / energy.max(1e-300), place as f64 * step_hz))
        .filter(|(_, hz)| (from_hz..to_hz).contains(hz))
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    let wave = |quarter: f64| -> Vec<f64> {
        let at = |(row, carrier): (usize, &f64)| carrier * (TAU * (best_hz * row as f64 * period_s + quarter)).cos();
        carrier.series.iter().enumerate().map(at).collect()
    };
    let independent = (to_hz - from_hz) * rows as f64 * period_s;
    let (series, choice) = (vec![wave(0.0), wave(-0.25)], independent.max(1.0).ln());
    Some(Group { of: carrier.of, series, on: carrier.on, choice })
}

/// A spectrum spread about every line by another, `sum over all f' of a(f - f') b(f') / length`.
fn spread(a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
    let length = 2 * (a.len() - 1);
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, back) = (planner.plan_fft_forward(length), planner.plan_fft_inverse(length));
    let correlation = |power: &[f64]| -> Option<Vec<f64>> {
        let mut lines: Vec<Complex<f64>> = power.iter().map(|power| Complex::new(*power, 0.0)).collect();
        let mut series = back.make_output_vec();
        back.process(&mut lines, &mut series).ok()?;
        Some(series)
    };
    let mut product: Vec<f64> = correlation(a)?.iter().zip(correlation(b)?).map(|(a, b)| a * b).collect();
    let mut lines = forward.make_output_vec();
    forward.process(&mut product, &mut lines).ok()?;
    Some(lines.iter().map(|line| line.re / (length as f64 * length as f64)).collect())
}

#[cfg(test)]
mod tests {
    use super::spread;
    use crate::window::spectrum;

    #[test]
    fn closed_form_what_does_not_beat_spreads_nothing() {
        // of ones, all power is at zero, the number of rows squared over it
        let length = 64;
        let of_ones = spectrum(&[1.0; 64], length).expect("a length of its own");
        let seen: Vec<f64> = (0..=length / 2).map(|place| place as f64).collect();
        let spread = spread(&of_ones, &seen).expect("the same length");
        for (place, spread) in spread.iter().enumerate() {
            assert!((spread - 64.0 * place as f64).abs() < 1e-6, "{place}: {spread}");
        }
    }
}
