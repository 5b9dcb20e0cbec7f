//! A set of effects with everything that is fitted along with it, and the places at which it is tried.

use gimbal_plant::{Bound, Effect};
use nalgebra::DVector;

use super::normal::narrow;
use super::pull::Pull;
use super::signals::{difference, residual};
use super::{Problem, Set};
use crate::library::{Nuisance, WOUND, apply};
use crate::simulate::{Begin, Physics, Prediction, Variant, predict, predict_each};

/// Step of a sensitivity to a value, in its logarithm or over its size.
const STEP: f64 = 5e-4;
/// Standard deviation of the logarithm of a parameter that is not a size.
const SHAPE_SIGMA: f64 = 1.2;
/// Standard deviation of the share of its torque with which a cable begins.
const WOUND_SIGMA: f64 = 0.5;

/// One try: values of the effects, shifts of the nominal parameters, the beginning.
#[derive(Debug, Clone)]
pub(crate) struct Point {
    pub(crate) values: Vec<Vec<f64>>,
    pub(crate) shifts: Vec<f64>,
    /// From where the log seems to begin.
    pub(crate) state: Vec<f64>,
}

impl Point {
    /// Effects of some values on the nominal platform, begun where the log seems to begin.
    pub(crate) fn nominal(problem: &Problem, values: Vec<Vec<f64>>) -> Self {
        Self { values, shifts: vec![0.0; problem.nuisances.len()], state: vec![0.0; problem.columns.begin] }
    }
}

/// Squares that sets of candidates leave at points, without a fit.
pub(crate) fn left(problem: &Problem, tries: &[(Set, Point)]) -> Vec<f64> {
    let variant = |(set, point): &(Set, Point)| Hypothesis::new(problem, set, &point.values).variant(point, usize::MAX);
    let variants: Vec<Variant> = tries.iter().map(variant).collect();
    predict_each(&variants, &problem.record.inputs, |_, prediction| Outcome::of(problem, prediction).square)
}

/// What a try predicts.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) prediction: Prediction,
    /// Whitened residual.
    pub(crate) residual: Vec<f64>,
    /// Its square.
    pub(crate) square: f64,
}

impl Outcome {
    pub(crate) fn of(problem: &Problem, prediction: Prediction) -> Self {
        let residual = problem.whiten(residual(problem.record, &prediction));
        let square = residual.iter().map(|value| value * value).sum();
        Self { prediction, residual, square }
    }
}

/// How a value follows a step that is not in its logarithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Goes {
    /// By as much.
    Along,
    /// Small steps multiply it: the size of a cable's loop goes along with its displacement where that is long.
    ByShares,
    /// Between one and less than one: how a cable's loop begins, of all its torque.
    Within,
}

/// One value that is fitted beside the nominal parameters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Free {
    pub(crate) effect: usize,
    pub(crate) value: usize,
    /// Fitted in its logarithm.
    pub(crate) log: bool,
    /// A size that has no scale of its own.
    pub(crate) any_scale: bool,
    pub(crate) goes: Goes,
    pub(crate) sigma: f64,
    pub(crate) center: f64,
}

impl Free {
    pub(crate) fn precision(&self) -> f64 {
        1.0 / (self.sigma * self.sigma)
    }

    /// How far the value is from the middle of its prior.
    pub(crate) fn off(&self, values: &[Vec<f64>]) -> f64 {
        let value = values[self.effect][self.value];
        (if self.log { value.ln() } else { value }) - self.center
    }
}

/// A set, its free values, its priors.
#[derive(Debug)]
pub(crate) struct Hypothesis<'a> {
    pub(crate) problem: &'a Problem<'a>,
    pub(crate) set: &'a Set,
    pub(crate) free: Vec<Free>,
    /// Precisions of the beginning and the nominal parameters under the set.
    pub(crate) precision: Vec<f64>,
    /// How far the nominal parameters may go.
    pub(crate) limits: Vec<f64>,
}

impl<'a> Hypothesis<'a> {
    /// Its free values, and their priors around `start`.
    pub(crate) fn new(problem: &'a Problem, set: &'a Set, start: &[Vec<f64>]) -> Self {
        let (_, mut precision) = problem.chosen_at(&set.0, start);
        precision.truncate(problem.columns.begin + problem.columns.nuisances);
        let limits = limits(problem, &precision);
        Self { problem, set, free: free(problem, set, start), precision, limits }
    }

    /// Number of columns of the beginning and the nominal parameters.
    pub(crate) fn fixed(&self) -> usize {
        self.precision.len()
    }

    /// The platform at a point.
    pub(crate) fn physics(&self, point: &Point) -> Physics {
        let mut physics = self.problem.base.clone();
        for (nuisance, shift) in self.problem.nuisances.iter().zip(&point.shifts) {
            nuisance.shift(&mut physics, *shift);
        }
        for (&index, values) in self.set.0.iter().zip(&point.values) {
            let candidate = &self.problem.candidates[index];
            if candidate.releases.is_empty() {
                apply(candidate.effect, values, &mut physics);
            }
        }
        physics
    }

    /// Where the run begins at a point.
    pub(crate) fn begin(&self, point: &Point) -> Begin {
        let mut begin = self.problem.begin.clone();
        for (place, shift) in begin.state.iter_mut().zip(&point.state) {
            *place += shift;
        }
        begin
    }

