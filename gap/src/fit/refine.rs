//! A set of effects fitted to the outputs themselves, nominal parameters and beginning along with it.

use super::fitted::finish;
use super::hypothesis::{Hypothesis, Point};
use super::linear::{Equations, Linear};
use super::walk::{Effort, Walk, linearised};
use super::{Fit, Problem, Set};

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
    let (point, outcome, last, columns) = Walk::new(&hypothesis, effort, point).ended();
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
