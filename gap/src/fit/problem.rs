//! One log against one model: base prediction, sensitivities to everything, noise.

use gimbal_model_file::ModelFile;
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::Whitener;
use super::normal::{products, slices};
use super::rest::{Raw, rest};
use super::whiten::Loop;
use crate::library::{Candidate, Nuisance, Offer, apply, candidates, hold, not_looked_for, nuisances, platform};
use crate::record::{Record, Signal, rough};
use crate::simulate::{Begin, Physics, Prediction, predict};

/// Time blocks.
pub const BLOCKS: usize = 10;
/// Places of the beginning that are unknown, and their standard deviations.
const STATE_SIGMA: [f64; 10] = [0.02, 2e-4, 0.1, 0.1, 3.0, 3.0, 3.0, 1e-2, 1e-2, 1.0];
/// Place of the slow section, and what tolerances leave open of its lead over its lag.
const SLOW_SECTION: usize = 3;
const SLOW_UNKNOWN: f64 = 0.05;
/// Steps in which sensitivities to the beginning are taken, over those: inside the friction's clamp, off the stops.
pub(crate) const STATE_STEP: f64 = 1e-3;

/// Share of the best fit's excess put down to the formulation, and what power of the noise may stand out by.
const FORMULATION: f64 = 0.012;
const NOISE_KNOWN: f64 = 1.005;

/// Which column is what.
#[derive(Debug, Clone)]
pub struct Columns {
    /// Number of columns of the beginning.
    pub begin: usize,
    /// Number of nominal parameters.
    pub nuisances: usize,
    /// First column of each candidate's probes.
    pub first: Vec<usize>,
}

impl Columns {
    /// Columns of a candidate, of `all` columns.
    pub(crate) fn probes(&self, candidate: usize, all: usize) -> std::ops::Range<usize> {
        self.first[candidate]..self.first.get(candidate + 1).copied().unwrap_or(all)
    }
}

/// Everything that fits are made from.
#[derive(Debug)]
pub struct Problem<'a> {
    /// The log.
    pub record: &'a Record,
    /// Nominal stop [rad].
    pub stop_rad: f64,
    /// Nominal physics.
    pub base: Physics,
    /// Where the nominal prediction begins.
    pub begin: Begin,
    /// Nominal parameters.
    pub nuisances: Vec<Nuisance>,
    /// Ways in which effects may show.
    pub candidates: Vec<Candidate>,
    /// Effects that are none: their parts are known to be good, or they are in the model.
    pub not_looked_for: Vec<&'static str>,
    /// Which column is what.
    pub columns: Columns,
    /// Whitened sensitivities.
    pub whitened: Vec<Vec<f64>>,
    /// Their Gram matrix.
    pub gram: DMatrix<f64>,
    /// Noise.
    pub whitener: Whitener,
    /// Rms of the noise of each channel.
    pub noise: Vec<f64>,
    /// Prior standard deviations of the columns.
    pub sigma: Vec<f64>,
}

impl<'a> Problem<'a> {
    /// Predicts, differentiates, whitens.
    #[must_use]
    pub fn new(record: &'a Record, model: &ModelFile) -> Self {
        Self::with_noise(record, model, None)
    }

