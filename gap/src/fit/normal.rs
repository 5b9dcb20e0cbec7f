//! Normal equations, and the Bayesian linear fits made from them.
//!
//! ```text
//! evidence = b' (G + P)^-1 b / 2 - log |G + P| / 2 + log |P| / 2        P the precision of the priors
//! ```

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

/// A linear fit.
#[derive(Debug, Clone)]
pub struct Solution {
    /// One for each column asked for.
    pub coefficients: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// What the square of the residual falls by, priors included.
    pub gain: f64,
    /// Logarithm of the evidence, up to what all fits share.
    pub evidence: f64,
}

/// Rows of a piece that stays in the cache.
const PIECE: usize = 1024;

/// Products of columns with others, over some rows: `a' b`.
pub(crate) fn products(a: &[&[f64]], b: &[&[f64]], rows: Range<usize>) -> DMatrix<f64> {
    let pieces: Vec<usize> = rows.clone().step_by(PIECE).collect();
    let zero = || DMatrix::zeros(a.len(), b.len());
    let of = |mut sum: DMatrix<f64>, &start: &usize| {
        let end = (start + PIECE).min(rows.end);
        let wide = DMatrix::from_row_iterator(a.len(), end - start, samples(a, start..end));
        let tall = DMatrix::from_iterator(end - start, b.len(), samples(b, start..end));
        sum.gemm(1.0, &wide, &tall, 1.0);
        sum
    };
    // in an order of its own whatever the number of threads
    let parts: Vec<DMatrix<f64>> = pieces.par_chunks(16).map(|pieces| pieces.iter().fold(zero(), of)).collect();
    parts.into_iter().fold(zero(), |sum, part| sum + part)
}

/// Products of columns with one series.
pub(crate) fn drive(columns: &[&[f64]], series: &[f64]) -> DVector<f64> {
    products(columns, &[series], 0..series.len()).column(0).into_owned()
}

fn samples(columns: &[&[f64]], rows: Range<usize>) -> impl Iterator<Item = f64> {
    columns.iter().flat_map(move |column| column[rows.clone()].iter().copied())
}

/// Slices of columns.
pub(crate) fn slices(columns: &[Vec<f64>]) -> Vec<&[f64]> {
    columns.iter().map(Vec::as_slice).collect()
}

/// Fits chosen columns of normal equations.
pub(crate) fn solve(
    gram: &DMatrix<f64>,
    drive: &DVector<f64>,
    chosen: &[usize],
    precision: &[f64],
) -> Option<Solution> {
    let n = chosen.len();
    // scaled to a unit diagonal, which keeps columns of all units apart from rounding
    let scale: Vec<f64> = (0..n).map(|i| (gram[(chosen[i], chosen[i])] + precision[i]).max(1e-30).sqrt()).collect();
    let matrix = DMatrix::from_fn(n, n, |i, j| {
        let own = if i == j { precision[i] } else { 0.0 };
        (gram[(chosen[i], chosen[j])] + own) / (scale[i] * scale[j]) + if i == j { 1e-10 } else { 0.0 }
    });
    let right = DVector::from_fn(n, |i, _| drive[chosen[i]] / scale[i]);
    let factor = Cholesky::new(matrix)?;
    let scaled = factor.solve(&right);
    let inverse = factor.inverse();
    let log_determinant: f64 = 2.0 * factor.l().diagonal().iter().map(|value| value.ln()).sum::<f64>()
        + 2.0 * scale.iter().map(|value| value.ln()).sum::<f64>();
    let log_prior: f64 = precision.iter().map(|value| value.ln()).sum();
    let gain = right.dot(&scaled);
    Some(Solution {
        coefficients: DVector::from_fn(n, |i, _| scaled[i] / scale[i]),
        covariance: DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] / (scale[i] * scale[j])),
        gain,
        evidence: 0.5 * (gain - log_determinant + log_prior),
    })
}
