//! Which set of effects: forward steps and all pairs, exchanges and removals, judged on blocks that were not fitted.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::library::{NOMINAL, Shape};
use super::regress::{FOLDS, Grams, fold_of};
use super::slip::Slip;

/// One effect with fixed shape parameters.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) shape: Shape,
    /// Its columns.
    pub(super) columns: Vec<usize>,
}

/// A regression to be explained: base columns under priors, and candidates.
#[derive(Debug)]
pub(super) struct Problem {
    pub(super) base: Vec<usize>,
    pub(super) candidates: Vec<Candidate>,
    pub(super) grams: Grams,
    /// Squared error that noise alone would leave.
    pub(super) floor_square: f64,
    /// Squared effort over all rows, and the nominal friction.
    pub(super) effort_square: f64,
    /// Share of the gap that an effect must take.
    pub(super) least_share: f64,
    /// Nominal parameters, where the base columns are they.
    pub(super) nominal: Option<[f64; 3]>,
    /// Where friction must brake.
    pub(super) slip: Slip,
    /// Travel of the position.
    pub(super) travel: f64,
    /// How far each base column's amplitude may go before that is an effect.
    pub(super) within: Vec<f64>,
}

/// An effect must take this share of the gap that was there, and this share of what is left.
pub(super) const LEAST_SHARE: f64 = 0.005;
pub(super) const LEAST_OF_REST: f64 = 0.03;
/// And as much as noise has in so many rows.
const LEAST_ROWS: f64 = 100.0;
/// Its gain must exceed its own standard error over blocks by this factor.
const LEAST_T: f64 = 2.5;
/// A gain that is most of what was left is no chance where it is there in so many folds, however unequal the blocks.
const MOST_OF_REST: f64 = 0.5;
const FOLDS_WITH: usize = 6;
/// Effects at most; many kinds of ripple count each.
const MOST: usize = 10;
/// What an asymmetry must be better by than an offset.
const ASYMMETRIC: f64 = 1.03;
/// Candidates of which all pairs are tried.
const PAIRED: usize = 48;
/// Power of waves of the position, each by itself, over that of all together, from which on they are no waves: a function of a
/// place is drawn by waves that cancel elsewhere.
const CANCEL: f64 = 30.0;
/// Share of the effort's power that is rounding.
const NOTHING: f64 = 1e-9;

/// Sums over the blocks of each fold.
fn folds(blocks: &[f64]) -> [f64; FOLDS] {
    let mut sums = [0.0; FOLDS];
    for (block, value) in blocks.iter().enumerate() {
        sums[fold_of(block)] += value;
    }
    sums
}

/// A set with its errors on blocks held out.
#[derive(Debug, Clone)]
pub(super) struct Set {
    pub(super) members: Vec<usize>,
    pub(super) held_out: Vec<f64>,
}

impl Set {
    pub(super) fn square(&self) -> f64 {
        self.held_out.iter().sum()
    }
}

impl Problem {
    /// Columns of a set.
    pub(super) fn columns(&self, members: &[usize]) -> Vec<usize> {
        let own = members.iter().flat_map(|&member| self.candidates[member].columns.iter().copied());
        self.base.iter().copied().chain(own).collect()
    }

    /// A set; one whose amplitudes cannot be has no bound to its error.
    pub(super) fn set(&self, members: Vec<usize>) -> Set {
        let columns = self.columns(&members);
        let possible = members.is_empty() || self.possible(&members, &columns);
        let mut held_out = self.grams.held_out(&columns);
        if !possible {
            for square in &mut held_out {
                *square = 1e3 * (*square + self.effort_square);
            }
        }
        Set { members, held_out }
    }

    fn possible(&self, members: &[usize], columns: &[usize]) -> bool {
        let fit = self.grams.fit(columns);
        let at = |column: usize| columns.iter().position(|c| *c == column).map_or(0.0, |place| fit[place]);
        let mut level = f64::MAX;
        if let Some(nominal) = self.nominal {
            let total = |index: usize| {
                let of = |shape: &Shape| {
                    let own = members.iter().find(|&&member| self.candidates[member].shape == *shape);
                    own.map_or(0.0, |&member| at(self.candidates[member].columns[0]))
                };
                nominal[index] * (1.0 + of(&Shape::Scale)) + fit[index] + of(&NOMINAL[index])
            };
            // an effort that follows the rate with the sign of a drive is the loop's own law, not friction
            let drives = |index: usize| {
                let total = total(index);
                total < 0.0 && total.powi(2) * self.grams.power(index) > NOTHING * self.effort_square
            };
            if (0..3).any(drives) {
                return false;
            }
            level = total(2);
            if !self.slip.brakes(columns, &fit) {
                return false;
            }
        }
        let of_place = |shape: &Shape| matches!(shape, Shape::Ripple { .. } | Shape::Spring);
        let waves = members.iter().filter(|&&member| of_place(&self.candidates[member].shape));
        let waves: Vec<usize> = waves.flat_map(|&member| self.candidates[member].columns.iter().copied()).collect();
        let sizes: Vec<f64> = waves.iter().map(|&column| at(column)).collect();
        let [apart, together] = self.grams.powers(&waves, &sizes);
        if apart > CANCEL * together.max(0.0) {
            return false;
        }
        members.iter().all(|&member| {
            let own: Vec<f64> = self.candidates[member].columns.iter().map(|&column| at(column)).collect();
            self.candidates[member].shape.possible(&own, level)
        })
    }

