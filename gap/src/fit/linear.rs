//! The equations of one step: sensitivities at a point, residual, priors, walls.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::Problem;
use super::draft::{STATE_STEP, remembered_rows};
use super::hypothesis::{Hypothesis, Point};
use super::normal::{Solution, gram, narrow, products, slices, solve};
use super::pull::Pull;
use crate::simulate::Prediction;

/// Square of what the shift of a nominal parameter by itself must change, over the noise, so that it matters how it does [1].
const MOVES: f64 = 100.0;
/// Place of the gimbal's angle at the beginning, which does not die away.
const PHI: usize = 9;

/// Sensitivities to the beginning and to the nominal parameters, and their Gram matrix.
pub(crate) struct Linear<'a> {
    columns: Vec<Cow<'a, [f32]>>,
    gram: DMatrix<f64>,
}

impl<'a> Linear<'a> {
    /// Those that the problem holds.
    pub(crate) fn of(problem: &'a Problem) -> Self {
        let fixed = problem.columns.begin + problem.columns.nuisances;
        let gram = problem.gram.view((0, 0), (fixed, fixed)).into_owned();
        let columns = problem.whitened[..fixed].iter().map(|column| Cow::Borrowed(column.as_slice())).collect();
        Self { columns, gram }
    }

    /// Those of the platform at a point.
    pub(crate) fn fresh(hypothesis: &Hypothesis, point: &Point, now: &Prediction) -> Self {
        let all: Vec<usize> = (0..hypothesis.fixed()).collect();
        let columns = taken(hypothesis, point, now, &all);
        let gram = gram(&slices(&columns), 0..hypothesis.problem.whitener.rows());
        Self { columns: columns.into_iter().map(Cow::Owned).collect(), gram }
    }

    /// Places of the columns by which a step changes what is predicted, where the residual counts `1 / temper`.
    pub(super) fn moved_by(&self, step: &DVector<f64>, temper: f64) -> Vec<usize> {
        let moves = |place: &usize| step[*place].powi(2) * self.gram[(*place, *place)] > MOVES * temper;
        (0..self.columns.len()).filter(moves).collect()
    }

    /// Some of them those of the platform at a point.
    pub(super) fn renew(&mut self, hypothesis: &Hypothesis, point: &Point, now: &Prediction, places: &[usize]) {
        for (&place, column) in places.iter().zip(taken(hypothesis, point, now, places)) {
            self.columns[place] = Cow::Owned(column);
        }
        let all = self.columns();
        let new: Vec<&[f32]> = places.iter().map(|&place| all[place]).collect();
        let fresh = products(&all, &new, 0..hypothesis.problem.whitener.rows());
        for (&place, products) in places.iter().zip(fresh.column_iter()) {
            self.gram.set_column(place, &products);
            self.gram.set_row(place, &products.transpose());
        }
    }

    /// The columns.
    pub(crate) fn columns(&self) -> Vec<&[f32]> {
        self.columns.iter().map(AsRef::as_ref).collect()
    }

    /// The same by themselves.
    pub(super) fn into_columns(self) -> Vec<Vec<f32>> {
        self.columns.into_iter().map(Cow::into_owned).collect()
    }

    /// Normal equations of these columns and others.
    pub(crate) fn joined(&self, others: &[Vec<f32>], residual: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let fixed = self.columns.len();
        let more = others.len();
        let mut columns = self.columns();
        columns.extend(slices(others));
        let mut right = slices(others);
        let residual = narrow(residual);
        right.push(&residual);
        let fresh = products(&columns, &right, 0..residual.len());
        let mut gram = DMatrix::zeros(fixed + more, fixed + more);
        gram.view_mut((0, 0), (fixed, fixed)).copy_from(&self.gram);
        gram.columns_mut(fixed, more).copy_from(&fresh.columns(0, more));
        gram.view_mut((fixed, 0), (more, fixed)).copy_from(&fresh.view((0, 0), (fixed, more)).transpose());
        (gram, fresh.column(more).into_owned())
    }
}

/// Sensitivities of the platform at a point, to some of the beginning and of the nominal parameters.
fn taken(hypothesis: &Hypothesis, point: &Point, now: &Prediction, places: &[usize]) -> Vec<Vec<f32>> {
    let problem = hypothesis.problem;
    let begin = point.state.len();
    let column = |place: usize| {
        let mut moved = point.clone();
        let step = if place < begin {
            let step = STATE_STEP * problem.sigma[place];
            moved.state[place] += step;
            step
        } else {
            let step = problem.nuisances[place - begin].step;
            moved.shifts[place - begin] += step;
            step
        };
        // what changes at the beginning alone dies away
        let rows = if place < begin.min(PHI) { remembered_rows(problem.record) } else { usize::MAX };
        (hypothesis.variant(&moved, rows), step)
    };
    hypothesis.slopes(places.iter().map(|&place| column(place)).collect(), now)
}

