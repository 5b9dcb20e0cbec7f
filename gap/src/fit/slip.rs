//! Noise of the logged rate where friction turns around: there it is torque, and no filter of frequencies whitens it.
//!
//! A block of rows in which the bearing turns around, its mean rate off by e of standard deviation s, adds `a e / s` to
//! the whitened channels. Their covariance is then
//!
//! ```text
//! C = I + sum a a^T          x <- x - k a' (a' . x)          k = (1 - 1 / sqrt(1 + |a'|^2)) / |a'|^2
//! ```
//!
//! one block after the other, a' = a after the blocks before it: what comes out is white (Potter's square root).
//! Blocks are short against the loop and long against the filter of the rate, whose error they take for constant. Where
//! the bearing turns around slowly they are of 16 rows, and their mean alone is whitened here: it is what many rows
//! together, a float's torque, would be taken for. What the error does inside of them is left to the filter.
//!
//! What the logged rate does from row to row says how large s may be: some of that is motion. A residual r says how
//! large it is: `-2 ln L = |x|^2 + sum ln(1 + |a'|^2)`, x what comes out of r. Of the sizes that are as likely as the
//! likeliest one, the largest is taken. What the rate does between rows, beside the line, may be as large: it is added
//! where it makes the residual likelier.

use super::blocks::{Turned, bent};
use super::normal::narrow;
use super::release::Released;
use super::signals::Signals;
use super::vectors::take_along;
use crate::record::Record;

/// Share of its square that a block's ends are cut at.
const NOTHING: f64 = 1e-7;
/// The same, over the variance of the noise.
const NOTHING_AT_ALL: f64 = 1e-4;
/// A block that adds less than this to the variance of the noise is none.
const LEAST: f64 = 1e-3;
/// Sizes of the noise that are tried: each is this share of the one before.
const SMALLER: f64 = 0.6;
const SIZES: usize = 12;
/// Twice the logarithm by which likelihoods differ that are alike.
const ALIKE: f64 = 10.0;

/// What whitens the blocks.
#[derive(Debug, Clone, Default)]
pub(crate) struct Slips {
    pulses: Vec<Pulse>,
    /// What stops leave behind, which is among the pulses.
    released: Released,
}

#[derive(Debug, Clone)]
struct Pulse {
    /// First sample, of all channels row after row.
    first: usize,
    /// a'.
    values: Vec<f32>,
    /// k.
    share: f64,
    /// |a'|^2.
    square: f64,
}

impl Slips {
    /// Whitens samples of all channels, row after row.
    pub(crate) fn apply(&self, whitened: &mut [f64]) {
        self.pulses.iter().for_each(|pulse| pulse.apply(0, whitened));
    }

    /// From the blocks as each shows after the filter of frequencies, of the size that a residual speaks for.
    pub(crate) fn new(
        turned: &Turned,
        record: &Record,
        residual: &Signals,
        filter: impl Fn(&Signals) -> Vec<f64> + Sync,
    ) -> Self {
        let none = Self { pulses: Vec::new(), released: turned.released().clone() };
        let released = none.released.shown(&filter);
        if turned.blocks.is_empty() {
            return none.with(&released, 1.0);
        }
        let residual = filter(residual);
        let shown = turned.shown(record.channels.len(), filter);
        let noise: Vec<f64> = turned.blocks.iter().map(|block| record.rate_noise.of_mean(block.len())).collect();
        let likeliest = |sigmas: &[f64]| none.clone().likeliest(&shown, sigmas, &released, &residual);
        let (unlikely, slips) = likeliest(&noise);
        let between = bent(record, &turned.blocks);
        if noise.iter().zip(&between).all(|(noise, between)| between < noise) {
            return slips;
        }
        let both: Vec<f64> = noise.iter().zip(&between).map(|(noise, between)| noise.hypot(*between)).collect();
        let (unlikely_bent, bent) = likeliest(&both);
        if unlikely_bent + ALIKE < unlikely { bent } else { slips }
    }