    /// Whether a candidate may join.
    fn fits(&self, members: &[usize], candidate: usize) -> bool {
        let shape = &self.candidates[candidate].shape;
        members.iter().all(|&member| {
            let other = &self.candidates[member].shape;
            if other.effect() != shape.effect() {
                return !other.holds(shape) && !shape.holds(other);
            }
            let apart = || {
                let (a, b) = (other.numbers(), shape.numbers());
                match (a.first(), b.first()) {
                    (Some(a), Some(b)) => (a.1 - b.1).abs() > 1e-3 * a.1.abs(),
                    _ => other != shape,
                }
            };
            shape.many() && member != candidate && apart()
        })
    }

    /// The best set found.
    pub(super) fn search(&self, start: Vec<usize>) -> Set {
        let all: Vec<usize> = (0..self.candidates.len()).collect();
        let empty = self.set(Vec::new());
        let gap = (empty.square() - self.floor_square).max(0.0);
        let mut best = self.set(start);
        if best.members.is_empty()
            && let Some(pair) = self.best_pair(&all)
            && self.worth(&empty, &pair, gap, 2.0)
        {
            best = pair;
        }
        for _ in 0..3 * MOST {
            let before = best.square();
            best = self.dropped(best, gap);
            best = self.exchanged(best, &all);
            if best.members.len() < MOST
                && let Some(longer) = self.extended(&best, &all)
                && (self.worth(&best, &longer, gap, 1.0) || self.simpler(&longer, &best))
            {
                best = longer;
            }
            if best.square() > before * (1.0 - 1e-4) {
                break;
            }
        }
        self.dropped(best, gap)
    }

    /// Whether a longer set is worth its effects.
    fn worth(&self, shorter: &Set, longer: &Set, gap: f64, effects: f64) -> bool {
        let gain = shorter.square() - longer.square();
        let rest = (shorter.square() - self.floor_square).max(0.0);
        let filled = self.grams.counts.iter().filter(|count| **count > 0.0).count().max(2) as f64;
        let gains: Vec<f64> = shorter.held_out.iter().zip(&longer.held_out).map(|(a, b)| a - b).collect();
        let mean = gain / filled;
        let spread: f64 = gains
            .iter()
            .zip(&self.grams.counts)
            .filter(|(_, count)| **count > 0.0)
            .map(|(g, _)| (g - mean).powi(2))
            .sum::<f64>()
            / (filled - 1.0);
        let error = (spread / filled).sqrt();
        // below some share of the effort's power a model of any form is wrong
        let added = longer.members.iter().filter(|member| !shorter.members.contains(member));
        let of_effort = added.map(|&member| self.candidates[member].shape.least_of_effort()).fold(0.0, f64::max);
        let least = (self.least_share * gap)
            .max(LEAST_OF_REST * rest)
            .max(of_effort * self.effort_square)
            .max(LEAST_ROWS * self.floor_square / self.grams.counts.iter().sum::<f64>().max(1.0));
        let broad =
            || gain > MOST_OF_REST * rest && folds(&gains).iter().filter(|gain| **gain > 0.0).count() >= FOLDS_WITH;
        rest > 0.0 && gain > effects * least && (mean > LEAST_T * error || broad())
    }

    /// Effects that a set stands for: its members, and base columns beyond what is known of them.
    pub(super) fn effects(&self, members: &[usize]) -> usize {
        let columns = self.columns(members);
        let fit = self.grams.fit(&columns);
        let freed = |index: usize| {
            let own = members.iter().find(|&&m| self.nominal.is_some() && self.candidates[m].shape == NOMINAL[index]);
            let place = own.and_then(|&m| columns.iter().position(|c| *c == self.candidates[m].columns[0]));
            place.map_or(0.0, |place| fit[place])
        };
        let tapers = members.iter().any(|&m| self.candidates[m].shape == Shape::FrictionTaper);
        let beyond = self.within.iter().enumerate().filter(|(index, limit)| {
            let level = tapers && self.nominal.is_some() && *index == 2;
            !level && (fit[*index] + freed(*index)).abs() > **limit
        });
        let named = members.iter().filter(|&&m| !NOMINAL.contains(&self.candidates[m].shape));
        // a spring has two amplitudes, an offset one; so has a wave of which less than a half shows
        let springs = members.iter().filter(|&&m| match self.candidates[m].shape {
            Shape::Spring => true,
            Shape::Ripple { wave_number } => wave_number * self.travel < PI,
            _ => false,
        });
        beyond.count() + named.count() + springs.count()
    }

