//! Several logs fitted at once, each as a parabola about a point: parameters that the logs share are one unknown, those
//! that are a log's own, and its beginning, are that log's.
//!
//! ```text
//! cost  = sum over l of |r_l - B_l (x_l - a_l)|^2 / t_l + priors        a prior counts once for what is shared
//! H     = sum (D_l - C_l' A_l^-1 C_l) + P        A: own with own, C: own with shared, D: shared with shared
//! evidence = -cost / 2 - log |H| / 2 - sum log |A_l| / 2 + log |priors| / 2
//! ```
//!
//! Exact where predictions are linear in x; [`super::climb`] takes parabolas anew until nothing moves.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::parameters::Parameter;
use crate::fit::of_any_scale;

/// Added to a diagonal of 1, as in the equations of one log.
const REGULAR: f64 = 1e-10;
/// How often the walls may be met anew.
const WALLS: usize = 8;

/// The square of a log's residual as a parabola in its coordinates: beginning, then parameters.
#[derive(Debug, Clone)]
pub(super) struct Local {
    /// Where it was taken.
    pub(super) at: DVector<f64>,
    /// Precisions of the beginning's priors.
    pub(super) begin: Vec<f64>,
    pub(super) gram: DMatrix<f64>,
    /// `B' r + G a`.
    right: DVector<f64>,
    constant: f64,
    /// What the square is divided by.
    pub(super) temper: f64,
}

impl Local {
    /// From the square at a point, its sensitivities' products with each other and with the residual.
    pub(super) fn new(
        at: DVector<f64>,
        begin: Vec<f64>,
        gram: DMatrix<f64>,
        drive: &DVector<f64>,
        square: f64,
        temper: f64,
    ) -> Self {
        let there = &gram * &at;
        let constant = square + 2.0 * drive.dot(&at) + at.dot(&there);
        Self { right: drive + there, at, begin, gram, constant, temper }
    }

    /// What of a point the square over its temper is.
    fn square(&self, x: &DVector<f64>) -> f64 {
        (self.constant + x.dot(&(&self.gram * x)) - 2.0 * x.dot(&self.right)) / self.temper
    }

    /// Some of its parameters alone, all others where they were taken.
    pub(super) fn of(&self, parameters: &[usize]) -> Self {
        let begin = self.begin.len();
        let chosen: Vec<usize> = (0..begin).chain(parameters.iter().map(|place| begin + place)).collect();
        let pick = |from: &DVector<f64>| DVector::from_fn(chosen.len(), |place, _| from[chosen[place]]);
        let gram = DMatrix::from_fn(chosen.len(), chosen.len(), |i, j| self.gram[(chosen[i], chosen[j])]);
        let drive = pick(&(&self.right - &self.gram * &self.at));
        Self::new(pick(&self.at), self.begin.clone(), gram, &drive, self.square(&self.at) * self.temper, self.temper)
    }
}

/// The least of the cost.
#[derive(Debug, Clone)]
pub(super) struct Joint {
    /// Beginning and parameters of each log.
    pub(super) x: Vec<DVector<f64>>,
    pub(super) cost: f64,
    /// What the evidence has beside the cost [nats].
    pub(super) volume: f64,
    /// Place of each parameter among those that are shared; none is each log's own.
    shared: Vec<Option<usize>>,
    covariance: DMatrix<f64>,
    logs: Vec<Inner>,
}

/// What is a log's own, given what is shared.
#[derive(Debug, Clone)]
struct Inner {
    begin: usize,
    /// Parameters, behind the beginning.
    own: Vec<usize>,
    covariance: DMatrix<f64>,
    /// `A^-1 C`: how it leans on what is shared.
    leans: DMatrix<f64>,
}

impl Joint {
    /// Variance of a parameter in a log.
    pub(super) fn variance(&self, log: usize, parameter: usize) -> f64 {
        match self.shared[parameter] {
            Some(place) => self.covariance[(place, place)],
            None => self.covariance_of(parameter, log, log),
        }
    }

    /// Covariance of what is two logs' own.
    pub(super) fn covariance_of(&self, parameter: usize, a: usize, b: usize) -> f64 {
        let row = |log: usize| {
            let own = self.logs[log].own.iter().position(|own| *own == parameter);
            own.map_or(0, |place| self.logs[log].begin + place)
        };
        let (i, j) = (row(a), row(b));
        let through = (self.logs[a].leans.row(i) * &self.covariance * self.logs[b].leans.row(j).transpose())[(0, 0)];
        through + if a == b { self.logs[a].covariance[(i, i)] } else { 0.0 }
    }
}

