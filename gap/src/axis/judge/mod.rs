//! Verdict, probabilities, parameters with errors, and how far the gap shrinks on blocks that were not fitted.

mod beyond;
mod found;
mod parameters;
mod rank;
mod shrunk;

pub(super) use beyond::{BEYOND, label};
use beyond::{names, tolerated};
use found::{Fitted, found};
pub use parameters::Parameter;
pub(super) use parameters::{deviation, parameters};
use rank::{Rest, doubt, rank};
pub use shrunk::Shrunk;
pub(super) use shrunk::{by_block, shrunk};

use gimbal_model_file::AxisModel;

use super::balance::Balance;
use super::library::rms;
use super::search::Set;
use crate::judge::Verdict;

/// Share of the gap that may be left over by what explains it.
const LEFT: f64 = 0.03;
/// A fit that leaves more than this of a log that it did not see explains a part.
const CARRIED: f64 = 0.2;
/// Share of the controller's output that a control law may leave.
const LAW_LEFT: f64 = 0.05;
/// From this probability of something unknown on nothing is explained.
const UNEXPLAINED: f64 = 0.6;
/// Share of what is left from which on a beat is most of it, how probable something unknown is then, and beside effects.
const MOST_OF_REST: f64 = 0.2;
const BEATS: f64 = 0.8;
const HALF_UNKNOWN: f64 = 0.5;
/// Share of the gap that is a trifle.
const TRIFLE: f64 = 0.01;
/// Least probability of a set that is not told apart, over that of the set named.
const RIVAL: f64 = 0.1;
/// What is left is more than noise from this power over it on.
const NOTABLE: f64 = 1.5;
/// What is left by nothing that is named is no noise from this many times that and this share of the effort on; nor is it
/// where a run of blocks has this many times the power of the middle one and of noise, and the middle one's share of the effort.
const NO_NOISE: f64 = 3.2;
const NO_TRIFLE: f64 = 0.03;
const RUN: usize = 3;
const APART: f64 = 4.0;

/// An effect that is named.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Its name.
    pub effect: String,
    /// Its block.
    pub block: &'static str,
    /// Marginal probability.
    pub probability: f64,
    /// Parameters.
    pub parameters: Vec<Parameter>,
    /// Share of the gap that it takes away.
    pub removes: f64,
    /// Where it shows: `effort` (the balance), `control law` or `columns`.
    pub shows_in: &'static str,
}

/// A set of effects.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranked {
    /// Names, in alphabetical order, each once.
    pub effects: Vec<String>,
    /// Probability of the set.
    pub probability: f64,
}

/// What is decided on a balance.
#[derive(Debug)]
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    pub(super) found: Vec<Found>,
    /// Fitted, and too small beside what is found to be named.
    pub(super) crumbs: Vec<Found>,
    pub(super) ranking: Vec<Ranked>,
    pub(super) alternatives: Vec<Ranked>,
    pub(super) unknown_probability: f64,
    pub(super) shrunk: Shrunk,
    /// Drawn amplitudes of the set's columns, for bands of confidence.
    pub(super) drawn: Vec<Vec<f64>>,
}

impl Judged {
    /// A control law that leaves a notable part of the output is not the loop's: something is there that is not named.
    pub(super) fn doubt_law(&mut self, left: f64) {
        // what the balance has named may be all there is in it
        let unknown = if self.verdict == Verdict::NoGap { doubt(Rest::share(1.0), 0) } else { UNEXPLAINED };
        if left >= LAW_LEFT {
            self.unnamed(unknown);
        }
    }

    /// What is left has a line in time: of a gap that it is most of, and beside effects, something is there that is not named.
    pub(super) fn doubt_beat(&mut self, share: f64) {
        self.unnamed(match (self.found.is_empty(), share > MOST_OF_REST) {
            (false, _) => HALF_UNKNOWN,
            (true, false) => UNEXPLAINED,
            (true, true) => BEATS,
        });
    }

    /// Something that is not named is so probable, where it is no more so already: nothing is explained without it.
    fn unnamed(&mut self, unknown: f64) {
        if unknown <= self.unknown_probability {
            return;
        }
        self.doubted(unknown);
        self.verdict = match self.verdict {
            Verdict::NoGap => Verdict::Unexplained,
            Verdict::Explained | Verdict::CannotTell => Verdict::PartlyExplained,
            other => other,
        };
    }

    /// Something unknown is so probable: all that is known is that much less.
    fn doubted(&mut self, unknown: f64) {
        let kept = (1.0 - unknown) / (1.0 - self.unknown_probability).max(1e-9);
        self.unknown_probability = unknown;
        self.found.iter_mut().for_each(|found| found.probability *= kept);
        self.ranking.iter_mut().chain(&mut self.alternatives).for_each(|set| set.probability *= kept);
    }

    /// Takes back what does not carry over: what the fit leaves of a log that it did not see is no less unknown than what
    /// it leaves of its own.
    pub(super) fn carried(&mut self, left: f64) {
        let unknown = doubt(Rest::share(left), 0);
        if self.verdict == Verdict::NoGap || unknown <= self.unknown_probability {
            return;
        }
        self.doubted(unknown);
        if unknown > UNEXPLAINED {
            self.verdict = Verdict::Unexplained;
        } else if matches!(self.verdict, Verdict::Explained | Verdict::CannotTell) && left > CARRIED {
            self.verdict = Verdict::PartlyExplained;
        }
    }
}