    /// The same with the noise taken from a residual that is better known.
    #[must_use]
    pub(crate) fn with_noise(record: &'a Record, model: &ModelFile, rest_known: Option<&Signals>) -> Self {
        let mut base = platform(model);
        let not_looked_for = not_looked_for(model);
        base.config.period_s = record.inputs.period_s;
        // the float goes as far as the log shows that it goes
        let reached = record.channel(Signal::GyroAngle).map_or(0.0, |channel| peak(&channel.values));
        base.config.gyro.stop_angle_rad =
            record.plateau_rad.unwrap_or(base.config.gyro.stop_angle_rad.max(1.2 * reached));
        let begin = record.begin(&base, &record.inputs);
        let nominal = predict(&base, &record.inputs, &begin, record.rows());
        let raw = residual(record, &nominal);
        let noise: Vec<f64> =
            raw.iter().zip(&record.channels).map(|(raw, channel)| rough(raw, &channel.valid)).collect();
        let mut nuisances = nuisances(&model.tolerance, &base);
        hold(&mut nuisances, &model.known_good);
        let sees = |signal| record.channel(signal).is_some();
        let peak_torque_nm = record
            .channel(Signal::MotorTorque)
            .map_or_else(|| peak(&nominal.motor_torque_nm), |channel| high(&channel.values));
        let offer = Offer {
            peak_torque_nm,
            cycles: &[],
            sees_gimbal: sees(Signal::GimbalAngle),
            sees_torque: sees(Signal::MotorTorque),
            sees_cross: !record.inputs.cross_radps.is_empty(),
        };
        let mut candidates = candidates(&record.inputs, &offer);
        candidates.retain(|candidate| !not_looked_for.contains(&candidate.effect));
        let draft = Draft { record, base: &base, begin: &begin, nominal: &nominal };
        let (columns, mut raw_columns, sigma) = draft.columns(&nuisances, &candidates);
        let valid = valid(record);
        let scaled: Vec<f64> = noise.iter().map(|noise| 1.0 / noise).collect();
        scale(&mut raw_columns, &scaled);
        let mut target = vec![raw];
        scale(&mut target, &scaled);
        let target = target.swap_remove(0);
        // what the nominal parameters and a few effects do not explain
        let rest = match rest_known {
            None => rest(&Raw { columns: &raw_columns, layout: &columns, sigma: &sigma, valid: &valid }, &target),
            Some(known) => {
                let mut known = vec![known.clone()];
                scale(&mut known, &scaled);
                known.swap_remove(0)
            }
        };
        // lines of ripple stand out of it
        let lines = crate::fit::search::ripple_cycles(record, &nominal, &target, &noise, &valid);
        let (mut columns, mut sigma) = (columns, sigma);
        let ripple = library_ripple(&record.inputs, &offer, &lines);
        for candidate in ripple.into_iter().filter(|own| !not_looked_for.contains(&own.effect)) {
            columns.first.push(raw_columns.len());
            let mut probes = draft.probes(&candidate);
            scale(&mut probes, &scaled);
            raw_columns.extend(probes);
            sigma.extend(candidate.prior.iter().map(|(_, sigma)| *sigma));
            candidates.push(candidate);
        }
        let mut impulse = impulse(&base, record);
        scale(std::slice::from_mut(&mut impulse), &scaled);
        let (turning, share) = turning(&base, record, &nominal);
        let period_s = record.inputs.period_s;
        let turning_noise = turning_noise(&base, record, &nominal) * share.sqrt();
        let rate_noise = &record.rate_noise;
        let behind = Loop { impulse: &impulse, turning: &turning, turning_noise, rate_noise, period_s };
        let whitener = Whitener::new(&rest, &valid, behind);
        let whitened: Vec<Vec<f64>> = raw_columns.into_par_iter().map(|column| whitener.apply(&column)).collect();
        let gram = products(&slices(&whitened), &slices(&whitened), 0..whitener.rows());
        let stop_rad = model.config.gyro.stop_angle_rad;
        Self {
            record,
            stop_rad,
            base,
            begin,
            nuisances,
            candidates,
            not_looked_for,
            columns,
            whitened,
            gram,
            whitener,
            noise,
            sigma,
        }
    }

    /// The noise that the best fit leaves, over that of the sensors: what is more than the noise is known to is put
    /// down, in part, to how its effects are formulated.
    pub(crate) fn formulation(&self, best_square: f64) -> f64 {
        (FORMULATION * (best_square - NOISE_KNOWN * self.whitener.count() as f64)).max(1.0)
    }

    /// Whitened residual of a prediction.
    #[must_use]
    pub fn whiten(&self, signals: Vec<Vec<f64>>) -> Vec<f64> {
        let mut signals = vec![signals];
        let scaled: Vec<f64> = self.noise.iter().map(|noise| 1.0 / noise).collect();
        scale(&mut signals, &scaled);
        self.whitener.apply(&signals[0])
    }

    /// Other columns in the place of the first.
    pub(crate) fn replace(&mut self, columns: Vec<Vec<f64>>) {
        let fixed = columns.len();
        for (old, new) in self.whitened.iter_mut().zip(columns) {
            *old = new;
        }
        let whitened = slices(&self.whitened);
        let fresh = products(&whitened[..fixed], &whitened, 0..self.whitener.rows());
        self.gram.rows_mut(0, fixed).copy_from(&fresh);
        self.gram.columns_mut(0, fixed).copy_from(&fresh.transpose());
    }

