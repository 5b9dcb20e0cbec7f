//! Probabilities of sets: how often each is the best when blocks are drawn anew.

use std::f64::consts::TAU;

use gimbal_model_file::AxisModel;

use super::beyond::names;
use super::{LEFT, Ranked, Shrunk};
use crate::axis::balance::Balance;
use crate::axis::library::Shape;
use crate::axis::search::{LEAST_OF_REST, Set};
use crate::judge::UNSEEN;

/// Sets within this share of what is left are not told apart, and what is left counts as this share of all at least.
const SAME: f64 = 0.05;
const LEAST_SAME: f64 = 0.05;
/// What is left makes an unknown effect as likely as not at this share beyond `LEFT`, where it is as small as the noise; and
/// how many times the noise it is where half of that share does. What noise is not is none the less an effect for being small.
const HALF_LEFT: f64 = 0.25;
const OVER_NOISE: f64 = 4.0;
/// Sets that leave nothing are wrong this often, on simulated axes of which some have what the library lacks.
const EVEN_SO: f64 = 0.1;
/// Kinds of effect that a log may well show at once, and what each further one leaves of the probability of the set.
const SURE_KINDS: usize = 2;
const EACH_KIND: f64 = 0.6;
/// Waves over the travel below which a wave of the position draws a function of the place more than that it repeats.
const LONG: f64 = 5.0;

/// What is left of a gap.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rest {
    /// Its power beyond noise, over that of the gap.
    pub(super) share: f64,
    /// Its root mean square over that of the noise.
    pub(super) over_noise: f64,
}

impl Rest {
    /// Of a gap as it shrank.
    pub(super) fn of(shrunk: &Shrunk) -> Self {
        let beyond = |value: f64| value.powi(2) - shrunk.noise_floor.powi(2);
        let share = beyond(shrunk.after).max(0.0) / beyond(shrunk.before).max(1e-300);
        Self { share, over_noise: shrunk.after / shrunk.noise_floor.max(1e-300) }
    }

    /// Such a share, of which it is not known how it compares with noise.
    pub(super) fn share(share: f64) -> Self {
        Self { share, over_noise: 0.0 }
    }
}

/// Probability that it is something else, by what is left and by how many kinds of effect it took. With thirty kinds
/// at hand, a set of many fits almost anything: each beyond the second is half as likely to be there as to make up for
/// something that the library lacks.
pub(super) fn doubt(rest: Rest, kinds: usize) -> f64 {
    let left = (rest.share - LEFT).max(0.0);
    let half = HALF_LEFT / (1.0 + (rest.over_noise / OVER_NOISE).powi(2));
    let of_rest = (left / (left + half)).max(EVEN_SO);
    let known = (1.0 - of_rest) * (0..kinds.saturating_sub(SURE_KINDS)).fold(1.0, |known, _| known * EACH_KIND);
    (1.0 - known).clamp(0.005, 0.98)
}

/// Long waves beside the first one of their effect: a few of them draw any function of the place, so each is as a kind more.
fn long_waves_beside(balance: &Balance, set: &Set) -> usize {
    let shapes = set.members.iter().map(|&member| &balance.problem.candidates[member].shape);
    let is_long = |shape: &&Shape| {
        let number = shape.numbers().first().filter(|(name, _)| *name == "wave_number").map(|(_, number)| *number);
        number.is_some_and(|number| number * balance.motion.travel < LONG * TAU)
    };
    let mut effects: Vec<&str> = shapes.filter(is_long).map(Shape::effect).collect();
    let all = effects.len();
    effects.sort_unstable();
    effects.dedup();
    all - effects.len()
}

/// Probabilities of sets: how often each is the best when blocks are drawn anew.
pub(super) fn rank(
    balance: &Balance,
    best: &Set,
    times: &[Vec<f64>],
    shrunk: &Shrunk,
    model: &AxisModel,
) -> (Vec<Ranked>, f64) {
    let mut sets = balance.problem.beside(best);
    sets.push(best.clone());
    sets.sort_by(|a, b| a.square().total_cmp(&b.square()));
    let mut kinds: Vec<(Vec<String>, Vec<Set>)> = Vec::new();
    for set in sets {
        let names = names(balance, &set.members, model);
        match kinds.iter_mut().find(|(other, _)| *other == names) {
            Some((_, sets)) if sets.len() < 3 => sets.push(set),
            Some(_) => {}
            None => kinds.push((names, vec![set])),
        }
    }
    let rows: f64 = balance.problem.grams.counts.iter().sum::<f64>().max(1.0);
    let floor_square = balance.problem.floor_square;
    // an effect more must earn half of what it must in the search
    let each = balance.problem.price().max(0.5 * LEAST_OF_REST * (best.square() - floor_square).max(0.0));
    let cost = |set: &Set| each * balance.problem.effects(&set.members) as f64;
    // sets that differ in a small share of what is left, which no effect explains, are not told apart by it
    let same = SAME * (best.square() - floor_square).max(LEAST_SAME * best.square()).max(1e-300);
    let costs: Vec<Vec<f64>> = kinds.iter().map(|(_, sets)| sets.iter().map(cost).collect()).collect();
    let mut wins = vec![0.0; kinds.len()];
    for times in times {
        let drawn: f64 = balance.problem.grams.counts.iter().zip(times).map(|(c, t)| c * t).sum::<f64>().max(1.0);
        let score = |(set, cost): (&Set, &f64)| {
            let square: f64 = set.held_out.iter().zip(times).map(|(s, t)| s * t).sum();
            square * rows / drawn + cost
        };
        let scores: Vec<f64> = kinds
            .iter()
            .zip(&costs)
            .map(|((_, sets), costs)| sets.iter().zip(costs).map(score).fold(f64::MAX, f64::min))
            .collect();
        let least = scores.iter().copied().fold(f64::MAX, f64::min);
        let weights: Vec<f64> = scores.iter().map(|score| (-(score - least) / same).exp()).collect();
        let sum: f64 = weights.iter().sum();
        wins.iter_mut().zip(&weights).for_each(|(wins, weight)| *wins += weight / sum);
    }
    let kinds_named = names(balance, &best.members, model).len() + long_waves_beside(balance, best);
    let unknown = if kinds_named == 0 { UNSEEN } else { doubt(Rest::of(shrunk), kinds_named) };
    let total = wins.iter().sum::<f64>() + 1.0;
    let mut ranking: Vec<Ranked> = kinds
        .into_iter()
        .zip(wins)
        .filter(|(_, wins)| *wins > 0.5)
        .map(|((effects, _), wins)| Ranked { effects, probability: wins / total * (1.0 - unknown) })
        .collect();
    ranking.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let sum: f64 = ranking.iter().map(|set| set.probability).sum();
    (ranking, 1.0 - sum)
}
