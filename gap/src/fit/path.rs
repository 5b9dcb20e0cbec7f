//! The way from a torque on the gimbal to the whitened channels, and back from a residual to the torque it speaks for.
//!
//! ```text
//! column = W G d        drive = (W G)^T r        seen(f) = sum |G(f)|^2 / P(f)        d, a torque a row [N m]
//! ```
//!
//! A torque b(t) takes `(b . drive)^2 / (2 sum b^2 seen)` nats of a residual. What the bearing does as it turns around
//! is left out: the loop is linear here.

use realfft::num_complex::Complex;

use super::signals::{Signals, of_channel};
use super::whiten::Whitener;

/// The way.
#[derive(Debug)]
pub struct Path {
    /// G / sqrt(P) at the lines of the whitener's transform, channel by channel, over 1 N m.
    lines: Vec<Vec<Complex<f64>>>,
    rows: usize,
    step_hz: f64,
}

impl Path {
    /// From each channel after an impulse of torque [N m].
    pub(crate) fn new(whitener: &Whitener, impulse: &Signals, impulse_nm: f64, period_s: f64) -> Self {
        let plans = whitener.plans();
        let of = |(response, gains): (&Vec<f64>, &Vec<f64>)| {
            plans
                .lines(response.iter().copied())
                .iter()
                .zip(gains)
                .map(|(line, gain)| line * (gain / impulse_nm))
                .collect()
        };
        let lines = impulse.iter().zip(whitener.gains()).map(of).collect();
        Self { lines, rows: whitener.valid.len(), step_hz: 1.0 / (plans.length() as f64 * period_s) }
    }

    /// What a torque is to the whitened channels, row after row; masked rows are zero.
    pub(crate) fn column(&self, whitener: &Whitener, torque_nm: &[f64]) -> Vec<f64> {
        let plans = whitener.plans();
        let torque = plans.lines(torque_nm.iter().copied());
        let channels = self.lines.len();
        let mut column = vec![0.0; self.rows * channels];
        for (channel, lines) in self.lines.iter().enumerate() {
            let mut product: Vec<Complex<f64>> =
                torque.iter().zip(lines).map(|(a, b)| a * b / plans.length() as f64).collect();
            let series = plans.series(&mut product);
            for ((row, value), valid) in column.chunks_exact_mut(channels).zip(&series).zip(&whitener.valid) {
                if *valid {
                    row[channel] = *value;
                }
            }
        }
        whitener.slips().apply(&mut column);
        column
    }

    /// The drive of a torque at each row, of a whitened residual.
    pub(crate) fn drive(&self, whitener: &Whitener, whitened: &[f64]) -> Vec<f64> {
        let plans = whitener.plans();
        let channels = self.lines.len();
        let mut drive = vec![0.0; self.rows];
        for (channel, lines) in self.lines.iter().enumerate() {
            let series = of_channel(whitened, channel, channels);
            let mut product: Vec<Complex<f64>> =
                plans.lines(series).iter().zip(lines).map(|(a, b)| a * b.conj() / plans.length() as f64).collect();
            let back = plans.series(&mut product);
            drive.iter_mut().zip(back).for_each(|(drive, back)| *drive += back);
        }
        drive
    }

    /// What the channels see of a torque of 1 N m, over the noise.
    pub(crate) fn seen(&self) -> Seen {
        let count = self.lines.first().map_or(0, Vec::len);
        let of = |line: usize| self.lines.iter().map(|lines| lines[line].norm_sqr()).sum();
        Seen { lines: (0..count).map(of).collect(), step_hz: self.step_hz }
    }
}

/// At each line of the transform.
pub(crate) struct Seen {
    lines: Vec<f64>,
    step_hz: f64,
}

impl Seen {
    /// At a frequency.
    pub(crate) fn at(&self, hz: f64) -> f64 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a line")]
        let line = (hz / self.step_hz + 0.5) as usize;
        self.lines.get(line).copied().unwrap_or(0.0)
    }

    /// At every line.
    pub(crate) fn lines(&self) -> &[f64] {
        &self.lines
    }

    /// What the channels see, all in all, of a torque of 1 N m that lasts so many rows.
    pub(crate) fn of_box(&self, rows: usize) -> f64 {
        let length = 2.0 * (self.lines.len() as f64 - 1.0).max(1.0);
        let of = |(place, seen): (usize, &f64)| {
            let half_turn = std::f64::consts::PI * place as f64 / length;
            let sum = if place == 0 { rows as f64 } else { (half_turn * rows as f64).sin() / half_turn.sin() };
            let both_sides = if place == 0 || place + 1 == self.lines.len() { 1.0 } else { 2.0 };
            both_sides * sum * sum * seen / length
        };
        self.lines.iter().enumerate().map(of).sum()
    }
}
