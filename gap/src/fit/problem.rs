//! One log against one model: base prediction, sensitivities to everything, noise.

use std::sync::Arc;

use gimbal_model_file::ModelFile;
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::ground::Ground;
use super::normal::{gram, narrow, products, slices};
use super::path::Path;
use super::shapes::Shapes;
use super::signals::{Kept, Signals, of_channel, residual, scaled};
use super::{Fit, Whitener};
use crate::library::{Candidate, Nuisance};
use crate::record::{Record, rough, tails};
use crate::simulate::{Begin, Physics, Prediction};

/// Time blocks.
pub const BLOCKS: usize = 10;
/// Share of the best fit's excess put down to the formulation; what power of the noise may stand out by, and by how many
/// standard deviations of chance.
const FORMULATION: f64 = 0.012;
const NOISE_KNOWN: f64 = 1.005;
const BY_CHANCE: f64 = 3.0;
/// Power of noise over that of its middle from which on it has tails.
const TAILS: f64 = 1.1;
/// Share of the gap that a formulation may leave.
const MAY_LEAVE: f64 = 0.02;

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
    pub whitened: Vec<Vec<f32>>,
    /// Their Gram matrix.
    pub gram: DMatrix<f64>,
    /// Noise.
    pub whitener: Whitener,
    /// What noise looks like in each channel, that of the inputs as a torque of so much at every row [N m].
    pub(super) shapes: Arc<Vec<Shapes>>,
    pub(super) impulse_nm: f64,
    /// What a torque on the gimbal does, as long as the bearing does not turn around.
    pub path: Path,
    /// Whether it hardly ever moves one way for long.
    pub turns_mostly: bool,
    /// Rows at which it does, or nearly.
    pub turns: Vec<bool>,
    /// Rms of the noise of each channel.
    pub noise: Vec<f64>,
    /// Highest torque that was measured for some rows; none where it is not [N m].
    pub ceiling_nm: Option<f64>,
    /// Prior standard deviations of the columns.
    pub sigma: Vec<f64>,
}

impl<'a> Problem<'a> {
    /// Predicts, differentiates, whitens.
    #[must_use]
    pub fn new(record: &'a Record, model: &ModelFile) -> Self {
        let ground = Ground::new(record, model);
        let mut problem = ground.problem(None);
        ground.complete(&mut problem);
        problem
    }

    /// Measured less predicted, each stop left as the log shows that it was.
    pub(crate) fn residual(&self, prediction: &Prediction) -> Signals {
        let own = residual(self.record, prediction);
        let released = self.whitener.slips().released();
        if released.is_empty() {
            return own;
        }
        let over: Vec<f64> = self.noise.iter().map(|noise| 1.0 / noise).collect();
        scaled(released.without(&scaled(own, &over)), &self.noise)
    }

    /// With more sensitivities, from those that are not whitened.
    pub(super) fn add_columns(&mut self, raw: &[Kept], more: &[Kept]) {
        let white = |column: &Kept| narrow(&self.whitener.apply(&column.signals()));
        let fresh: Vec<Vec<f32>> = raw.par_iter().chain(more).map(white).collect();
        let (rows, before) = (self.whitener.rows(), self.whitened.len());
        self.whitened.extend(fresh);
        let whitened = slices(&self.whitened);
        let (old, new) = whitened.split_at(before);
        let (beside, own) = (products(old, new, 0..rows), gram(new, 0..rows));
        let all = whitened.len();
        self.gram.resize_mut(all, all, 0.0);
        self.gram.view_mut((0, before), (before, own.ncols())).copy_from(&beside);
        self.gram.view_mut((before, 0), (own.nrows(), before)).copy_from(&beside.transpose());
        self.gram.view_mut((before, before), own.shape()).copy_from(&own);
    }

    /// The noise that the best fit leaves, over that of the sensors: what is more than the noise is known to is put
    /// down, in part, to how its effects are formulated, as far as chance does not make it, or their formulation may leave
    /// it of what they take away.
    pub(crate) fn formulation(&self, best: &Fit, null: &Fit) -> f64 {
        let noise = self.roughness(&best.residual).max(1.0);
        let count = self.whitener.count() as f64;
        let excess = best.square - noise * NOISE_KNOWN * count;
        let by_chance = noise * BY_CHANCE * (2.0 * count).sqrt();
        let left = MAY_LEAVE * (null.square - best.square);
        (FORMULATION * excess.min(left.max(excess - by_chance))).max(noise)
    }

