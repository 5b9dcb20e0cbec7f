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

use rayon::prelude::*;

use super::draft::Draft;
use super::normal::narrow;
use super::release::Released;
use super::signals::{Kept, Signals, difference, scaled};
use super::turning::{SLOWLY, at_once, mostly};
use super::vectors::take_along;
use crate::record::{RateNoise, Record};
use crate::simulate::{Begin, Physics, Prediction, Variant, predict_each};

/// Most blocks.
const MOST: usize = 800;
/// Rows before and after the beginning of a block in which it shows.
const BEFORE: usize = 200;
const AFTER: usize = 1000;
/// Rate by which a block is moved, over the slip rate.
const STEP: f64 = 0.02;
/// Share of its square that a block's ends are cut at.
const NOTHING: f64 = 1e-7;
/// The same, over the variance of the noise.
const NOTHING_AT_ALL: f64 = 1e-4;
/// Predictions that are held at a time.
const TOGETHER: usize = 16;
/// A block that adds less than this to the variance of the noise is none.
const LEAST: f64 = 1e-3;
/// Sizes of the noise that are tried: each is this share of the one before.
const SMALLER: f64 = 0.6;
const SIZES: usize = 12;
/// Twice the logarithm by which likelihoods differ that are alike.
const ALIKE: f64 = 10.0;

/// Rows of a block.
type Block = std::ops::Range<usize>;

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

/// Blocks, and what a change of their rate by 1 rad/s does, over the noise, before any filter: those that are far from each other in
/// one.
pub(crate) struct Turned {
    blocks: Vec<Block>,
    moved: Vec<(Vec<usize>, Kept)>,
    /// What stops leave behind.
    released: Released,
}

/// What blocks are made from.
pub(crate) struct Turning<'a> {
    pub(crate) record: &'a Record,
    pub(crate) base: &'a Physics,
    pub(crate) begin: &'a Begin,
    pub(crate) nominal: &'a Prediction,
    /// Rows at which the bearing turns around.
    pub(crate) turns: &'a [bool],
    /// Over each channel's noise.
    pub(crate) scaled: &'a [f64],
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
        let none = Self { pulses: Vec::new(), released: turned.released.clone() };
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

/// How far the rate may be off the line between rows, in each block: an eighth of its second differences, less those of noise.
fn bent(record: &Record, blocks: &[Block]) -> Vec<f64> {
    let rate = &record.inputs.rate_radps;
    let of_noise = 6.0 * record.rate_noise.rms_radps.powi(2);
    let of = |block: &Block| {
        let rows = block.start.max(1)..(block.end + 1).min(rate.len() - 1);
        let squares = rows.clone().map(|k| (rate[k - 1] - 2.0 * rate[k] + rate[k + 1]).powi(2));
        0.125 * (squares.sum::<f64>() / rows.len().max(1) as f64 - of_noise).max(0.0).sqrt()
    };
    blocks.iter().map(of).collect()
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

impl Turning<'_> {
    fn blocks(&self) -> Vec<Block> {
        if self.record.rate_noise.rms_radps < 1e-9 || mostly(self.turns) {
            return Vec::new();
        }
        let least = if at_once(self.turns) { 1 } else { SLOWLY };
        let mut longest = self.record.rate_noise.rows_alike().max(least);
        loop {
            let blocks = divided(self.turns, longest);
            if blocks.len() <= MOST || longest > AFTER / 4 {
                return blocks;
            }
            longest *= 2;
        }
    }

    /// The blocks, and what a change of their rate does.
    pub(crate) fn turned(&self) -> Turned {
        let blocks = self.blocks();
        let step = STEP * self.base.config.bearing.slip_rate_radps;
        let inputs = &self.record.inputs;
        let mut moved = Vec::new();
        let groups = far_apart(&blocks);
        for some in groups.chunks(TOGETHER) {
            let of = |group: &Vec<usize>| {
                let mut rate_radps = inputs.rate_radps.clone();
                group.iter().flat_map(|&index| blocks[index].clone()).for_each(|k| rate_radps[k] += step);
                rate_radps
            };
            let rates: Vec<Vec<f64>> = some.iter().map(of).collect();
            let (physics, begin) = (self.base, self.begin);
            let variants: Vec<Variant> = rates
                .iter()
                .map(|rate_radps| Variant {
                    physics: physics.clone(),
                    begin: begin.clone(),
                    rate_radps: Some(rate_radps),
                    pushed: None,
                    rows: usize::MAX,
                })
                .collect();
            moved.extend(predict_each(&variants, inputs, |_, moved| {
                Kept::new(&scaled(difference(self.record, &moved, self.nominal, step), self.scaled))
            }));
        }
        let draft = Draft {
            record: self.record,
            base: self.base,
            begin: self.begin,
            nominal: self.nominal,
            over_noise: self.scaled,
        };
        Turned { blocks, moved: groups.into_iter().zip(moved).collect(), released: Released::new(&draft) }
    }
}

