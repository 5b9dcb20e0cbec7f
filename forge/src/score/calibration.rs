//! Probabilities against outcomes.
//!
//! ```text
//! bins of equal count over the sorted probabilities; equal ones stay together
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
    let mut start = 0;
    (0..bins)
        .filter_map(|bin| {
            let mut end = ((bin + 1) * count / bins).max(start);
            // equal probabilities stay together: their order means nothing
            while 0 < end && end < count && pairs[end].0.to_bits() == pairs[end - 1].0.to_bits() {
                end += 1;
            }
            let piece = &pairs[start..end];
            start = end;
            (!piece.is_empty()).then_some(piece)
        })
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

/// Debiased error of triples with a weight each, in bins of equal weight.
pub(super) fn weighted_error(mut triples: Vec<(f64, bool, f64)>) -> f64 {
    triples.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = triples.iter().map(|triple| triple.2).sum();
    let bins = BINS.min(triples.len() / 10).max(1);
    let (mut square, mut passed, mut start) = (0.0, 0.0, 0);
    for bin in 0..bins {
        let mut end = start;
        let tied = |end: usize| end > 0 && triples[end].0.to_bits() == triples[end - 1].0.to_bits();
        while end < triples.len() && (passed < total * (bin + 1) as f64 / bins as f64 || bin + 1 == bins || tied(end)) {
            passed += triples[end].2;
            end += 1;
        }
        let piece = &triples[start..end];
        start = end;
        let mass: f64 = piece.iter().map(|triple| triple.2).sum();
        if piece.len() < 2 || mass <= 0.0 {
            continue;
        }
        let off = |triple: &(f64, bool, f64)| triple.0 - f64::from(u8::from(triple.1));
        let gap = piece.iter().map(|triple| triple.2 * off(triple)).sum::<f64>() / mass;
        let count = piece.len() as f64;
        // variance of the weighted mean
        let scatter: f64 =
            piece.iter().map(|t| (t.2 / mass * (off(t) - gap)).powi(2)).sum::<f64>() * count / (count - 1.0);
        square += mass / total * (gap * gap - scatter);
    }
    square.max(0.0).sqrt()
}

/// Calibration of pairs of a probability and whether it came true.
#[must_use]
pub fn calibration(mut pairs: Vec<(f64, bool)>) -> Calibration {
    let mut draw = Draw::new(&Draw::seed_of(1), 0);
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
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
