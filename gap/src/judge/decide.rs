//! The verdict and its probabilities.

use gimbal_model_file::Tolerance;
use gimbal_plant::Effect;

use super::comb;
use super::left_over::left_over;
use super::strange::{Stranger, strangers};
use crate::fit::{Fit, Problem, Search};
use crate::record::Signal;

/// Evidence that an effect must bring to be named; a nominal parameter beyond its tolerance needs less [nats].
const COST: f64 = 14.0;
const COST_OF_SHIFT: f64 = 6.0;
/// The same for a parameter at the end of its range [nats].
const BOUND_HIT: f64 = 20.0;
/// A nominal parameter is an effect from this many tolerances on.
const BEYOND: f64 = 1.15;
/// Nats that count as one in probabilities: a constant, and a share of what the best set gains.
const SCALE: f64 = 2.0;
const SCALE_SHARE: f64 = 1e-5;
/// Standard deviations that what is left may stand out by, and the spread of that limit.
const LEFT_OVER: f64 = 13.0;
const LEFT_OVER_SCALE: f64 = 2.0;
/// What torques of no effect may take of it beyond chance, and the spread of that limit [nats].
const STRANGE: f64 = 24.0;
const STRANGE_SCALE: f64 = 2.5;
/// Share of a gap that an effect's formulation may leave.
const FORMULATION_LEAVES: f64 = 0.05;
/// Least share of the gap that an effect takes away.
const LEAST_SHARE: f64 = 0.003;

/// What it comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing beyond noise and tolerance.
    NoGap,
    /// One set, and nothing left over.
    Explained,
    /// Effects, and something left over.
    PartlyExplained,
    /// A gap without an effect.
    Unexplained,
    /// Several sets that this log cannot tell apart, or data that do not serve.
    CannotTell,
}

impl Verdict {
    /// Name in the report.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NoGap => "no_gap",
            Self::Explained => "explained",
            Self::PartlyExplained => "partly_explained",
            Self::Unexplained => "unexplained",
            Self::CannotTell => "cannot_tell",
        }
    }
}

/// An effect that is named.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Its name.
    pub effect: &'static str,
    /// Marginal probability.
    pub probability: f64,
    /// Values in the order of the effect's parameters.
    pub values: Vec<f64>,
    /// Standard errors.
    pub errors: Vec<f64>,
}

/// A set of effects and its probability.
#[derive(Debug, Clone, PartialEq)]
pub struct SetProbability {
    /// Names, in alphabetical order.
    pub effects: Vec<&'static str>,
    /// Of the set.
    pub probability: f64,
}

/// The verdict.
#[derive(Debug, Clone)]
pub struct Decision {
    /// What it comes to.
    pub verdict: Verdict,
    /// Effects named.
    pub found: Vec<Found>,
    /// Every set looked at, the most probable first; the empty set is the nominal model.
    pub ranking: Vec<SetProbability>,
    /// Other members of the class.
    pub alternatives: Vec<SetProbability>,
    /// That none of the library's effects is it.
    pub unknown_probability: f64,
    /// Index of the fit chosen in the search; none is the nominal model.
    pub chosen: Option<usize>,
    /// Power left over before and after, over white noise.
    pub left_over: [f64; 2],
    /// What is left, tried on torques of no effect, the likeliest first.
    pub strangers: Vec<Stranger>,
    /// Remarks.
    pub notes: Vec<String>,
}

impl Decision {
    /// What the rest goes with, where it does with something.
    #[must_use]
    pub fn goes_with(&self) -> Option<&Stranger> {
        self.strangers.first().filter(|stranger| stranger.nats() > STRANGE)
    }
}