impl Turned {
    pub(crate) fn is_empty(&self) -> bool {
        self.blocks.is_empty() && self.released.is_empty()
    }

    /// What stops leave behind.
    pub(crate) fn released(&self) -> &Released {
        &self.released
    }

    /// Each block's samples after the filter, and where they begin.
    fn shown(&self, channels: usize, filter: impl Fn(&Signals) -> Vec<f64> + Sync) -> Vec<(usize, Vec<f64>)> {
        let pieces = |(group, moved): &(Vec<usize>, Kept)| {
            let whitened = filter(&moved.signals());
            let piece = |&index: &usize| {
                let block = &self.blocks[index];
                let first = channels * block.start.saturating_sub(BEFORE);
                let last = (channels * (block.end + AFTER)).min(whitened.len());
                (index, (first, whitened[first..last].to_vec()))
            };
            group.iter().map(piece).collect::<Vec<_>>()
        };
        let mut shown = vec![(0, Vec::new()); self.blocks.len()];
        let all: Vec<_> = self.moved.par_iter().flat_map_iter(pieces).collect();
        for (index, piece) in all {
            shown[index] = piece;
        }
        shown
    }
}

/// Blocks, by index, in groups whose members do not show in each other's samples.
fn far_apart(blocks: &[Block]) -> Vec<Vec<usize>> {
    let mut groups = Vec::new();
    let mut left: Vec<usize> = (0..blocks.len()).collect();
    while !left.is_empty() {
        let mut next_free = 0;
        let (now, later): (Vec<usize>, Vec<usize>) = left.into_iter().partition(|&index| {
            let free = blocks[index].start >= next_free;
            if free {
                next_free = blocks[index].end + BEFORE + AFTER;
            }
            free
        });
        groups.push(now);
        left = later;
    }
    groups
}

/// Runs of rows, in pieces of at most so many.
fn divided(rows: &[bool], longest: usize) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut start = None;
    for k in 0..=rows.len() {
        let turns = rows.get(k).copied().unwrap_or(false);
        match start {
            None if turns => start = Some(k),
            Some(first) if !turns || k - first == longest => {
                blocks.push(first..k);
                start = turns.then_some(k);
            }
            _ => {}
        }
    }
    blocks
}

impl RateNoise {
    /// Standard deviation of the mean of so many rows of the rate that drives the predictions [rad/s].
    ///
    /// ```text
    /// s^2 = rms^2 mean over f of W(f) (sin(pi f n) / (n sin(pi f)))^2
    /// ```
    pub(crate) fn of_mean(&self, rows: usize) -> f64 {
        let (lines, n) = (4 * rows.max(64), rows as f64);
        let of = |line: usize| {
            let share = (line as f64 + 0.5) / lines as f64;
            let angle = 0.5 * std::f64::consts::PI * share;
            self.pass(share) * ((n * angle).sin() / (n * angle.sin())).powi(2)
        };
        self.rms_radps * ((0..lines).map(of).sum::<f64>() / lines as f64).sqrt()
    }

    /// Rows in which its error hardly changes.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
    fn rows_alike(&self) -> usize {
        let mean = self.pass.iter().sum::<f64>() / self.pass.len() as f64;
        (0.5 / mean.max(1e-3)).round().max(1.0) as usize
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