/// Normal equations at a point, but for the pull of the priors of the nominal parameters.
pub(crate) struct Equations<'a> {
    hypothesis: &'a Hypothesis<'a>,
    point: &'a Point,
    gram: DMatrix<f64>,
    drive: DVector<f64>,
    /// Precisions of the free values.
    weights: Vec<f64>,
}

/// What a step is, and what it promises to take from the cost.
pub(crate) struct Step {
    pub(crate) solution: Solution,
    pub(crate) promised: f64,
}

impl<'a> Equations<'a> {
    /// With the residual's weight divided by `temper`.
    pub(crate) fn new(
        hypothesis: &'a Hypothesis,
        point: &'a Point,
        linear: &Linear,
        sensitivities: &[Vec<f32>],
        residual: &[f64],
        temper: f64,
    ) -> Self {
        let (mut gram, mut drive) = linear.joined(sensitivities, residual);
        gram /= temper;
        drive /= temper;
        for (place, value) in point.state.iter().enumerate() {
            drive[place] -= hypothesis.precision[place] * value;
        }
        let weights: Vec<f64> = hypothesis.free.iter().map(super::hypothesis::Free::precision).collect();
        for (place, free) in hypothesis.free.iter().enumerate() {
            drive[hypothesis.fixed() + place] -= weights[place] * free.off(&point.values);
        }
        Self { hypothesis, point, gram, drive, weights }
    }

    /// The step of least cost, damped by a multiple of the priors. Which walls it ends behind decides which pull:
    /// solved until that stands.
    pub(crate) fn step(&self, damping: f64) -> Option<Step> {
        let (problem, precision) = (self.hypothesis.problem, &self.hypothesis.precision);
        let (shifts, state) = (&self.point.shifts, self.point.state.len());
        let limits = &self.hypothesis.limits;
        let natural: Vec<f64> = precision.iter().chain(&self.weights).copied().collect();
        let mut ahead = shifts.clone();
        let mut held: Vec<Option<f64>> = vec![None; shifts.len()];
        let mut found = None;
        for _ in 0..6 {
            let pull = Pull::ahead(problem, precision, shifts, &ahead);
            let mut drive = self.drive.clone();
            let mut curvature = pull.curvature.clone();
            for (place, slope) in pull.slope.iter().enumerate() {
                drive[state + place] -= slope;
                if let Some(limit) = held[place] {
                    let hold = 1e6 * curvature[place];
                    drive[state + place] += hold * (limit - shifts[place]);
                    curvature[place] += hold;
                }
            }
            let weights: Vec<f64> = precision[..state].iter().chain(&curvature).chain(&self.weights).copied().collect();
            let chosen: Vec<usize> = (0..weights.len()).collect();
            let damped: Vec<f64> =
                weights.iter().zip(&natural).map(|(weight, natural)| weight + damping * natural).collect();
            let Some(solution) = solve(&self.gram, &drive, &chosen, &damped) else { break };
            let step = &solution.coefficients;
            let next: Vec<f64> = shifts.iter().enumerate().map(|(place, shift)| shift + step[state + place]).collect();
            let mut same = next
                .iter()
                .zip(&ahead)
                .zip(&problem.nuisances)
                .all(|((next, ahead), nuisance)| nuisance.is_beyond(*ahead) || !nuisance.is_beyond(*next));
            for (place, next) in next.iter().enumerate() {
                if held[place].is_none() && next.abs() > limits[place] {
                    held[place] = Some(limits[place].copysign(*next));
                    same = false;
                }
            }
            let own: f64 = step.iter().zip(&weights).map(|(step, weight)| step * step * weight).sum();
            let promised = 2.0 * step.dot(&drive) - step.dot(&(&self.gram * step)) - own;
            found = Some(Step { solution, promised });
            // a wall that was met stays for this step
            for ((ahead, next), nuisance) in ahead.iter_mut().zip(next).zip(&problem.nuisances) {
                if !nuisance.is_beyond(*ahead) {
                    *ahead = next;
                }
            }
            if same {
                break;
            }
        }
        found
    }
}
