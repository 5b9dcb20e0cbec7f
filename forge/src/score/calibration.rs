//! Probabilities against outcomes.
//!
//! ```text
//! bins of equal count over the sorted probabilities
//! error^2 = sum_b n_b/n * max(0, (mean p - mean y)^2 - v_b/n_b)      v_b: variance of (p - y) within the bin
//! ```
//!
//! Without the second term the error of perfect probabilities would not be 0 but grow with the number of bins.

use serde::Serialize;

use crate::draw::Draw;

/// One bin of the reliability picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bin {
    /// Mean probability.
    pub probability: f64,
    /// Share that was right.
    pub share: f64,
    /// Number of cases.
    pub count: usize,
}

/// Calibration of a list of probabilities.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Calibration {
    /// Expected calibration error, debiased.
    pub error: f64,
    /// 95 % interval by resampling.
    pub interval: (f64, f64),
    /// Bins of equal count.
    pub bins: Vec<Bin>,
    /// Number of probabilities.
    pub count: usize,
}

const BINS: usize = 15;
const RESAMPLES: usize = 400;

fn bins(pairs: &[(f64, bool)]) -> Vec<Bin> {
    let count = pairs.len();
    let bins = BINS.min(count / 10).max(1);
    (0..bins)
        .map(|bin| &pairs[bin * count / bins..(bin + 1) * count / bins])
        .filter(|piece| !piece.is_empty())
        .map(|piece| Bin {
            probability: piece.iter().map(|(p, _)| p).sum::<f64>() / piece.len() as f64,
            share: piece.iter().filter(|(_, right)| *right).count() as f64 / piece.len() as f64,
            count: piece.len(),
        })
        .collect()
}

/// Debiased error of pairs of a probability and whether it came true; pairs sorted by probability.
pub(super) fn error(pairs: &[(f64, bool)]) -> f64 {
    let total = pairs.len().max(1) as f64;
    let mut start = 0;
    let mut square = 0.0;
    for bin in bins(pairs) {
        let piece = &pairs[start..start + bin.count];
        start += bin.count;
        let count = bin.count as f64;
        let gap = bin.probability - bin.share;
        let scatter: f64 = piece
            .iter()
            .map(|(p, right)| {
                let off = p - f64::from(u8::from(*right)) - gap;
                off * off
            })
            .sum::<f64>()
            / (count - 1.0).max(1.0);
        square += count / total * (gap * gap - scatter / count);
    }
    square.max(0.0).sqrt()
}

/// Calibration of pairs of a probability and whether it came true.
#[must_use]
pub fn calibration(mut pairs: Vec<(f64, bool)>) -> Calibration {
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut draw = Draw::new(&Draw::seed_of(1), 0);
    let mut errors: Vec<f64> = (0..if pairs.is_empty() { 0 } else { RESAMPLES })
        .map(|_| {
            let mut again: Vec<(f64, bool)> = (0..pairs.len()).map(|_| pairs[draw.below(pairs.len())]).collect();
            again.sort_by(|a, b| a.0.total_cmp(&b.0));
            error(&again)
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    let at = |share: usize| errors.get((errors.len() * share / 1000).min(errors.len().saturating_sub(1))).copied();
    Calibration {
        error: error(&pairs),
        interval: (at(25).unwrap_or(0.0), at(975).unwrap_or(1.0)),
        bins: if pairs.is_empty() { Vec::new() } else { bins(&pairs) },
        count: pairs.len(),
    }
}