/// Judges the best set.
pub(super) fn judge(balance: &Balance, best: &Set, model: &AxisModel) -> Judged {
    let fitted = Fitted::new(balance, best);
    let counts = &balance.problem.grams.counts;
    let before = by_block(&balance.target, &balance.motion);
    let floor = balance.motion.floor;
    let shrunk = shrunk("effort".to_owned(), &model.effort_unit, &before, &best.held_out, counts, floor);
    let (ranking, unknown_probability) = rank(balance, best, &fitted.times, &shrunk, model);
    let ranking = if balance.dead_zone_is_friction { or_dead_zone(ranking) } else { ranking };
    let (found, crumbs) = found(balance, &fitted, model, &ranking, shrunk.reduction_percent);
    let alternatives = alternatives(&ranking, &names(balance, &best.members, model), &found);
    let gap = balance.has_gap();
    let rest = Rest::of(&shrunk);
    let verdict = if found.is_empty() {
        let effort = balance.motion.pick(&balance.motion.effort);
        // blocks of a fast slip may stand out of what the parameters leave without being any part of the gap
        let doubtful = doubt(rest, 0).max(unknown_probability) > UNEXPLAINED;
        let left = rest.over_noise > NO_NOISE && shrunk.after > NO_TRIFLE * rms(&effort)
            || doubtful && stands_out(&best.held_out, &by_block(&effort, &balance.motion), counts, floor);
        if gap && (left || rest.share > 0.5 && !tolerated(balance, model)) {
            Verdict::Unexplained
        } else {
            Verdict::NoGap
        }
    } else if unknown_probability > UNEXPLAINED {
        Verdict::Unexplained
    } else if rest.share > LEFT && rest.over_noise.powi(2) > 1.0 + NOTABLE {
        Verdict::PartlyExplained
    } else if alternatives.is_empty() {
        Verdict::Explained
    } else {
        Verdict::CannotTell
    };
    let alternatives = if verdict == Verdict::NoGap { Vec::new() } else { alternatives };
    let nothing_named = found.is_empty();
    let mut judged =
        Judged { verdict, found, crumbs, ranking, alternatives, unknown_probability, shrunk, drawn: fitted.drawn };
    if verdict == Verdict::Unexplained && nothing_named {
        judged.doubted(doubt(rest, 0).max(unknown_probability));
    }
    judged
}

/// Whether a run of blocks has much more left than the others, however much effort there is: something that comes and goes.
fn stands_out(squares: &[f64], effort: &[f64], counts: &[f64], floor: f64) -> bool {
    let of_rows = |squares: &[f64]| -> Vec<f64> {
        let held = squares.iter().zip(counts).filter(|(_, count)| **count > 0.0);
        held.map(|(square, count)| square / count).collect()
    };
    let (powers, efforts) = (of_rows(squares), of_rows(effort));
    let shares: Vec<f64> = powers.iter().zip(&efforts).map(|(power, effort)| power / effort.max(1e-300)).collect();
    let least = APART * middle(&powers).max(floor.powi(2));
    let least_share = APART * middle(&shares);
    let apart: Vec<bool> = powers.iter().zip(&shares).map(|own| *own.0 > least && *own.1 > least_share).collect();
    apart.windows(RUN).any(|run| run.iter().all(|apart| *apart))
}

fn middle(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// Each set with friction beyond its tolerance once more with a dead zone instead: the two are one column.
fn or_dead_zone(ranking: Vec<Ranked>) -> Vec<Ranked> {
    let twice = |set: Ranked| {
        let own = "friction_level";
        if !set.effects.iter().any(|effect| effect == own) {
            return vec![set];
        }
        let renamed = set.effects.iter().map(|effect| if effect == own { "dead_zone" } else { effect }.to_owned());
        let mut other: Vec<String> = renamed.collect();
        other.sort();
        let probability = 0.5 * set.probability;
        vec![Ranked { probability, ..set }, Ranked { effects: other, probability }]
    };
    let mut ranking: Vec<Ranked> = ranking.into_iter().flat_map(twice).collect();
    ranking.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    ranking
}

/// Sets of a ranking that are not told apart from the one that is named: neither part of it nor more than it, and nearly as
/// probable. What differs in a trifle alone is told by the probability of the trifle.
fn alternatives(ranking: &[Ranked], own: &[String], found: &[Found]) -> Vec<Ranked> {
    let own_probability = ranking.iter().find(|set| set.effects == own).map_or(0.0, |set| set.probability);
    let rival = |set: &&Ranked| {
        set.effects != own
            && set.probability > RIVAL * own_probability
            && !own.iter().all(|name| set.effects.contains(name))
            && !set.effects.iter().all(|name| own.contains(name))
    };
    let misses =
        |set: &&Ranked| found.iter().any(|found| found.removes >= TRIFLE && !set.effects.contains(&found.effect));
    ranking.iter().filter(rival).filter(misses).cloned().collect()
}
