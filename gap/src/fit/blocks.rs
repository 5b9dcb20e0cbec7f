//! Blocks of rows in which the bearing turns around, and what a change of their rate does.
//!
//! They are short against the loop and long against the filter of the rate, whose error they take for constant.

use rayon::prelude::*;

use super::draft::Draft;
use super::release::Released;
use super::signals::{Kept, Signals};
use super::turning::{SLOWLY, at_once, mostly};
use crate::record::{RateNoise, Record};
use crate::simulate::Variant;

/// Most blocks.
const MOST: usize = 800;
/// Rows before and after the beginning of a block in which it shows.
const BEFORE: usize = 200;
const AFTER: usize = 1000;
/// Rate by which a block is moved, over the slip rate.
const STEP: f64 = 0.02;
/// Predictions that are held at a time.
const TOGETHER: usize = 16;

/// Rows of a block.
type Block = std::ops::Range<usize>;

/// Blocks, and what a change of their rate by 1 rad/s does, over the noise, before any filter: those that are far from each other in
/// one.
pub(crate) struct Turned {
    pub(super) blocks: Vec<Block>,
    moved: Vec<(Vec<usize>, Kept)>,
    /// What stops leave behind.
    released: Released,
}

/// What blocks are made from.
pub(crate) struct Turning<'a> {
    pub(crate) draft: Draft<'a>,
    /// Rows at which the bearing turns around.
    pub(crate) turns: &'a [bool],
}

impl Turning<'_> {
    fn blocks(&self) -> Vec<Block> {
        let rate_noise = &self.draft.record.rate_noise;
        if rate_noise.rms_radps < 1e-9 || mostly(self.turns) {
            return Vec::new();
        }
        let least = if at_once(self.turns) { 1 } else { SLOWLY };
        let mut longest = rate_noise.rows_alike().max(least);
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
        let (draft, blocks) = (&self.draft, self.blocks());
        let step = STEP * draft.base.config.bearing.slip_rate_radps;
        let mut moved = Vec::new();
        let groups = far_apart(&blocks);
        for some in groups.chunks(TOGETHER) {
            let of = |group: &Vec<usize>| {
                let mut rate_radps = draft.record.inputs.rate_radps.clone();
                group.iter().flat_map(|&index| blocks[index].clone()).for_each(|k| rate_radps[k] += step);
                rate_radps
            };
            let rates: Vec<Vec<f64>> = some.iter().map(of).collect();
            let at = |rate_radps| Variant { rate_radps: Some(rate_radps), ..draft.variant(draft.base.clone()) };
            moved.extend(draft.differences(rates.iter().map(|rates| (at(&rates[..]), step)).collect()));
        }
        Turned { blocks, moved: groups.into_iter().zip(moved).collect(), released: Released::new(draft) }
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
    pub(super) fn shown(
        &self,
        channels: usize,
        filter: impl Fn(&Signals) -> Vec<f64> + Sync,
    ) -> Vec<(usize, Vec<f64>)> {
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

/// How far the rate may be off the line between rows, in each block: an eighth of its second differences, less those of noise.
pub(super) fn bent(record: &Record, blocks: &[Block]) -> Vec<f64> {
    let rate = &record.inputs.rate_radps;
    let of_noise = 6.0 * record.rate_noise.rms_radps.powi(2);
    let of = |block: &Block| {
        let rows = block.start.max(1)..(block.end + 1).min(rate.len() - 1);
        let squares = rows.clone().map(|k| (rate[k - 1] - 2.0 * rate[k] + rate[k + 1]).powi(2));
        0.125 * (squares.sum::<f64>() / rows.len().max(1) as f64 - of_noise).max(0.0).sqrt()
    };
    blocks.iter().map(of).collect()
}
