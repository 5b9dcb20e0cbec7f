//! Normal equations by time block, and the Bayesian linear fits made from them.
//!
//! ```text
//! evidence = b' (G + P)^-1 b / 2 - log |G + P| / 2 + log |P| / 2        P the precision of the priors
//! ```

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

/// Gram matrix of the columns and their products with the residual, by block.
#[derive(Debug, Clone)]
pub struct Normal {
    /// Gram matrix over all blocks.
    pub gram: DMatrix<f64>,
    /// Products with the residual.
    pub drive: DVector<f64>,
    /// Square of the residual.
    pub square: f64,
    /// The same three block by block.
    pub blocks: Vec<(DMatrix<f64>, DVector<f64>, f64)>,
}

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

impl Normal {
    /// From whitened columns and a whitened residual.
    #[must_use]
    pub fn new(columns: &[Vec<f64>], residual: &[f64], blocks: usize) -> Self {
        let rows = residual.len();
        let parts: Vec<_> = (0..blocks)
            .into_par_iter()
            .map(|block| {
                let (from, to) = (block * rows / blocks, (block + 1) * rows / blocks);
                // in pieces that stay in the cache
                let count = columns.len() + 1;
                let mut product = DMatrix::zeros(count, count);
                let mut start = from;
                while start < to {
                    let end = (start + 2048).min(to);
                    let tall = DMatrix::from_fn(end - start, count, |row, column| {
                        if column == 0 { residual[start + row] } else { columns[column - 1][start + row] }
                    });
                    product.gemm(1.0, &tall.transpose(), &tall, 1.0);
                    start = end;
                }
                let gram = product.view((1, 1), (count - 1, count - 1)).into_owned();
                let drive = DVector::from_fn(count - 1, |row, _| product[(row + 1, 0)]);
                (gram, drive, product[(0, 0)])
            })
            .collect();
        let mut normal = Self {
            gram: DMatrix::zeros(columns.len(), columns.len()),
            drive: DVector::zeros(columns.len()),
            square: 0.0,
            blocks: parts,
        };
        for (gram, drive, square) in &normal.blocks {
            normal.gram += gram;
            normal.drive += drive;
            normal.square += square;
        }
        normal
    }

    /// Fits the columns chosen, each with the precision of its prior (mean zero).
    #[must_use]
    pub fn solve(&self, chosen: &[usize], precision: &[f64]) -> Option<Solution> {
        solve(&self.gram, &self.drive, chosen, precision)
    }

    /// The same on all blocks but those in `out`.
    #[must_use]
    pub fn solve_without(&self, out: &[usize], chosen: &[usize], precision: &[f64]) -> Option<Solution> {
        let (mut gram, mut drive) = (self.gram.clone(), self.drive.clone());
        for &block in out {
            gram -= &self.blocks[block].0;
            drive -= &self.blocks[block].1;
        }
        solve(&gram, &drive, chosen, precision)
    }

    /// Square of the residual in some blocks with coefficients applied.
    #[must_use]
    pub fn square_in(&self, blocks: &[usize], chosen: &[usize], coefficients: &DVector<f64>) -> f64 {
        blocks
            .iter()
            .map(|&block| {
                let (gram, drive, square) = &self.blocks[block];
                let mut value = *square;
                for (i, &a) in chosen.iter().enumerate() {
                    value -= 2.0 * coefficients[i] * drive[a];
                    for (j, &b) in chosen.iter().enumerate() {
                        value += coefficients[i] * coefficients[j] * gram[(a, b)];
                    }
                }
                value
            })
            .sum()
    }
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
