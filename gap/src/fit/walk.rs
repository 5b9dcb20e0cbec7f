//! The way of a fit: Gauss-Newton steps on predictions, damped where they must be, the sensitivities taken anew where they mislead.

use nalgebra::DVector;

use super::Problem;
use super::fitted::Made;
use super::hypothesis::{Hypothesis, Outcome, Point};
use super::linear::{Equations, Linear};

/// Steps of one iteration: as the equations have it, then damped more and more.
const TRIALS: usize = 9;
/// Damping after the first step that failed, over the precision of the priors.
const LEAST_DAMPING: f64 = 3.0;
/// What a step must promise for sensitivities to be taken anew [nats].
const WORTH: f64 = 2.0;
/// What a fit may move by with the sensitivities where it was still its own [nats].
pub(super) const STILL: f64 = 4.0;
/// Share of the excess that is put down to the equations being linearised, as noise, while a fit is under way.
const LINEARISED: f64 = 0.002;
/// A step that promises less is not taken [nats].
const NOTHING: f64 = 0.05;

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

/// A fit under way.
pub(super) struct Walk<'a> {
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

impl<'a> Walk<'a> {
    /// From a point.
    pub(super) fn new(hypothesis: &'a Hypothesis<'a>, effort: Effort, point: Point) -> Self {
        Self {
            hypothesis,
            effort,
            outcome: hypothesis.evaluate(&point),
            point,
            linear: Linear::of(hypothesis.problem),
            fresh: false,
            gained: f64::INFINITY,
            refreshes: effort.refreshes(),
            damping: 0.0,
        }
    }

    /// As far as it leads. What it leaves, and the sensitivities to the beginning and to the nominal parameters where they were
    /// taken anew at its end.
    pub(super) fn ended(mut self) -> (Point, Outcome, Option<Made>, Option<Vec<Vec<f32>>>) {
        let mut last = None;
        let mut turned = self.effort != Effort::Thorough;
        for _ in 0..self.effort.iterations() {
            let Some((went, made)) = self.go() else { break };
            last = Some(made);
            let doubtful = went == Went::Less || went == Went::Nowhere && !turned;
            if self.effort != Effort::Quick && doubtful && !self.fresh && self.refreshes > 0 {
                turned = true;
                if let Some((solution, _)) = &last {
                    self.renew(&solution.coefficients);
                }
            } else if went == Went::Nowhere {
                break;
            }
        }
        let columns = (self.gained < STILL).then(|| self.linear.into_columns());
        (self.point, self.outcome, last, columns)
    }

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