    /// Blocks whose rates are off by so much, of the size that a residual speaks for.
    fn likeliest(
        self,
        shown: &[(usize, Vec<f64>)],
        sigmas: &[f64],
        released: &[(usize, Vec<f64>)],
        residual: &[f64],
    ) -> (f64, Self) {
        let moved = shown.iter().zip(sigmas);
        let moved: Vec<(usize, Vec<f64>)> =
            moved.map(|((first, own), sigma)| (*first, own.iter().map(|value| sigma * value).collect())).collect();
        let mut tried: Vec<(f64, Self)> = Vec::new();
        let mut least = f64::MAX;
        for size in std::iter::successors(Some(1.0), |size| Some(SMALLER * size)).take(SIZES) {
            // the longer ones last: what is narrow stays so
            let slips = self.clone().with(&moved, size).with(released, 1.0);
            let unlikely = slips.unlikely(residual);
            least = least.min(unlikely);
            tried.push((unlikely, slips));
            if unlikely > least + 2.0 * ALIKE {
                break;
            }
        }
        let alike = tried.into_iter().find(|(unlikely, _)| *unlikely <= least + ALIKE);
        alike.unwrap_or_default()
    }

    /// `-2 ln L` of a residual, up to a constant.
    fn unlikely(&self, filtered: &[f64]) -> f64 {
        let mut whitened = filtered.to_vec();
        self.apply(&mut whitened);
        let square: f64 = whitened.iter().map(|value| value * value).sum();
        square + self.pulses.iter().map(|pulse| (1.0 + pulse.square).ln()).sum::<f64>()
    }

    /// What stops leave behind.
    pub(crate) fn released(&self) -> &Released {
        &self.released
    }

    /// More of them, so many times as large.
    fn with(mut self, shown: &[(usize, Vec<f64>)], size: f64) -> Self {
        for (first, values) in shown {
            let (first, mut values) = (*first, values.iter().map(|value| size * value).collect::<Vec<f64>>());
            // what the blocks before it leave
            for pulse in &self.pulses {
                pulse.apply(first, &mut values);
            }
            let square: f64 = values.iter().map(|value| value * value).sum();
            if square > LEAST {
                let share = (1.0 - 1.0 / (1.0 + square).sqrt()) / square;
                let (begins, values) = over_nothing(&values);
                self.pulses.push(Pulse { first: first + begins, values: narrow(&values), share, square });
            }
        }
        self
    }
}

/// Samples over the noise without the ends that are nothing, and where they begin.
pub(super) fn over_nothing(values: &[f64]) -> (usize, Vec<f64>) {
    let square: f64 = values.iter().map(|value| value * value).sum();
    let ends = over(values, (NOTHING * square).min(NOTHING_AT_ALL));
    (ends.start, values[ends].to_vec())
}

/// Without the ends whose squares come to no more than this.
fn over(values: &[f64], square: f64) -> std::ops::Range<usize> {
    let from = |values: &mut dyn Iterator<Item = &f64>| {
        let mut sum = 0.0;
        values
            .take_while(|value| {
                sum += *value * *value;
                sum <= square
            })
            .count()
    };
    let begins = from(&mut values.iter());
    begins..(values.len() - from(&mut values.iter().rev())).max(begins)
}

impl Pulse {
    /// To samples that begin at `first`.
    fn apply(&self, first: usize, samples: &mut [f64]) {
        let (from, to) = (self.first.max(first), (self.first + self.values.len()).min(first + samples.len()));
        if from >= to {
            return;
        }
        let own = &self.values[from - self.first..to - self.first];
        let samples = &mut samples[from - first..to - first];
        take_along(samples, own, self.share);
    }
}

#[cfg(test)]
mod tests {
    use super::over_nothing;

    #[test]
    fn ends_that_are_nothing_are_left_out_and_all_where_all_is() {
        assert_eq!(over_nothing(&[0.0, 1e-4, 2.0, 0.5, -1e-4, 0.0]), (2, vec![2.0, 0.5]));
        assert_eq!(over_nothing(&[0.0; 3]).1, Vec::<f64>::new());
        assert_eq!(over_nothing(&[]).1, Vec::<f64>::new());
    }
}