/// Judges what the search found.
#[must_use]
#[allow(clippy::too_many_lines, reason = "one decision, told in its order")]
pub fn decide(problem: &Problem, search: &Search, tolerance: &Tolerance) -> Decision {
    let best_square = search.fits.iter().map(|fit| fit.square).fold(search.null.square, f64::min);
    let temper = problem.formulation(best_square);
    let null_excess = (search.null.square - best_square).max(1.0);
    let score = |fit: &Fit| -> f64 {
        let mut score = fit.evidence(temper) - search.null.evidence(temper);
        for (place, &index) in fit.set.0.iter().enumerate() {
            let candidate = &problem.candidates[index];
            if fit.is_idle(place) {
                score -= 1e3;
            }
            if candidate.releases.is_empty() {
                score -= COST + at_a_bound(candidate.effect, &fit.values[place]);
            } else {
                score -= COST_OF_SHIFT;
                if !beyond(problem, tolerance, candidate.effect, &fit.values[place], &fit.errors[place]) {
                    score -= 1e3;
                }
            }
        }
        score
    };
    let mut scores: Vec<f64> = search.fits.iter().map(&score).collect();
    // what a set has more than a smaller one must be worth it
    for (index, fit) in search.fits.iter().enumerate() {
        for (other, smaller) in search.fits.iter().enumerate() {
            let nested = smaller.set.0.len() < fit.set.0.len()
                && names(problem, smaller).iter().all(|name| names(problem, fit).contains(name));
            if nested && smaller.square - fit.square < LEAST_SHARE * null_excess && scores[index] > scores[other] {
                scores[index] = scores[other] - 1.0;
            }
        }
    }
    let top = scores.iter().copied().fold(0.0, f64::max);
    let scale = SCALE + SCALE_SHARE * top;
    let mut weights: Vec<f64> = scores.iter().map(|score| ((score - top) / scale).exp()).collect();
    let null_weight = (-top / scale).exp();
    let sum = null_weight + weights.iter().sum::<f64>();
    for weight in &mut weights {
        *weight /= sum;
    }
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|a, b| weights[*b].total_cmp(&weights[*a]));
    let chosen = order.first().copied().filter(|&index| weights[index] > null_weight / sum);
    let before = left_over(problem, &search.null.residual);
    let after = chosen.map_or(before, |index| left_over(problem, &search.fits[index].residual));
    let fit = chosen.map_or(&search.null, |index| &search.fits[index]);
    let strangers = strangers(problem, fit);
    let strange = strangers.first().map_or(0.0, Stranger::nats);
    let taken = 0.5 * (search.null.square + search.null.prior - fit.square - fit.prior);
    let unknown = unknown(after, after / before.max(after).max(1e-9), LEFT_OVER, LEFT_OVER_SCALE, chosen.is_some())
        .max(unknown(strange, strange / (strange + taken).max(1e-9), STRANGE, STRANGE_SCALE, chosen.is_some()));
    let share = 1.0 - unknown;
    let set_of = |index: usize| SetProbability {
        effects: names(problem, &search.fits[index]),
        probability: share * weights[index],
    };
    let mut ranking: Vec<SetProbability> = order.iter().map(|&index| set_of(index)).collect();
    ranking.push(SetProbability { effects: Vec::new(), probability: share * null_weight / sum });
    ranking.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let mut decision = Decision {
        verdict: Verdict::NoGap,
        found: Vec::new(),
        ranking,
        alternatives: Vec::new(),
        unknown_probability: unknown,
        chosen,
        left_over: [before, after],
        strangers,
        notes: Vec::new(),
    };
    if let Some(index) = chosen {
        let best = &search.fits[index];
        let own = names(problem, best);
        let marginal = |effect: &str| -> f64 {
            decision.ranking.iter().filter(|set| set.effects.contains(&effect)).map(|set| set.probability).sum()
        };
        decision.found = best
            .set
            .0
            .iter()
            .enumerate()
            .map(|(place, &candidate)| {
                let effect = problem.candidates[candidate].effect;
                let (values, errors) = (best.values[place].clone(), best.errors[place].clone());
                Found { effect, probability: marginal(effect), values, errors }
            })
            .collect();
        decision.alternatives = order
            .iter()
            .filter(|&&other| {
                other != index
                    && weights[other] > 0.1 * weights[index]
                    && !contains(&names(problem, &search.fits[other]), &own)
            })
            .map(|&other| set_of(other))
            .collect();
        decision.verdict = if unknown > 0.6 {
            decision.found.clear();
            decision.chosen = None;
            Verdict::Unexplained
        } else if after > LEFT_OVER + LEFT_OVER_SCALE || strange > STRANGE + STRANGE_SCALE {
            Verdict::PartlyExplained
        } else if decision.alternatives.is_empty() {
            Verdict::Explained
        } else {
            Verdict::CannotTell
        };
        if decision.verdict != Verdict::CannotTell {
            decision.alternatives.clear();
        }
    } else if unknown > 0.5 {
        decision.verdict = Verdict::Unexplained;
    }
    if let Some(stranger) = decision.goes_with() {
        decision.notes.push(format!("what is left goes with {stranger}"));
    }
    direct(problem, fit, tolerance, &mut decision);
    decision
}