    /// Power of what a residual does from row to row: that is noise, whatever effects leave.
    fn roughness(&self, whitened: &[f64]) -> f64 {
        let channels = self.record.channels.len();
        let of = |channel: usize| -> f64 {
            let series: Vec<f64> = of_channel(whitened, channel, channels).collect();
            let valid = &self.whitener.valid;
            let (middle, all) = (rough(&series, valid).powi(2), tails(&series, valid));
            if all > TAILS * middle { all } else { middle }
        };
        (0..channels).map(of).sum::<f64>() / channels as f64
    }

    /// Whitened residual of a prediction.
    #[must_use]
    pub fn whiten(&self, signals: Signals) -> Vec<f64> {
        let over_noise: Vec<f64> = self.noise.iter().map(|noise| 1.0 / noise).collect();
        self.whitener.apply(&scaled(signals, &over_noise))
    }

    /// What speaks for a torque at random in what a fit leaves of some rows, beyond one that the noise of the logged inputs
    /// makes [nats].
    pub(crate) fn torque_at_random(&self, whitened: &[f64], rows: &[bool], inputs_nm: f64) -> f64 {
        let most = (inputs_nm / self.impulse_nm).powi(2);
        self.whitener.beyond_inputs(whitened, rows, &self.shapes, most, self.record.inputs.period_s)
    }

    /// Power of a channel's noise at a frequency, what the loop makes of the pick-off's and all of it, where 1 is white noise of
    /// one unit.
    pub(crate) fn in_loop_and_all(&self, channel: usize, hz: f64) -> [f64; 2] {
        let (noise, shapes) = (&self.whitener.noise[channel], self.shapes[channel].at(hz));
        let unit = self.noise[channel].powi(2);
        [noise.of_loop(shapes), noise.power(hz, shapes)].map(|power| unit * power)
    }

    /// A torque on the gimbal as the whitened channels show it [N m].
    #[must_use]
    pub(crate) fn torque_column(&self, torque_nm: &[f64]) -> Vec<f32> {
        narrow(&self.path.column(&self.whitener, torque_nm))
    }

    /// Other columns in the place of the first.
    pub(crate) fn replace(&mut self, columns: Vec<Vec<f32>>) {
        let fixed = columns.len();
        for (old, new) in self.whitened.iter_mut().zip(columns) {
            *old = new;
        }
        let whitened = slices(&self.whitened);
        let fresh = products(&whitened[..fixed], &whitened, 0..self.whitener.rows());
        self.gram.rows_mut(0, fixed).copy_from(&fresh);
        self.gram.columns_mut(0, fixed).copy_from(&fresh.transpose());
    }

    /// The first candidate of an effect; one from elsewhere is taken in where there is none.
    pub(crate) fn candidate_of(&mut self, other: &Candidate) -> usize {
        let own = self.candidates.iter().position(|candidate| candidate.effect == other.effect);
        own.unwrap_or_else(|| {
            self.columns.first.push(self.whitened.len());
            self.candidates.push(other.clone());
            self.candidates.len() - 1
        })
    }

    /// Place of a nominal parameter.
    pub(crate) fn nuisance(&self, name: &str) -> Option<usize> {
        self.nuisances.iter().position(|nuisance| nuisance.name == name)
    }

    /// Places of the nominal parameters that a candidate releases, and the shifts that its values stand for.
    pub(crate) fn released(&self, index: usize, values: &[f64]) -> impl Iterator<Item = (usize, f64)> {
        let of = |(name, &value): (&&'static str, &f64)| {
            let place = self.nuisance(name)?;
            Some((place, self.nuisances[place].shift_of(value)))
        };
        self.candidates[index].releases.iter().zip(values).filter_map(of)
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
                if let Some(place) = self.nuisance(release) {
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

    /// The same of a set with values: a nominal parameter that one takes farther than is realistic is not pulled back from there.
    pub(crate) fn chosen_at(&self, set: &[usize], values: &[Vec<f64>]) -> (Vec<usize>, Vec<f64>) {
        let (chosen, mut precision) = self.chosen(set);
        for (&index, values) in set.iter().zip(values) {
            for (place, shift) in self.released(index, values) {
                let own = &mut precision[self.columns.begin + place];
                *own = own.min(1.0 / (shift * shift));
            }
        }
        (chosen, precision)
    }
}
