//! A set of effects as it was fitted: values, nominal parameters and beginning, what is left, what it is worth.

use gimbal_plant::Effect;
use nalgebra::DMatrix;

use super::hypothesis::{Hypothesis, Outcome, Point};
use super::normal::{Solution, of_any_scale};
use super::pull::Pull;
use super::{Problem, Set};
use crate::simulate::{Begin, Physics, Prediction};

/// Covariance and sensitivities of an iteration.
pub(super) type Made = (Solution, Vec<Vec<f32>>);

/// A set of effects, fitted.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Candidates, as the set had them.
    pub set: Set,
    /// Their names.
    pub effects: Vec<&'static str>,
    /// Values of each effect.
    pub values: Vec<Vec<f64>>,
    /// Standard errors of the values.
    pub errors: Vec<Vec<f64>>,
    /// Shifts of the nominal parameters.
    pub shifts: Vec<f64>,
    /// Where the run begins.
    pub begin: Begin,
    /// The platform as fitted.
    pub physics: Physics,
    /// What it predicts.
    pub prediction: Prediction,
    /// Whitened residual.
    pub residual: Vec<f64>,
    /// Square of the whitened residual.
    pub square: f64,
    /// Square of the shifts over their priors.
    pub prior: f64,
    /// What the evidence has beside both: volume of the parameters, cost of the search [nats].
    pub volume: f64,
    /// Sensitivities to the values at the end, whitened, with the values' places.
    pub sensitivities: Vec<Vec<f32>>,
}

impl Fit {
    /// Logarithm of the evidence when the residual counts `1 / temper`, up to what all fits of the log share.
    #[must_use]
    pub fn evidence(&self, temper: f64) -> f64 {
        -0.5 * self.square / temper - 0.5 * self.prior + self.volume
    }

    /// What it leaves and what its shifts cost.
    pub(crate) fn cost(&self) -> f64 {
        self.square + self.prior
    }

    /// Whether the size of a member of the set is zero within three standard errors.
    #[must_use]
    pub fn is_idle(&self, place: usize) -> bool {
        is_idle(self.effects[place], &self.values[place], &self.errors[place])
    }

    /// Whether it has a nominal parameter beyond its tolerance.
    pub(crate) fn is_strained(&self, problem: &Problem) -> bool {
        self.shifts.iter().zip(&problem.nuisances).any(|(shift, own)| shift.abs() > own.tolerance)
    }

    /// How many it has that none of its effects releases beyond it.
    pub(crate) fn held(&self, problem: &Problem) -> usize {
        let released = |name| self.set.0.iter().any(|&index| problem.candidates[index].releases.contains(&name));
        let all = self.shifts.iter().zip(&problem.nuisances);
        all.filter(|(shift, own)| own.is_beyond(**shift) && !released(own.name)).count()
    }

    /// Whether it has one.
    pub(super) fn is_held(&self, problem: &Problem) -> bool {
        self.held(problem) > 0
    }

    /// Where the fit stands.
    pub(crate) fn point(&self, problem: &Problem) -> Point {
        let state = self.begin.state.iter().zip(&problem.begin.state).take(problem.columns.begin).map(|(a, b)| a - b);
        Point { values: self.values.clone(), shifts: self.shifts.clone(), state: state.collect() }
    }
}

/// Whether the size of an effect is zero within three standard errors.
pub(crate) fn is_idle(effect: &str, values: &[f64], errors: &[f64]) -> bool {
    let sizes = Effect::from_name(effect).map_or(1, Effect::sizes);
    values.iter().zip(errors).take(sizes).all(|(value, error)| value.abs() < 3.0 * error)
}

fn sigma(covariance: &DMatrix<f64>, column: usize) -> f64 {
    covariance[(column, column)].max(0.0).sqrt()
}

/// Standard errors of a set's values: of those that are fitted on their own, and of the changes of what it releases.
pub(crate) fn standard_errors(
    hypothesis: &Hypothesis,
    values: &[Vec<f64>],
    shifts: &[f64],
    covariance: &DMatrix<f64>,
) -> Vec<Vec<f64>> {
    let problem = hypothesis.problem;
    let mut errors: Vec<Vec<f64>> = values.iter().map(|values| vec![0.0; values.len()]).collect();
    for (index, free) in hypothesis.free.iter().enumerate() {
        let sigma = sigma(covariance, hypothesis.fixed() + index);
        let value = values[free.effect][free.value];
        errors[free.effect][free.value] = if free.log { sigma * value.abs() } else { sigma };
    }
    for (effect, &index) in hypothesis.set.0.iter().enumerate() {
        for (place, release) in problem.candidates[index].releases.iter().enumerate() {
            if let Some(nuisance) = problem.nuisance(release) {
                let change = |by: f64| problem.nuisances[nuisance].change(&problem.base, shifts[nuisance] + by);
                errors[effect][place] = change(sigma(covariance, problem.columns.begin + nuisance)) - change(0.0);
            }
        }
    }
    errors
}

/// What a fit comes to that ended at a point; nothing is known of its errors where no step was made.
pub(super) fn finish(hypothesis: &Hypothesis, point: Point, outcome: Outcome, last: Option<Made>) -> Fit {
    let (problem, set) = (hypothesis.problem, hypothesis.set);
    let prior = hypothesis.cost(&point);
    let begin = hypothesis.begin(&point);
    let physics = hypothesis.physics(&point);
    let Point { mut values, shifts, .. } = point;
    let mut errors: Vec<Vec<f64>> = values.iter().map(|values| vec![0.0; values.len()]).collect();
    let mut volume = f64::NEG_INFINITY;
    let mut scale_free = 0.0;
    let mut sensitivities = Vec::new();
    if let Some((solution, columns)) = last {
        for (index, free) in hypothesis.free.iter().enumerate().filter(|(_, free)| free.any_scale) {
            scale_free += of_any_scale(free.sigma, sigma(&solution.covariance, hypothesis.fixed() + index));
        }
        for (effect, &index) in set.0.iter().enumerate() {
            for (place, release) in problem.candidates[index].releases.iter().enumerate() {
                if let Some(nuisance) = problem.nuisance(release) {
                    values[effect][place] = problem.nuisances[nuisance].change(&problem.base, shifts[nuisance]);
                }
            }
        }
        errors = standard_errors(hypothesis, &values, &shifts, &solution.covariance);
        let walls = Pull::new(problem, &hypothesis.precision, &shifts).walls;
        volume = solution.evidence - 0.5 * solution.gain - walls + scale_free;
        sensitivities = columns;
    }
    for &index in &set.0 {
        volume -= (problem.candidates[index].siblings as f64).ln();
    }
    Fit {
        set: set.clone(),
        effects: set.0.iter().map(|&index| problem.candidates[index].effect).collect(),
        values,
        errors,
        shifts,
        begin,
        physics,
        prediction: outcome.prediction,
        residual: outcome.residual,
        square: outcome.square,
        prior,
        volume,
        sensitivities,
    }
}
