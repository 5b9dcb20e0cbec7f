//! What one column more takes of a balance, beside base columns and a constant.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// A balance and its base columns.
pub(super) struct Beside {
    target: Vec<f64>,
    base: Vec<Vec<f64>>,
    gram: Cholesky<f64, Dyn>,
    of_target: DVector<f64>,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn along(base: &[Vec<f64>], values: &[f64]) -> DVector<f64> {
    DVector::from_iterator(base.len(), base.iter().map(|own| dot(own, values)))
}

impl Beside {
    /// Of base columns that do not hang on each other; else nothing.
    pub(super) fn new(target: Vec<f64>, base: &[Vec<f64>]) -> Option<Self> {
        let mut base = base.to_vec();
        base.push(vec![1.0; target.len()]);
        let gram = DMatrix::from_fn(base.len(), base.len(), |i, j| dot(&base[i], &base[j])).cholesky()?;
        let of_target = gram.solve(&along(&base, &target));
        Some(Self { target, base, gram, of_target })
    }

    /// What a column takes of the balance's square where its amplitude is above zero.
    pub(super) fn gain(&self, column: &[f64]) -> f64 {
        let shared = along(&self.base, column);
        let kept = dot(column, column) - shared.dot(&self.gram.solve(&shared));
        let speaks = dot(column, &self.target) - shared.dot(&self.of_target);
        speaks.max(0.0).powi(2) / kept.max(1e-300)
    }
}

/// Those of what was tried that take most, no two of which have a number nearly the same: each with what it takes.
pub(super) fn apart<T>(mut all: Vec<(f64, T)>, most: usize, ratio: f64, number: impl Fn(&T) -> f64) -> Vec<T> {
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut offered: Vec<T> = Vec::new();
    for (gain, one) in all {
        let own = number(&one);
        let new = offered.iter().map(&number).all(|other| (own / other).max(other / own) > ratio);
        if gain > 0.0 && new && offered.len() < most {
            offered.push(one);
        }
    }
    offered
}
