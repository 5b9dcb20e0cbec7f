//! One log against one model: base prediction, sensitivities to everything, noise.

use gimbal_model_file::ModelFile;
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::Whitener;
use super::draft::Draft;
use super::normal::{products, slices};
use super::path::Path;
use super::pull::Pull;
use super::rest::{Raw, rest};
use super::ripple;
use super::signals::{Signals, peak, residual, scale, valid};
use super::slip::{Slips, Turning};
use super::turning::{at_once, impulse, impulse_nm, remembered, turning_noise, turns};
use super::whiten::Loop;
use crate::library::{Candidate, Nuisance, Offer, candidates, hold, not_looked_for, nuisances, platform};
use crate::record::{Record, Signal, rough};
use crate::simulate::{Begin, Physics, predict};

/// Time blocks.
pub const BLOCKS: usize = 10;
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
    /// What a torque on the gimbal does, as long as the bearing turns around at once.
    pub path: Path,
    /// Whether it does.
    pub turns_at_once: bool,
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
        let mut impulse = impulse(&base, record);
        scale(std::slice::from_mut(&mut impulse), &scaled);
        let turns = turns(&base, record, &nominal);
        let turns_at_once = at_once(&turns);
        let turning_noise = if turns_at_once { 0.0 } else { turning_noise(&base, record, &nominal, &turns) };
        let (period_s, rate_noise) = (record.inputs.period_s, &record.rate_noise);
        let behind = Loop { impulse: &impulse, turning: &remembered(&turns), turning_noise, rate_noise, period_s };
        let mut whitener = Whitener::new(&rest, &valid, behind);
        if turns_at_once {
            let turning =
                Turning { record, base: &base, begin: &begin, nominal: &nominal, turns: &turns, scaled: &scaled };
            let slips = Slips::new(&turning, |signals| whitener.filter(signals));
            whitener = whitener.with_slips(slips);
        }
        // lines of ripple stand out of it
        let path = Path::new(&whitener, &impulse, impulse_nm(&base, record), period_s);
        let rel: Vec<f64> =
            record.inputs.turned_rad.iter().zip(&nominal.gimbal_angle_rad).map(|(a, b)| a - b).collect();
        let lines = ripple::cycles(&path, &path.drive(&whitener, &whitener.apply(&rest)), &rel, &valid, period_s);
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
            path,
            turns_at_once,
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

    /// A torque on the gimbal as the whitened channels show it [N m].
    #[must_use]
    pub(crate) fn torque_column(&self, torque_nm: &[f64]) -> Vec<f64> {
        self.path.column(&self.whitener, torque_nm)
    }

    /// Half the slopes and half the curvatures of the priors of the nominal parameters at their shifts.
    #[must_use]
    pub(crate) fn pulled(&self, precision: &[f64], shifts: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let pull = Pull::new(self, precision, shifts);
        (pull.slope, pull.curvature)
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

/// Largest value that is held for a few rows.
fn high(values: &[f64]) -> f64 {
    values
        .windows(5)
        .map(|few| {
            few.iter().fold(f64::MAX, |least, value| if value.is_finite() { least.min(value.abs()) } else { 0.0 })
        })
        .fold(0.0, f64::max)
}