/// What parameters and beginnings cost at a point of each log.
pub(super) fn prior_cost(x: &[DVector<f64>], begins: &[&[f64]], parameters: &[Parameter], own: &[bool]) -> f64 {
    let mut cost = 0.0;
    for (log, (x, begin)) in x.iter().zip(begins).enumerate() {
        cost += begin.iter().zip(x.iter()).map(|(precision, x)| precision * x * x).sum::<f64>();
        let counts = |place: usize| own[place] || log == 0;
        let values = parameters.iter().zip(x.iter().skip(begin.len())).enumerate();
        cost += values.filter(|(place, _)| counts(*place)).map(|(_, (own, x))| own.prior.cost(*x)).sum::<f64>();
    }
    cost
}

/// Solves for the least cost; which walls it ends behind decides which parabola the priors are.
pub(super) fn solve(locals: &[Local], parameters: &[Parameter], own: &[bool]) -> Option<Joint> {
    let mut ahead: Vec<DVector<f64>> = locals.iter().map(|local| local.at.clone()).collect();
    let mut found = None;
    for _ in 0..WALLS {
        let joint = once(locals, parameters, own, &ahead)?;
        let mut same = true;
        for ((ahead, x), local) in ahead.iter_mut().zip(&joint.x).zip(locals) {
            for (place, parameter) in parameters.iter().enumerate() {
                let place = local.begin.len() + place;
                let [before, after] = [ahead[place], x[place]].map(|value| parameter.prior.is_beyond(value));
                if before != after {
                    same = false;
                    ahead[place] = x[place];
                }
            }
        }
        found = Some(joint);
        if same {
            break;
        }
    }
    found
}

/// A factor of a matrix scaled to a unit diagonal, its inverse, and the logarithm of its determinant.
fn factor(mut matrix: DMatrix<f64>) -> Option<(DMatrix<f64>, f64)> {
    let n = matrix.nrows();
    let scale: Vec<f64> = (0..n).map(|place| matrix[(place, place)].max(1e-30).sqrt()).collect();
    for i in 0..n {
        for j in 0..n {
            matrix[(i, j)] /= scale[i] * scale[j];
        }
        matrix[(i, i)] += REGULAR;
    }
    let factor: Cholesky<f64, Dyn> = Cholesky::new(matrix)?;
    let log_determinant: f64 = 2.0 * factor.l().diagonal().iter().map(|value| value.ln()).sum::<f64>()
        + 2.0 * scale.iter().map(|value| value.ln()).sum::<f64>();
    let mut inverse = factor.inverse();
    for i in 0..n {
        for j in 0..n {
            inverse[(i, j)] /= scale[i] * scale[j];
        }
    }
    Some((inverse, log_determinant))
}

