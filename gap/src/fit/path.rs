//! The way from a torque on the gimbal to the whitened channels, and back from a residual to the torque it speaks for.
//!
//! ```text
//! column = W G d        drive = (W G)^T r        seen(f) = sum |G(f)|^2 / P(f)        d, a torque a row [N m]
//! ```
//!
//! A torque b(t) takes `(b . drive)^2 / (2 sum b^2 seen)` nats of a residual. What the bearing does as it turns around
//! is left out: the loop is linear here.
//!
//! A torque that is like nothing shows too where there are two channels or more: their noises know nothing of one
//! another, a torque is in all of them.
//!
//! ```text
//! agreement = sum (Re(D_a D_b*) - N s^2 g_a g_b) / sqrt(1/2 sum |D_a D_b|^2)
//! D_a = (G_a / sqrt(P_a))* R_a, lines of one channel's drive        g_a = |G_a|^2 / P_a
//! ```
//!
//! where N rows of a torque of deviation s, row by row at random, are known to be there: noise of what is logged of the
//! platform's inputs.

use realfft::num_complex::Complex;

use super::power::INPUTS_CORNER_HZ;
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
        let mut sum = vec![Complex::new(0.0, 0.0); self.lines.first().map_or(0, Vec::len)];
        for driven in self.driven(whitener, whitened) {
            sum.iter_mut().zip(driven).for_each(|(sum, line)| *sum += line / plans.length() as f64);
        }
        let mut drive = if sum.is_empty() { Vec::new() } else { plans.series(&mut sum) };
        drive.resize(self.rows, 0.0);
        drive
    }

    /// How far the channels agree, two by two, on a torque that is slower than so much: in standard deviations of what
    /// noises that know nothing of one another come to, beyond a torque that is there at every row at random.
    pub(crate) fn agreement(&self, whitener: &Whitener, whitened: &[f64], to_hz: f64, noise_nm: f64) -> f64 {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "lines")]
        let count = (to_hz / self.step_hz) as usize;
        let driven: Vec<Vec<Complex<f64>>> = self.driven(whitener, whitened).collect();
        let known = noise_nm.powi(2) * self.rows as f64;
        let (mut sum, mut square) = (0.0, 0.0);
        for (place, one) in driven.iter().enumerate() {
            for (earlier, other) in driven[..place].iter().enumerate() {
                for line in 1..one.len().min(count + 1) {
                    let product = one[line] * other[line].conj();
                    let seen = self.lines[place][line].norm_sqr() * self.lines[earlier][line].norm_sqr();
                    let flicker = 1.0 + INPUTS_CORNER_HZ / (line as f64 * self.step_hz);
                    sum += product.re - known * flicker * seen;
                    square += 0.5 * product.norm_sqr();
                }
            }
        }
        sum / f64::max(square, 1e-300).sqrt()
    }

    /// Lines of the drive, channel by channel.
    fn driven(&self, whitener: &Whitener, whitened: &[f64]) -> impl Iterator<Item = Vec<Complex<f64>>> {
        let channels = self.lines.len();
        self.lines.iter().enumerate().map(move |(channel, lines)| {
            let series = of_channel(whitened, channel, channels);
            whitener.plans().lines(series).iter().zip(lines).map(|(a, b)| a * b.conj()).collect()
        })
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
