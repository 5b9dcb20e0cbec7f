//! Normal equations, and the Bayesian linear fits made from them.
//!
//! ```text
//! evidence = b' (G + P)^-1 b / 2 - log |G + P| / 2 + log |P| / 2        P the precision of the priors
//! ```

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use super::vectors::{Sample, four_by_two};

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

/// Rows of a piece that stays in the cache, and pieces that are summed by one task.
const PIECE: usize = 512;
const PIECES: usize = 16;

/// Products of columns with others, over some rows: `a' b`.
pub(crate) fn products<T: Sample, U: Sample>(a: &[&[T]], b: &[&[U]], rows: Range<usize>) -> DMatrix<f64> {
    summed(a.len(), b.len(), rows, |sum, piece| {
        let (a, b) = (pieces(a, &piece), pieces(b, &piece));
        add_products(sum, &a, &b, |_| 0);
    })
}

/// Products of columns with each other.
pub(crate) fn gram<T: Sample>(columns: &[&[T]], rows: Range<usize>) -> DMatrix<f64> {
    let n = columns.len();
    let mut gram = summed(n, n, rows, |sum, piece| {
        let columns = pieces(columns, &piece);
        add_products(sum, &columns, &columns, |from| from);
    });
    gram.fill_upper_triangle_with_lower_triangle();
    gram
}

fn pieces<'a, T>(columns: &[&'a [T]], piece: &Range<usize>) -> Vec<&'a [T]> {
    columns.iter().map(|column| &column[piece.clone()]).collect()
}

/// The sum over pieces of rows, in an order of its own whatever the number of threads.
fn summed(
    n: usize,
    m: usize,
    rows: Range<usize>,
    add: impl Fn(&mut DMatrix<f64>, Range<usize>) + Sync,
) -> DMatrix<f64> {
    let starts: Vec<usize> = rows.clone().step_by(PIECE).collect();
    let part = |starts: &[usize]| {
        let mut sum = DMatrix::zeros(n, m);
        for &start in starts {
            add(&mut sum, start..(start + PIECE).min(rows.end));
        }
        sum
    };
    let parts: Vec<DMatrix<f64>> = starts.par_chunks(PIECES).map(part).collect();
    parts.into_iter().fold(DMatrix::zeros(n, m), |sum, part| sum + part)
}

/// Four columns with two at a time, for the columns of b from the first on that has a row from `first_row` on.
fn add_products<T: Sample, U: Sample>(
    sum: &mut DMatrix<f64>,
    a: &[&[T]],
    b: &[&[U]],
    first_row: impl Fn(usize) -> usize,
) {
    for (pair, b) in b.chunks(2).enumerate() {
        let column = 2 * pair;
        let first = first_row(column) / 4 * 4;
        for (four, a) in a.chunks(4).enumerate().skip(first / 4) {
            // the last again where some are missing
            let products = four_by_two([0, 1, 2, 3].map(|i| a[i.min(a.len() - 1)]), [b[0], b[b.len() - 1]]);
            for (i, products) in products.iter().enumerate().take(a.len()) {
                for (j, product) in products.iter().enumerate().take(b.len()) {
                    sum[(4 * four + i, column + j)] += product;
                }
            }
        }
    }
}

/// Products of columns with one series.
pub(crate) fn drive<T: Sample>(columns: &[&[T]], series: &[f64]) -> DVector<f64> {
    products(columns, &[series], 0..series.len()).column(0).into_owned()
}

/// Slices of columns.
pub(crate) fn slices<T>(columns: &[Vec<T>]) -> Vec<&[T]> {
    columns.iter().map(Vec::as_slice).collect()
}

/// In single precision, as columns are kept.
#[allow(clippy::cast_possible_truncation, reason = "single precision is meant")]
pub(crate) fn narrow(values: &[f64]) -> Vec<f32> {
    values.iter().map(|value| *value as f32).collect()
}

/// Standard errors over which a size may be anything.
const ANY: f64 = 8.0;

/// What a size's prior takes from the evidence beyond `ln 8`: a size has no scale of its own, so that effects whose
/// realistic range is wide are not held to be less likely [nats].
pub(crate) fn of_any_scale(sigma: f64, error: f64) -> f64 {
    (sigma / (ANY * error)).max(1.0).ln()
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