    /// The prediction at a point.
    pub(crate) fn predict(&self, point: &Point) -> Prediction {
        predict(&self.physics(point), &self.problem.record.inputs, &self.begin(point), usize::MAX)
    }

    /// Some rows of it, as one of many.
    pub(crate) fn variant(&self, point: &Point, rows: usize) -> Variant<'static> {
        Variant { physics: self.physics(point), begin: self.begin(point), rate_radps: None, pushed: None, rows }
    }

    /// Prediction and whitened residual at a point.
    pub(crate) fn evaluate(&self, point: &Point) -> Outcome {
        Outcome::of(self.problem, self.predict(point))
    }

    /// What the prediction changes by from a point to moved ones, whitened, over the steps; nothing where one of them comes to no
    /// end, as one column of no numbers would leave none of the others a fit.
    pub(crate) fn slopes(&self, moved: Vec<(Variant, f64)>, now: &Prediction) -> Vec<Vec<f32>> {
        let (variants, steps): (Vec<Variant>, Vec<f64>) = moved.into_iter().unzip();
        let record = self.problem.record;
        predict_each(&variants, &record.inputs, |index, moved| {
            let column = narrow(&self.problem.whiten(difference(record, &moved, now, steps[index])));
            if column.iter().all(|value| value.is_finite()) { column } else { vec![0.0; column.len()] }
        })
    }

    /// Sensitivity to every free value.
    pub(crate) fn sensitivities(&self, point: &Point, now: &Prediction) -> Vec<Vec<f32>> {
        let of = |free: &Free| {
            let mut moved = point.clone();
            let value = &mut moved.values[free.effect][free.value];
            let step = if free.log { STEP } else { STEP * value.abs().max(free.sigma) };
            if free.log {
                *value *= step.exp();
            } else {
                *value += step;
            }
            (self.variant(&moved, usize::MAX), step)
        };
        self.slopes(self.free.iter().map(of).collect(), now)
    }

    /// What the priors cost at a point.
    pub(crate) fn cost(&self, point: &Point) -> f64 {
        let begin: f64 =
            point.state.iter().zip(&self.precision).map(|(value, precision)| value * value * precision).sum();
        let values: f64 = self.free.iter().map(|free| free.off(&point.values).powi(2) * free.precision()).sum();
        begin + Pull::new(self.problem, &self.precision, &point.shifts).cost + values
    }

    /// A point after a step of all columns.
    pub(crate) fn moved(&self, point: &Point, step: &DVector<f64>) -> Point {
        let mut next = point.clone();
        let (begin, fixed) = (point.state.len(), self.fixed());
        for (place, state) in next.state.iter_mut().enumerate() {
            *state += step[place];
        }
        for ((place, shift), limit) in next.shifts.iter_mut().enumerate().zip(&self.limits) {
            *shift = (*shift + step[begin + place]).clamp(-limit, *limit);
        }
        for (place, free) in self.free.iter().enumerate() {
            let value = &mut next.values[free.effect][free.value];
            let step = step[fixed + place];
            if free.log {
                *value *= step.clamp(-1.0, 1.0).exp();
            } else if free.goes == Goes::Within {
                *value = (*value + step).clamp(-1.0, 1.0);
            } else if free.goes == Goes::ByShares && step.abs() < value.abs() {
                *value *= (step / *value).exp();
            } else {
                *value += step;
            }
        }
        next
    }
}

/// The values that are fitted on their own.
fn free(problem: &Problem, set: &Set, start: &[Vec<f64>]) -> Vec<Free> {
    let mut all = Vec::new();
    for (effect, &index) in set.0.iter().enumerate() {
        let candidate = &problem.candidates[index];
        let Some(entry) = Effect::from_name(candidate.effect).filter(|_| candidate.releases.is_empty()) else {
            continue;
        };
        for (value, parameter) in entry.parameters().iter().enumerate() {
            let log = parameter.bound != Bound::Any && start[effect][value] > 0.0;
            let size = value < entry.sizes();
            let own = start[effect][value];
            let spread = 0.5 * parameter.low.abs().max(parameter.high.abs());
            let (sigma, center) = if log {
                (SHAPE_SIGMA, own.ln())
            } else if size {
                (spread.max(own.abs()), 0.0)
            } else {
                // cycles and phases move little from where they were found
                (if parameter.unit == "rad" { 1.0 } else { 0.02 * own.abs().max(1.0) }, own)
            };
            let goes = if size && candidate.effect == "cable_hysteresis" { Goes::ByShares } else { Goes::Along };
            all.push(Free { effect, value, log, any_scale: size && !log, goes, sigma, center });
        }
        if candidate.effect == "cable_hysteresis" && start[effect].len() > WOUND {
            let (log, any_scale, goes) = (false, false, Goes::Within);
            all.push(Free { effect, value: WOUND, log, any_scale, goes, sigma: WOUND_SIGMA, center: 0.0 });
        }
    }
    all
}

/// How far nominal parameters may go: little beyond their tolerance, or as far as a release lets them.
fn limits(problem: &Problem, precision: &[f64]) -> Vec<f64> {
    let released = |place: usize| 1.0 / precision[problem.columns.begin + place].sqrt();
    let of = |(place, nuisance): (usize, &Nuisance)| {
        if released(place) > 1.01 * nuisance.sigma { (16.0 * released(place)).min(1.7) } else { 4.0 * nuisance.sigma }
    };
    problem.nuisances.iter().enumerate().map(of).collect()
}
