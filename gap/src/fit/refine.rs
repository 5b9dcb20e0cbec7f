//! A set of effects fitted to the outputs themselves: Gauss-Newton on predictions, damped where it must be, nominal
//! parameters and beginning along with it.

use gimbal_plant::Effect;
use nalgebra::{DMatrix, DVector};

use super::hypothesis::{Hypothesis, Outcome, Point};
use super::linear::{Equations, Linear};
use super::normal::{Solution, of_any_scale};
use super::pull::Pull;
use super::{Problem, Set};
use crate::simulate::{Begin, Physics, Prediction};

/// Steps of one iteration: as the equations have it, then damped more and more.
const TRIALS: usize = 9;
/// Damping after the first step that failed, over the precision of the priors.
const LEAST_DAMPING: f64 = 3.0;
/// What a step must promise for sensitivities to be taken anew [nats].
const WORTH: f64 = 2.0;
/// What a fit may move by with the sensitivities where it was still its own [nats].
pub(super) const STILL: f64 = 4.0;
/// A step that promises less is not taken [nats].
const NOTHING: f64 = 0.05;
/// Share of the excess that is put down to the equations being linearised, as noise, while a fit is under way.
const LINEARISED: f64 = 0.002;

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

/// How far a fit is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Far enough to be compared.
    Quick,
    /// To its end, by the sensitivities that the problem holds unless they mislead.
    Full,
    /// To its end, by the sensitivities there.
    Thorough,
}

impl Effort {
    fn iterations(self) -> usize {
        if self == Self::Quick { 5 } else { 12 }
    }

    /// How often sensitivities to the nominal parameters may be taken anew.
    fn refreshes(self) -> usize {
        if self == Self::Quick { 1 } else { 4 }
    }
}

/// Noise that the equations' being linear is taken for.
pub(crate) fn linearised(problem: &Problem, square: f64) -> f64 {
    (LINEARISED * (square - problem.whitener.count() as f64)).max(1.0)
}

/// Fits a set from the values given, and from the nominal parameters and the beginning of another fit.
#[must_use]
pub fn refine(problem: &Problem, set: &Set, start: &[Vec<f64>], from: Option<&Fit>, effort: Effort) -> Fit {
    refined(problem, set, start, from, effort).0
}

/// The same, with the sensitivities to the beginning and to the nominal parameters where they were taken anew at its end.
pub(super) fn refined(
    problem: &Problem,
    set: &Set,
    start: &[Vec<f64>],
    from: Option<&Fit>,
    effort: Effort,
) -> (Fit, Option<Vec<Vec<f32>>>) {
    let hypothesis = Hypothesis::new(problem, set, start);
    let mut point = from.map_or_else(|| Point::nominal(problem, Vec::new()), |fit| fit.point(problem));
    point.values = start.to_vec();
    let outcome = hypothesis.evaluate(&point);
    let mut walk = Walk {
        hypothesis: &hypothesis,
        effort,
        point,
        outcome,
        linear: Linear::of(problem),
        fresh: false,
        gained: f64::INFINITY,
        refreshes: effort.refreshes(),
        damping: 0.0,
    };
    let mut last = None;
    let mut turned = effort != Effort::Thorough;
    for _ in 0..effort.iterations() {
        let Some((went, made)) = walk.go() else { break };
        last = Some(made);
        let doubtful = went == Went::Less || went == Went::Nowhere && !turned;
        if effort != Effort::Quick && doubtful && !walk.fresh && walk.refreshes > 0 {
            turned = true;
            if let Some((solution, _)) = &last {
                walk.renew(&solution.coefficients);
            }
        } else if went == Went::Nowhere {
            break;
        }
    }
    let Walk { point, outcome, linear, gained, .. } = walk;
    let columns = (gained < STILL).then(|| linear.into_columns());
    (finish(&hypothesis, point, outcome, last), columns)
}