/// Names of a fit's effects, in order.
pub(crate) fn names(problem: &Problem, fit: &Fit) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = fit.set.0.iter().map(|&index| problem.candidates[index].effect).collect();
    names.sort_unstable();
    names
}

fn contains(larger: &[&str], smaller: &[&str]) -> bool {
    smaller.iter().all(|name| larger.contains(name))
}

/// What a shape at the end of its realistic range costs: a cable's loop as long as the motion is a spring.
fn at_a_bound(effect: &str, values: &[f64]) -> f64 {
    let Some(effect) = Effect::from_name(effect) else { return 0.0 };
    let shapes = effect.parameters().iter().zip(values).skip(effect.sizes());
    let outside = |(parameter, value): (&gimbal_plant::Parameter, &f64)| {
        parameter.bound != gimbal_plant::Bound::Any && !(parameter.low..=parameter.high).contains(value)
    };
    if shapes.into_iter().any(outside) { BOUND_HIT } else { 0.0 }
}

/// Whether a nominal parameter is beyond its tolerance by more than its own error.
fn beyond(problem: &Problem, tolerance: &Tolerance, effect: &str, values: &[f64], errors: &[f64]) -> bool {
    let scale = if effect == "mass_unbalance" {
        let unbalance = &problem.base.config.unbalance;
        unbalance.x_kg_m.hypot(unbalance.y_kg_m).max(1e-6)
    } else {
        1.0
    };
    values.iter().zip(errors).any(|(value, error)| value.abs() - error > BEYOND * tolerance.of(effect) * scale)
}

/// How probable it is that no effect of the library is it: from how far what is left stands out beyond a limit, and
/// from its share of the gap, as a large effect in another formulation leaves something too.
fn unknown(stands_out: f64, share: f64, limit: f64, scale: f64, found: bool) -> f64 {
    let stands_out = 1.0 / (1.0 + (-(stands_out - limit) / scale).exp());
    let share = if found { share } else { 1.0 };
    (stands_out * share / (share + FORMULATION_LEAVES) * (1.0 + FORMULATION_LEAVES)).clamp(0.002, 0.98)
}

/// What the samples show by themselves: a stop elsewhere, a grid of angles.
fn direct(problem: &Problem, fit: &Fit, tolerance: &Tolerance, decision: &mut Decision) {
    let mut add = |effect: &'static str, value: f64, error: f64, probability: f64| {
        if Effect::from_name(effect).is_none() || problem.not_looked_for.contains(&effect) {
            return;
        }
        decision.found.push(Found { effect, probability, values: vec![value], errors: vec![error] });
        for set in &mut decision.ranking {
            set.effects.push(effect);
            set.effects.sort_unstable();
        }
        for set in &mut decision.alternatives {
            set.effects.push(effect);
        }
        if decision.verdict == Verdict::NoGap
            || decision.verdict == Verdict::Unexplained && decision.left_over[1] < 10.0 * LEFT_OVER
        {
            decision.verdict = Verdict::Explained;
            decision.unknown_probability = decision.unknown_probability.min(0.05);
        }
    };
    if let Some(plateau) = problem.record.plateau_rad {
        let change = plateau / problem.stop_rad - 1.0;
        if change.abs() > BEYOND * tolerance.stop_angle {
            add("stop_angle", change, problem.noise[0] / problem.stop_rad, 0.95);
        }
    }
    if let Some(theta) = problem.record.channel(Signal::GyroAngle)
        && let Some(step) = comb::step_rad(&theta.values, &fit.prediction.gyro_angle_rad, &theta.valid)
    {
        add("pickoff_quantisation", step, 1e-3 * step, 0.97);
    }
}