    /// Columns and prior precisions of a set of candidates.
    #[must_use]
    pub fn chosen(&self, set: &[usize]) -> (Vec<usize>, Vec<f64>) {
        let fixed = self.columns.begin + self.columns.nuisances;
        let mut chosen: Vec<usize> = (0..fixed).collect();
        let mut sigma = self.sigma[..fixed].to_vec();
        for &index in set {
            let candidate = &self.candidates[index];
            for (release, prior) in candidate.releases.iter().zip(&candidate.prior) {
                if let Some(place) = self.nuisances.iter().position(|nuisance| nuisance.name == *release) {
                    let place = self.columns.begin + place;
                    sigma[place] = sigma[place].max(prior.1);
                }
            }
            for probe in 0..candidate.probes.len() {
                chosen.push(self.columns.first[index] + probe);
                sigma.push(candidate.prior[probe].1);
            }
        }
        (chosen, sigma.iter().map(|sigma| 1.0 / (sigma * sigma)).collect())
    }
}

fn library_ripple(inputs: &crate::simulate::Inputs, offer: &Offer, cycles: &[f64]) -> Vec<Candidate> {
    let offer = Offer { cycles, ..*offer };
    candidates(inputs, &offer).into_iter().filter(|candidate| candidate.effect == "torque_ripple").collect()
}

/// What sensitivities are made from.
struct Draft<'a> {
    record: &'a Record,
    base: &'a Physics,
    begin: &'a Begin,
    nominal: &'a Prediction,
}

/// One series a channel.
pub(crate) type Signals = Vec<Vec<f64>>;

impl Draft<'_> {
    fn columns(&self, nuisances: &[Nuisance], candidates: &[Candidate]) -> (Columns, Vec<Signals>, Vec<f64>) {
        let mut columns = Columns { begin: 0, nuisances: nuisances.len(), first: Vec::new() };
        let mut sigma = Vec::new();
        let states: Vec<usize> =
            (0..10).filter(|&state| state != 9 || self.record.channel(Signal::GimbalAngle).is_some()).collect();
        columns.begin = states.len();
        let mut all: Vec<Signals> = states.par_iter().map(|&state| self.begin_column(state)).collect();
        sigma.extend(states.iter().map(|&state| self.state_sigma(state)));
        all.par_extend(nuisances.par_iter().map(|nuisance| {
            let mut physics = self.base.clone();
            nuisance.shift(&mut physics, nuisance.step);
            self.difference(&physics, nuisance.step)
        }));
        sigma.extend(nuisances.iter().map(|nuisance| nuisance.sigma));
        let probes: Vec<Vec<Signals>> = candidates.par_iter().map(|candidate| self.probes(candidate)).collect();
        for (candidate, probes) in candidates.iter().zip(probes) {
            columns.first.push(all.len());
            sigma.extend(candidate.prior.iter().take(probes.len()).map(|(_, sigma)| *sigma));
            all.extend(probes);
        }
        (columns, all, sigma)
    }

    /// How far a place of the beginning may be from where the log seems to begin. The slow section remembers what
    /// the integrator took in, a step of the torque over its time constant, and shows the part of it that lead and
    /// lag do not cancel.
    fn state_sigma(&self, state: usize) -> f64 {
        if state != SLOW_SECTION {
            return STATE_SIGMA[state];
        }
        let servo = &self.base.config.servo;
        let (lead_s, lag_s) = (servo.lead_time_constants_s[0], servo.lag_time_constants_s[0]);
        2.0 * ((1.0 - lead_s / lag_s).abs() + SLOW_UNKNOWN) * peak(&self.nominal.motor_torque_nm) / lag_s
    }

    fn begin_column(&self, state: usize) -> Signals {
        let step = STATE_STEP * self.state_sigma(state);
        let mut begin = self.begin.clone();
        begin.state[state] += step;
        // it dies away
        let rows = if state == 9 { usize::MAX } else { remembered_rows(self.record) };
        let moved = predict(self.base, &self.record.inputs, &begin, rows);
        difference(self.record, &moved, self.nominal, step)
    }

    fn difference(&self, physics: &Physics, step: f64) -> Signals {
        let moved = predict(physics, &self.record.inputs, self.begin, usize::MAX);
        difference(self.record, &moved, self.nominal, step)
    }

    fn probes(&self, candidate: &Candidate) -> Vec<Signals> {
        candidate
            .probes
            .iter()
            .map(|(values, divisor)| {
                let mut physics = self.base.clone();
                apply(candidate.effect, values, &mut physics);
                self.difference(&physics, *divisor)
            })
            .collect()
    }
}

/// Rows for which a prediction remembers where it began.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
pub(crate) fn remembered_rows(record: &Record) -> usize {
    (MEMORY_S / record.inputs.period_s) as usize
}

