//! What is asked of a fit once it is made: without some blocks, without one of its effects, with columns beside it, as the new
//! nominal point.

use nalgebra::{DMatrix, DVector};

use super::hypothesis::Hypothesis;
use super::linear::Linear;
use super::normal::{self, Solution, products, slices, solve};
use super::pull::Pull;
use super::signals::difference;
use super::walk::linearised;
use super::{BLOCKS, Fit, Problem};
use crate::simulate::Prediction;

/// The prediction of a fit whose parameters are corrected by leaving blocks out: one step of Gauss-Newton.
#[must_use]
pub fn refit(problem: &Problem, fit: &Fit, out: &[usize]) -> Prediction {
    let hypothesis =
        Hypothesis { limits: vec![f64::MAX; fit.shifts.len()], ..Hypothesis::new(problem, &fit.set, &fit.values) };
    let rows = fit.residual.len();
    // the beginning is the log's own and stays
    let begin = problem.columns.begin;
    let mut columns = slices(&problem.whitened[begin..hypothesis.fixed()]);
    columns.extend(slices(&fit.sensitivities));
    let pull = Pull::new(problem, &hypothesis.precision, &fit.shifts);
    let mut weights = pull.curvature;
    weights.extend(hypothesis.free.iter().map(super::hypothesis::Free::precision));
    let n = columns.len();
    let (mut gram, mut drive) = (DMatrix::zeros(n, n), DVector::zeros(n));
    for block in (0..BLOCKS).filter(|block| !out.contains(block)) {
        let range = block * rows / BLOCKS..(block + 1) * rows / BLOCKS;
        gram += normal::gram(&columns, range.clone());
        drive += products(&columns, &[&fit.residual], range).column(0);
    }
    let temper = linearised(problem, fit.square);
    gram /= temper;
    drive /= temper;
    for (place, slope) in pull.slope.iter().enumerate() {
        drive[place] -= slope;
    }
    let chosen: Vec<usize> = (0..n).collect();
    let Some(solution) = solve(&gram, &drive, &chosen, &weights) else { return fit.prediction.clone() };
    let mut step = DVector::zeros(begin + n);
    step.rows_mut(begin, n).copy_from(&solution.coefficients);
    hypothesis.predict(&hypothesis.moved(&fit.point(problem), &step))
}

/// Takes the sensitivities to the nominal parameters where a fit ended.
pub(crate) fn rebase(problem: &mut Problem, fit: &Fit) {
    let hypothesis = Hypothesis::new(problem, &fit.set, &fit.values);
    let point = fit.point(problem);
    let linear = Linear::fresh(&hypothesis, &point, &hypothesis.predict(&point));
    problem.replace(linear.into_columns());
}

/// Precision of a size that may be anything: none, but for what keeps equations regular.
const FREE: f64 = 1e-9;

/// The linear equations at a fit, with columns of any size beside the nominal parameters and the beginning.
pub(crate) fn linear_beside(problem: &Problem, linear: &Linear, fit: &Fit, others: &[Vec<f32>]) -> Option<Solution> {
    let (_, precision) = problem.chosen_at(&fit.set.0, &fit.values);
    let begin = problem.columns.begin;
    let pull = Pull::new(problem, &precision, &fit.shifts);
    let (gram, mut drive) = linear.joined(others, &fit.residual);
    let mut weights = precision[..begin + problem.columns.nuisances].to_vec();
    for (place, (slope, curvature)) in pull.slope.iter().zip(&pull.curvature).enumerate() {
        drive[begin + place] -= slope;
        weights[begin + place] = *curvature;
    }
    weights.extend(others.iter().map(|_| FREE));
    let chosen: Vec<usize> = (0..drive.len()).collect();
    solve(&gram, &drive, &chosen, &weights)
}

/// What one effect of a fit contributes, whitened.
#[must_use]
pub fn without(problem: &Problem, fit: &Fit, place: usize) -> Vec<f64> {
    let (mut set, mut point) = (fit.set.clone(), fit.point(problem));
    let index = set.0.remove(place);
    point.values.remove(place);
    for release in problem.candidates[index].releases {
        if let Some(nuisance) = problem.nuisance(release) {
            point.shifts[nuisance] = 0.0;
        }
    }
    let prediction = Hypothesis::new(problem, &set, &point.values).predict(&point);
    problem.whiten(difference(problem.record, &fit.prediction, &prediction, 1.0))
}