    /// Squared error that an effect must be worth, whatever else.
    pub(super) fn price(&self) -> f64 {
        LEAST_SHARE * (self.grams.square_of_target() - self.floor_square).max(0.0)
    }

    /// What sets are compared by: their error and their effects; of an offset and an asymmetry that the log cannot tell
    /// apart, the offset.
    pub(super) fn key(&self, set: &Set) -> f64 {
        let priced = self.price() * self.effects(&set.members) as f64;
        let asymmetry = |shape: &Shape| matches!(shape, Shape::Asymmetry | Shape::DragAsymmetry);
        let asymmetric = set.members.iter().any(|&member| asymmetry(&self.candidates[member].shape));
        priced + set.square() * if asymmetric { ASYMMETRIC } else { 1.0 }
    }

    /// Whether a longer set says the same with fewer effects, for parameters come back to what is known of them.
    fn simpler(&self, longer: &Set, shorter: &Set) -> bool {
        self.effects(&longer.members) < self.effects(&shorter.members) && self.key(longer) < self.key(shorter)
    }

    fn best_of(&self, sets: Vec<Vec<usize>>) -> Option<Set> {
        sets.into_par_iter().map(|members| self.set(members)).min_by(|a, b| self.key(a).total_cmp(&self.key(b)))
    }

    fn extended(&self, set: &Set, all: &[usize]) -> Option<Set> {
        let longer = all.iter().filter(|&&candidate| self.fits(&set.members, candidate));
        self.best_of(longer.map(|&candidate| [&set.members[..], &[candidate]].concat()).collect())
    }

    fn best_pair(&self, all: &[usize]) -> Option<Set> {
        let mut singles: Vec<Set> = all.par_iter().map(|&candidate| self.set(vec![candidate])).collect();
        singles.sort_by(|a, b| a.square().total_cmp(&b.square()));
        let mut kinds: Vec<(&str, usize)> = Vec::new();
        let mut few = Vec::new();
        for single in &singles {
            let kind = self.candidates[single.members[0]].shape.effect();
            let seen = if let Some((_, seen)) = kinds.iter_mut().find(|(name, _)| *name == kind) {
                seen
            } else {
                kinds.push((kind, 0));
                let last = kinds.len() - 1;
                &mut kinds[last].1
            };
            *seen += 1;
            if *seen <= 3 && few.len() < PAIRED {
                few.push(single.members[0]);
            }
        }
        let pairs = few.iter().enumerate().flat_map(|(place, &a)| few[place + 1..].iter().map(move |&b| vec![a, b]));
        self.best_of(pairs.filter(|pair| self.fits(&pair[..1], pair[1])).collect())
    }

    fn exchanged(&self, mut best: Set, all: &[usize]) -> Set {
        for place in 0..best.members.len() {
            let mut others = best.members.clone();
            others.remove(place);
            let with = all.iter().filter(|&&candidate| self.fits(&others, candidate));
            let sets = with.map(|&candidate| {
                let mut members = best.members.clone();
                members[place] = candidate;
                members
            });
            if let Some(other) = self.best_of(sets.collect())
                && self.key(&other) < self.key(&best) * (1.0 - 1e-3)
            {
                best = other;
            }
        }
        best
    }

    fn dropped(&self, mut best: Set, gap: f64) -> Set {
        while !best.members.is_empty() {
            let shorter = (0..best.members.len()).map(|place| {
                let mut members = best.members.clone();
                members.remove(place);
                members
            });
            match self.best_of(shorter.collect()) {
                Some(shorter) if !self.worth(&shorter, &best, gap, 1.0) && !self.simpler(&best, &shorter) => {
                    best = shorter;
                }
                _ => break,
            }
        }
        best
    }

    /// Sets that stand beside the best: one member exchanged or left out, and the nominal model.
    pub(super) fn beside(&self, best: &Set) -> Vec<Set> {
        let mut sets: Vec<Vec<usize>> = vec![Vec::new()];
        for place in 0..best.members.len() {
            let mut others = best.members.clone();
            others.remove(place);
            for candidate in (0..self.candidates.len()).filter(|&c| c != best.members[place] && self.fits(&others, c)) {
                let mut members = others.clone();
                members.insert(place, candidate);
                sets.push(members);
            }
            sets.push(others);
        }
        sets.into_par_iter().map(|members| self.set(members)).collect()
    }
}