/// The predicted samples of a channel.
pub(crate) fn predicted(signal: Signal, prediction: &Prediction) -> &[f64] {
    match signal {
        Signal::GyroAngle => &prediction.gyro_angle_rad,
        Signal::MotorTorque => &prediction.motor_torque_nm,
        Signal::GimbalAngle => &prediction.gimbal_angle_rad,
    }
}

/// Measured less predicted.
pub(crate) fn residual(record: &Record, prediction: &Prediction) -> Signals {
    let of = |channel: &crate::record::Channel| {
        channel.values.iter().zip(predicted(channel.signal, prediction)).map(|(a, b)| a - b).collect()
    };
    record.channels.iter().map(of).collect()
}

/// One prediction less another, over a step.
pub(crate) fn difference(record: &Record, moved: &Prediction, base: &Prediction, step: f64) -> Signals {
    let of = |channel: &crate::record::Channel| {
        let (moved, base) = (predicted(channel.signal, moved), predicted(channel.signal, base));
        let mut column: Vec<f64> = moved.iter().zip(base).map(|(a, b)| (a - b) / step).collect();
        column.resize(base.len(), 0.0);
        column
    };
    record.channels.iter().map(of).collect()
}

fn scale(columns: &mut [Signals], by: &[f64]) {
    columns.par_iter_mut().for_each(|signals| {
        for (signal, by) in signals.iter_mut().zip(by) {
            for value in signal {
                *value *= by;
            }
        }
    });
}

/// Rows at which every channel counts.
fn valid(record: &Record) -> Vec<bool> {
    (0..record.rows()).map(|k| record.channels.iter().all(|channel| channel.valid[k])).collect()
}

/// Every channel after an impulse of torque on the gimbal, bearings and unbalance aside.
fn impulse(base: &Physics, record: &Record) -> Signals {
    let mut physics = base.clone();
    physics.config.bearing.count = 0;
    physics.config.unbalance.x_kg_m = 0.0;
    physics.config.unbalance.y_kg_m = 0.0;
    let rows = 4000;
    let zero = || vec![0.0; rows];
    let mut inputs = crate::simulate::Inputs {
        period_s: record.inputs.period_s,
        accel_mps2: [zero(), zero(), zero()],
        rate_radps: zero(),
        ..Default::default()
    };
    inputs.complete(&physics.config.bearing, 0.0);
    let mut begin = Begin::at(&physics, &inputs, 0.0, Some(0.0));
    begin.state[0] = IMPULSE_RADPS;
    let run = predict(&physics, &inputs, &begin, rows);
    record.channels.iter().map(|channel| predicted(channel.signal, &run).to_vec()).collect()
}

/// Rows at which friction turns around, with what follows; and the share of them in which the noise of the rate acts.
fn turning(base: &Physics, record: &Record, nominal: &Prediction) -> (Vec<bool>, f64) {
    let slip = base.config.bearing.slip_rate_radps;
    let (mut wait, mut inside) = (0_usize, 0.0);
    let rates = record.inputs.rate_radps.iter().zip(&nominal.gimbal_rate_radps);
    let turning: Vec<bool> = rates
        .map(|(vehicle, gimbal)| {
            let turns = (vehicle - gimbal).abs() < slip;
            inside += f64::from(u8::from(turns));
            wait = if turns { AFTER_TURNING } else { wait.saturating_sub(1) };
            wait > 0
        })
        .collect();
    let all = turning.iter().filter(|turning| **turning).count();
    (turning, inside / all.max(1) as f64)
}

/// Torque that the noise of the logged rate makes on the slope of the friction law, over that of the impulse.
fn turning_noise(base: &Physics, record: &Record, nominal: &Prediction) -> f64 {
    let rate = record.rate_noise.rms_radps;
    let level = peak(&nominal.friction_nm);
    let impulse_nm = base.config.servo.gimbal_inertia_kg_m2 * IMPULSE_RADPS / record.inputs.period_s;
    rate * level / base.config.bearing.slip_rate_radps / impulse_nm
}

/// Rate after the impulse [rad/s].
const IMPULSE_RADPS: f64 = 1e-3;
/// Time for which the platform remembers where it began [s].
const MEMORY_S: f64 = 25.0;
/// Rows for which the loop remembers a disturbance.
const AFTER_TURNING: usize = 400;

/// Largest value that is held for a few rows.
fn high(values: &[f64]) -> f64 {
    values
        .windows(5)
        .map(|few| {
            few.iter().fold(f64::MAX, |least, value| if value.is_finite() { least.min(value.abs()) } else { 0.0 })
        })
        .fold(0.0, f64::max)
}

fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |peak, value| peak.max(value.abs()))
}
