//! What is left when the library has said what it can, so that a person can name it: where, when, on what it depends,
//! and which effect comes nearest.
//!
//! Dependence: the residual in bins of a variable, learnt in every other second and tried on the seconds between,
//!
//! ```text
//! share = 1 - sum (r - curve(x))^2 / sum r^2        odd: curve(x) = sgn(x) c(|x|)        even: curve(x) = c(|x|)
//! ```
//!
//! so that chance gives nothing or less.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::DVector;

use super::weigh::names;
use crate::fit::{Fit, Problem, drive, slices, solve};
use crate::place::{Band, Regime, Spectrum, block_shares, regimes};
use crate::record::Signal;

/// Bins of a curve.
const BINS: usize = 16;
/// Rows that are taken together: what is left is slow, and a mean of them has less noise.
const TOGETHER: usize = 5;
/// Length of a window [s].
const WINDOW_S: f64 = 0.5;
/// A dependence is told from this share on.
const LEAST_SHARE: f64 = 0.05;
/// Share of the excess that counts as when it happens.
const MOST: f64 = 0.6;

/// What is left over.
#[derive(Debug, Clone)]
pub struct Portrait {
    /// Signal in which it stands out most.
    pub signal: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Rms of what is left of that signal, and of its noise.
    pub rms: [f64; 2],
    /// Block whose effects would take most of it, with its share.
    pub block: Option<(String, f64)>,
    /// Band that holds most of it.
    pub band: Option<Band>,
    /// Regimes that hold more of it than of the time.
    pub regimes: Vec<Regime>,
    /// Windows that hold most of it, since the first row [s].
    pub span_s: [f64; 2],
    /// Share of the windows that hold most of it: small for bursts.
    pub burst_share: f64,
    /// Variables on which it depends, the strongest first, with the share that they explain.
    pub depends_on: Vec<(String, f64)>,
    /// Effects that would take most of it, with the share that they would.
    pub nearest: Vec<(&'static str, f64)>,
}

/// The portrait of what a fit leaves.
#[must_use]
pub fn portrait(problem: &Problem, fit: &Fit) -> Portrait {
    let record = problem.record;
    let period_s = record.inputs.period_s;
    let raw = problem.residual(&fit.prediction);
    let spectra: Vec<Spectrum> = raw
        .iter()
        .zip(&record.channels)
        .zip(&problem.noise)
        .map(|((raw, channel), noise)| Spectrum::new(raw, &channel.valid, *noise, period_s))
        .collect();
    let above = |spectrum: &Spectrum| spectrum.power.iter().skip(1).map(|power| power - 1.0).sum::<f64>();
    let channels = record.channels.len();
    let place = (0..channels).max_by(|a, b| above(&spectra[*a]).total_cmp(&above(&spectra[*b]))).unwrap_or(0);
    let channel = &record.channels[place];
    let column = channel.signal.column();
    let valid = raw[place].iter().zip(&channel.valid).filter(|(_, valid)| **valid).map(|(raw, _)| raw * raw);
    let (sum, count) = valid.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
    let (span_s, burst_share) = when(&fit.residual, channels, period_s);
    let band = Spectrum::bands(std::slice::from_ref(&spectra[place]));
    // torque follows what disturbs the gimbal; without it the angle must do
    let told = record.channels.iter().position(|channel| channel.signal == Signal::MotorTorque).unwrap_or(place);
    Portrait {
        signal: column.name(),
        unit: column.unit(),
        rms: [(sum / f64::max(count, 1.0)).sqrt(), problem.noise[place]],
        block: block_shares(problem, &fit.residual).into_iter().max_by(|a, b| a.1.total_cmp(&b.1)),
        band: band.into_iter().max_by(|a, b| a.share.total_cmp(&b.share)),
        regimes: regimes(record, &fit.prediction, &fit.residual, channels),
        span_s,
        burst_share,
        depends_on: dependences(problem, fit, &raw[told], &record.channels[told].valid),
        nearest: nearest(problem, fit),
    }
}

/// The shortest stretch of windows that holds most of the excess, and the share of windows that do.
fn when(whitened: &[f64], channels: usize, period_s: f64) -> ([f64; 2], f64) {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
    let length = ((WINDOW_S / period_s) as usize).max(1) * channels.max(1);
    let excess: Vec<f64> = whitened
        .chunks(length)
        .map(|window| (window.iter().map(|value| value * value).sum::<f64>() - window.len() as f64).max(0.0))
        .collect();
    let all: f64 = excess.iter().sum::<f64>().max(1e-30);
    let mut sorted = excess.clone();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let mut sum = 0.0;
    let most = sorted.iter().take_while(|excess| {
        sum += *excess;
        sum - *excess < MOST * all
    });
    let burst_share = most.count() as f64 / excess.len().max(1) as f64;
    let mut best = (0, excess.len());
    let (mut start, mut held) = (0, 0.0);
    for (end, own) in excess.iter().enumerate() {
        held += own;
        while held - excess[start] >= MOST * all {
            held -= excess[start];
            start += 1;
        }
        if held >= MOST * all && end + 1 - start < best.1 - best.0 {
            best = (start, end + 1);
        }
    }
    ([best.0 as f64 * WINDOW_S, best.1 as f64 * WINDOW_S], burst_share)
}

/// Effects by the share of the residual's power that they would take, noise and all.
fn nearest(problem: &Problem, fit: &Fit) -> Vec<(&'static str, f64)> {
    let drive: DVector<f64> = drive(&slices(&problem.whitened), &fit.residual);
    let gain = |set: &[usize]| {
        let (chosen, precision) = problem.chosen(set);
        solve(&problem.gram, &drive, &chosen, &precision).map_or(0.0, |solution| solution.gain)
    };
    let base = gain(&[]);
    let own = names(fit);
    let mut best: BTreeMap<&'static str, f64> = BTreeMap::new();
    for (index, candidate) in problem.candidates.iter().enumerate() {
        if own.contains(&candidate.effect) {
            continue;
        }
        let share = ((gain(&[index]) - base) / fit.square.max(1e-30)).clamp(0.0, 1.0);
        let entry = best.entry(candidate.effect).or_default();
        *entry = entry.max(share);
    }
    let mut nearest: Vec<(&'static str, f64)> = best.into_iter().collect();
    nearest.sort_by(|a, b| b.1.total_cmp(&a.1));
    nearest.truncate(3);
    nearest
}

/// Variables that explain a share of a residual.
fn dependences(problem: &Problem, fit: &Fit, residual: &[f64], valid: &[bool]) -> Vec<(String, f64)> {
    let record = problem.record;
    let inputs = &record.inputs;
    let period_s = inputs.period_s;
    let rate = inputs.slip_radps(&fit.prediction);
    let load: Vec<f64> = inputs.accel_mps2[0].iter().zip(&inputs.accel_mps2[1]).map(|(x, y)| x.hypot(*y)).collect();
    let angle = inputs.rel_rad(&fit.prediction);
    let torque = &fit.prediction.motor_torque_nm;
    let time: Vec<f64> = (0..record.rows()).map(|k| k as f64 * period_s).collect();
    let size = |values: &[f64]| values.iter().map(|value| value.abs()).collect::<Vec<_>>();
    let signs = |values: &[f64]| values.iter().map(|value| value.signum()).collect::<Vec<_>>();
    let ones = vec![1.0; record.rows()];
    let samples = Samples::new(residual, valid, period_s);
    let mut all = vec![
        ("odd in the bearing's rate".to_owned(), samples.share(&size(&rate), &signs(&rate))),
        ("even in the bearing's rate".to_owned(), samples.share(&size(&rate), &ones)),
        ("odd in the motor torque".to_owned(), samples.share(&size(torque), &signs(torque))),
        ("even in the motor torque".to_owned(), samples.share(&size(torque), &ones)),
        ("load, in the direction of the rate".to_owned(), samples.share(&load, &signs(&rate))),
        ("load".to_owned(), samples.share(&load, &ones)),
        ("specific force along x".to_owned(), samples.share(&inputs.accel_mps2[0], &ones)),
        ("specific force along y".to_owned(), samples.share(&inputs.accel_mps2[1], &ones)),
        ("specific force along z".to_owned(), samples.share(&inputs.accel_mps2[2], &ones)),
        ("gimbal angle".to_owned(), samples.share(&angle, &ones)),
        ("time since the start".to_owned(), samples.trend(&time)),
    ];
    if let Some((cycles, share)) = samples.periodic(&angle) {
        all.push((format!("periodic in the gimbal angle, {cycles:.1} cycles a revolution"), share));
    }
    all.retain(|(_, share)| *share > LEAST_SHARE);
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all.truncate(4);
    all
}

/// A residual in means of a few rows, and whether each second is learnt from or tried on.
struct Samples {
    values: Vec<f64>,
    rows: Vec<usize>,
    learnt: Vec<bool>,
}

impl Samples {
    fn new(residual: &[f64], valid: &[bool], period_s: f64) -> Self {
        let mut samples = Self { values: Vec::new(), rows: Vec::new(), learnt: Vec::new() };
        for (place, piece) in residual.chunks_exact(TOGETHER).enumerate() {
            let row = place * TOGETHER;
            if valid[row..row + TOGETHER].iter().all(|valid| *valid) {
                samples.values.push(piece.iter().sum::<f64>() / TOGETHER as f64);
                samples.rows.push(row + TOGETHER / 2);
                samples.learnt.push((row as f64 * period_s) % 2.0 < 1.0);
            }
        }
        samples
    }

    /// What a curve in bins of equal count, times a sign, explains of the seconds that it was not learnt from.
    fn share(&self, variable: &[f64], sign: &[f64]) -> f64 {
        let mut sorted: Vec<f64> = self.rows.iter().map(|&row| variable[row]).collect();
        if sorted.len() < 20 * BINS {
            return 0.0;
        }
        sorted.sort_by(f64::total_cmp);
        let edges: Vec<f64> = (1..BINS).map(|edge| sorted[edge * sorted.len() / BINS]).collect();
        let bin = |row: usize| edges.partition_point(|edge| *edge <= variable[row]);
        let mut sums = [(0.0, 0.0); BINS];
        for ((value, &row), _) in self.of(true) {
            let sum = &mut sums[bin(row)];
            *sum = (sum.0 + value * sign[row], sum.1 + 1.0);
        }
        let curve = sums.map(|(sum, count)| if count > 0.0 { sum / count } else { 0.0 });
        self.explained(|row| sign[row] * curve[bin(row)])
    }

    /// What a straight line in the time explains: seconds between are not unseen by a curve in time.
    fn trend(&self, time: &[f64]) -> f64 {
        let count = self.rows.len().max(1) as f64;
        let mean = self.rows.iter().map(|&row| time[row]).sum::<f64>() / count;
        let level = self.values.iter().sum::<f64>() / count;
        let (mut cross, mut own) = (0.0, 1e-30);
        for (value, &row) in self.values.iter().zip(&self.rows) {
            cross += (value - level) * (time[row] - mean);
            own += (time[row] - mean).powi(2);
        }
        self.explained(|row| cross / own * (time[row] - mean)).max(0.0)
    }

    /// The strongest line in the gimbal's angle, and what it explains.
    fn periodic(&self, angle: &[f64]) -> Option<(f64, f64)> {
        let range = self.rows.iter().map(|&row| angle[row]);
        let (low, high) = range.fold((f64::MAX, f64::MIN), |(low, high), angle| (low.min(angle), high.max(angle)));
        let finest = TAU / (high - low).max(1e-9);
        if !finest.is_finite() || finest > 50.0 {
            return None;
        }
        let amplitudes = |cycles: f64| {
            let (mut sine, mut cosine, mut count) = (0.0, 0.0, 1.0);
            for ((value, &row), _) in self.of(true) {
                let (s, c) = (cycles * angle[row]).sin_cos();
                (sine, cosine, count) = (sine + value * s, cosine + value * c, count + 0.5);
            }
            (sine / count, cosine / count)
        };
        // at least one and a half cycles within the motion: fewer are a curve
        let step = 0.5 * finest;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        let count = ((100.0 - 1.5 * finest) / step).clamp(0.0, 400.0) as usize;
        let lines = (0..count).map(|line| 1.5 * finest + line as f64 * step);
        let strength = |cycles: f64| amplitudes(cycles).0.hypot(amplitudes(cycles).1);
        let cycles = lines.max_by(|a, b| strength(*a).total_cmp(&strength(*b)))?;
        let (sine, cosine) = amplitudes(cycles);
        let of = |row: usize| {
            let (s, c) = (cycles * angle[row]).sin_cos();
            sine * s + cosine * c
        };
        Some((cycles, self.explained(of)))
    }

    fn explained(&self, curve: impl Fn(usize) -> f64) -> f64 {
        let (mut left, mut all) = (0.0, 1e-30);
        for ((value, &row), _) in self.of(false) {
            left += (value - curve(row)).powi(2);
            all += value * value;
        }
        1.0 - left / all
    }

    fn of(&self, learnt: bool) -> impl Iterator<Item = ((&f64, &usize), &bool)> {
        self.values.iter().zip(&self.rows).zip(&self.learnt).filter(move |(_, own)| **own == learnt)
    }
}

impl Portrait {
    /// In words.
    #[must_use]
    pub fn told(&self) -> String {
        let mut parts = vec![format!(
            "What is left stands out in {}: rms {:.2e} {}, noise {:.1e}",
            self.signal, self.rms[0], self.unit, self.rms[1]
        )];
        let band = self.band.iter();
        parts.extend(
            band.map(|band| format!("{:.0} % of it from {} to {} Hz", 100.0 * band.share, band.from_hz, band.to_hz)),
        );
        let [from_s, to_s] = self.span_s;
        if self.burst_share < 0.15 {
            let (most, time) = (100.0 * MOST, 100.0 * self.burst_share);
            parts.push(format!(
                "in bursts, {most:.0} % of it in {time:.0} % of the time, from {from_s:.1} to {to_s:.1} s"
            ));
        } else {
            parts.push("all the time".to_owned());
        }
        parts.extend(self.regimes.first().map(|regime| format!("most where: {}", regime.name)));
        let on = self.depends_on.iter().take(2);
        parts.extend(on.map(|(on, share)| format!("{:.0} % of it follows: {on}", 100.0 * share)));
        let nearest = self.nearest.first();
        parts.extend(
            nearest.map(|(name, share)| format!("nearest effect {name}, which would take {:.0} %", 100.0 * share)),
        );
        parts.join("; ") + "."
    }
}