/// A set as it stands at a point, without a step.
pub(crate) fn stand(problem: &Problem, set: &Set, point: Point) -> Fit {
    let hypothesis = Hypothesis::new(problem, set, &point.values);
    let outcome = hypothesis.evaluate(&point);
    let sensitivities = hypothesis.sensitivities(&point, &outcome.prediction);
    let temper = linearised(problem, outcome.square);
    let linear = Linear::of(problem);
    let equations = Equations::new(&hypothesis, &point, &linear, &sensitivities, &outcome.residual, temper);
    let made = equations.step(0.0).map(|step| (step.solution, sensitivities));
    finish(&hypothesis, point, outcome, made)
}

/// How an iteration went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Went {
    /// As the equations promised.
    Well,
    /// Forward, by less than promised.
    Less,
    /// Not worth another one.
    Nowhere,
}

/// Covariance and sensitivities of an iteration.
type Made = (Solution, Vec<Vec<f32>>);

/// A fit under way.
struct Walk<'a> {
    hypothesis: &'a Hypothesis<'a>,
    effort: Effort,
    point: Point,
    outcome: Outcome,
    linear: Linear<'a>,
    /// Whether the sensitivities are those of the point.
    fresh: bool,
    /// What the cost fell by since they were taken anew.
    gained: f64,
    /// How often they may still be.
    refreshes: usize,
    damping: f64,
}

impl Walk<'_> {
    /// Takes the sensitivities anew: all of them where the fit is for those, or those to what a step moves.
    fn renew(&mut self, step: &DVector<f64>) {
        let (hypothesis, outcome) = (self.hypothesis, &self.outcome);
        self.refreshes -= 1;
        self.fresh = true;
        if self.effort == Effort::Thorough {
            self.gained = 0.0;
            self.linear = Linear::fresh(hypothesis, &self.point, &outcome.prediction);
        } else {
            let moved = self.linear.moved_by(step, linearised(hypothesis.problem, outcome.square));
            self.linear.renew(hypothesis, &self.point, &outcome.prediction, &moved);
        }
    }

    /// One iteration: a step that lowers the cost, with sensitivities taken anew or damping where none does. The
    /// covariance is that of the equations without damping.
    fn go(&mut self) -> Option<(Went, Made)> {
        let hypothesis = self.hypothesis;
        let temper = linearised(hypothesis.problem, self.outcome.square);
        let cost = self.outcome.square / temper + hypothesis.cost(&self.point);
        let sensitivities = hypothesis.sensitivities(&self.point, &self.outcome.prediction);
        let point = self.point.clone();
        let equations = |linear: &Linear, outcome: &Outcome| {
            Equations::new(hypothesis, &point, linear, &sensitivities, &outcome.residual, temper)
        };
        let mut system = equations(&self.linear, &self.outcome);
        let mut refreshed = false;
        for _ in 0..TRIALS {
            let Some(step) = system.step(self.damping) else { break };
            if step.promised < NOTHING {
                break;
            }
            let next = hypothesis.moved(&point, &step.solution.coefficients);
            let outcome = hypothesis.evaluate(&next);
            let gained = cost - outcome.square / temper - hypothesis.cost(&next);
            if gained > 0.0 {
                let far = temper > 1.0 && outcome.square < 0.9 * self.outcome.square;
                let went = if gained < 0.6 * step.promised && step.promised > 4.0 {
                    Went::Less
                } else if gained > 0.3 || far {
                    Went::Well
                } else {
                    Went::Nowhere
                };
                (self.point, self.outcome, self.fresh) = (next, outcome, false);
                self.gained += gained;
                let solution = if self.damping > 0.0 { system.step(0.0)?.solution } else { step.solution };
                self.damping = if self.damping > LEAST_DAMPING { 0.03 * self.damping } else { 0.0 };
                return Some((went, (solution, sensitivities)));
            }
            if !self.fresh && self.refreshes > 0 && step.promised > WORTH {
                self.renew(&step.solution.coefficients);
                refreshed = true;
                system = equations(&self.linear, &self.outcome);
            } else {
                // it was not the sensitivities to the nominal parameters that misled
                if refreshed {
                    self.refreshes = 0;
                }
                self.damping = (10.0 * self.damping).max(LEAST_DAMPING);
            }
        }
        Some((Went::Nowhere, (system.step(0.0)?.solution, sensitivities)))
    }
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

fn finish(hypothesis: &Hypothesis, point: Point, outcome: Outcome, last: Option<Made>) -> Fit {
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