/// The least cost behind given walls.
fn once(locals: &[Local], parameters: &[Parameter], own: &[bool], ahead: &[DVector<f64>]) -> Option<Joint> {
    let common: Vec<usize> = (0..parameters.len()).filter(|place| !own[*place]).collect();
    let apart: Vec<usize> = (0..parameters.len()).filter(|place| own[*place]).collect();
    let mut matrix = DMatrix::zeros(common.len(), common.len());
    let mut right = DVector::zeros(common.len());
    let mut volume = 0.0;
    for (row, &place) in common.iter().enumerate() {
        let prior = &parameters[place].prior;
        let (curvature, pull) = prior.parabola(ahead[0][locals[0].begin.len() + place]);
        matrix[(row, row)] += curvature;
        right[row] += pull;
        volume += 0.5 * prior.flat().ln();
    }
    let mut inner = Vec::new();
    let mut constants = Vec::new();
    for (local, ahead) in locals.iter().zip(ahead) {
        let begin = local.begin.len();
        let inside: Vec<usize> = (0..begin).chain(apart.iter().map(|place| begin + place)).collect();
        let outside: Vec<usize> = common.iter().map(|place| begin + place).collect();
        let block = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| local.gram[(rows[i], columns[j])] / local.temper)
        };
        let mut a = block(&inside, &inside);
        let mut h = DVector::from_fn(inside.len(), |i, _| local.right[inside[i]] / local.temper);
        for (place, precision) in local.begin.iter().enumerate() {
            a[(place, place)] += precision;
            volume += 0.5 * precision.ln();
        }
        for (row, &place) in apart.iter().enumerate() {
            let prior = &parameters[place].prior;
            let (curvature, pull) = prior.parabola(ahead[begin + place]);
            a[(begin + row, begin + row)] += curvature;
            h[begin + row] += pull;
            volume += 0.5 * prior.flat().ln();
        }
        let c = block(&inside, &outside);
        let (covariance, log_determinant) = factor(a)?;
        volume -= 0.5 * log_determinant;
        let leans = &covariance * &c;
        matrix += block(&outside, &outside) - c.transpose() * &leans;
        right +=
            DVector::from_fn(outside.len(), |i, _| local.right[outside[i]] / local.temper) - leans.transpose() * &h;
        constants.push(&covariance * h);
        inner.push(Inner { begin, own: apart.clone(), covariance, leans });
    }
    let (covariance, log_determinant) = factor(matrix)?;
    volume -= 0.5 * log_determinant;
    let together = &covariance * right;
    let mut shared = vec![None; parameters.len()];
    for (row, &place) in common.iter().enumerate() {
        shared[place] = Some(row);
    }
    let x: Vec<DVector<f64>> = inner
        .iter()
        .zip(&constants)
        .map(|(inner, constant)| {
            let inside = constant - &inner.leans * &together;
            let mut x = DVector::zeros(inner.begin + parameters.len());
            for place in 0..inner.begin {
                x[place] = inside[place];
            }
            for (row, &place) in common.iter().enumerate() {
                x[inner.begin + place] = together[row];
            }
            for (row, &place) in apart.iter().enumerate() {
                x[inner.begin + place] = inside[inner.begin + row];
            }
            x
        })
        .collect();
    let begins: Vec<&[f64]> = locals.iter().map(|local| local.begin.as_slice()).collect();
    let squares: f64 = locals.iter().zip(&x).map(|(local, x)| local.square(x)).sum();
    let cost = squares + prior_cost(&x, &begins, parameters, own);
    let mut joint = Joint { x, cost, volume, shared, covariance, logs: inner };
    joint.volume += scale_free(&joint, parameters, own);
    Some(joint)
}

/// What sizes of no scale of their own are given back [nats].
fn scale_free(joint: &Joint, parameters: &[Parameter], own: &[bool]) -> f64 {
    let mut sum = 0.0;
    for (place, parameter) in parameters.iter().enumerate() {
        let Some(sigma) = parameter.any_scale else { continue };
        let logs = if own[place] { joint.x.len() } else { 1 };
        sum += (0..logs).map(|log| of_any_scale(sigma, joint.variance(log, place).sqrt())).sum::<f64>();
    }
    sum
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::{Local, solve};
    use crate::pool::parameters::{Parameter, Prior, Unit};

    fn wide() -> Parameter {
        Parameter { prior: Prior::Around { center: 0.0, precision: 1e-6 }, any_scale: None, unit: Unit::Effect(0) }
    }

    fn log(value: f64, error: f64) -> Local {
        let weight = error.powi(-2);
        let at = DVector::from_vec(vec![0.0, value]);
        let gram = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, weight]);
        Local::new(at, vec![1.0], gram, &DVector::zeros(2), 10.0, 1.0)
    }

    #[test]
    fn closed_form_a_shared_value_is_the_weighted_mean() {
        let logs = [log(1.0, 0.1), log(2.0, 0.2), log(1.5, 0.1)];
        let weights = [100.0, 25.0, 100.0];
        let mean = (100.0 + 50.0 + 150.0) / 225.0;
        let shared = solve(&logs, &[wide()], &[false]).expect("regular");
        assert!((shared.x[0][1] - mean).abs() < 1e-6 && (shared.variance(0, 0) * 225.0 - 1.0).abs() < 1e-6);
        let chi2: f64 = [1.0_f64, 2.0, 1.5].iter().zip(weights).map(|(v, w)| w * (v - mean).powi(2)).sum();
        let own = solve(&logs, &[wide()], &[true]).expect("regular");
        assert!((own.x[1][1] - 2.0).abs() < 1e-4 && (own.variance(1, 0) - 0.04).abs() < 1e-5);
        assert!((shared.cost - own.cost - chi2).abs() < 1e-3, "{} {} {chi2}", shared.cost, own.cost);
        // the volumes differ by the widths that the priors are shrunk to
        let volume = 0.5 * (1e-6_f64.ln() * 2.0 - (100.0_f64 * 25.0 * 100.0 / 225.0).ln());
        assert!((own.volume - shared.volume - volume).abs() < 1e-4);
    }
}
