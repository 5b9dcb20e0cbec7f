//! The verdict and its probabilities.

use gimbal_model_file::Tolerance;
use gimbal_plant::Effect;

use super::left_over::left_over;
use super::probability::{Probabilities, SetProbability};
use super::samples::{steps, stop_change};
use super::set::holds;
use super::strange::{Stranger, strangers};
use super::weigh::{Weighed, best, caution, hidden_beside, moves_freely, weigh};
use crate::fit::{Fit, Problem, Search};
use crate::record::Signal;

/// Probability of a cause that nothing shows, whether an effect explains the log or none has to; and how sure it can be
/// that none of the library's is it, from logs with open answers.
pub(crate) const UNSEEN: f64 = 0.03;
const SUREST: f64 = 0.92;
/// Odds of something unknown where torques of no effect take all but what they may without being told, the power by which
/// they grow up to there, and how probable it can be below: from logs with open answers too.
const ODDS_AT_LIMIT: f64 = 0.9;
const ODDS_POWER: f64 = 1.2;
const BELOW_LIMIT: f64 = 0.47;
/// Unknown is the verdict from here on, without and with an effect.
pub(crate) const UNEXPLAINED: [f64; 2] = [0.5, 0.6];
/// Share of the likeliest set's probability from which on another is not told apart from it.
const RIVAL: f64 = 0.27;
/// Least probability that is reported.
const POSSIBLE: f64 = 0.002;
/// What may be left where the bearing turns around most of the time: the noise of the rate is less well known there.
const TURNING: Limits = Limits { left_over: 24.0, left_over_scale: 2.0, strange: 30.0, strange_scale: 2.5 };
/// The same where it moves one way for long.
const MOVING: Limits = Limits { left_over: 14.0, left_over_scale: 1.5, strange: 23.0, strange_scale: 1.5 };
/// How much more torques of no effect must take where the bearing turns around most of the time: the noise of the rate is
/// like some of them.
const WARY: f64 = 1.6;
/// What may be left beside what the samples show by themselves [standard deviations].
const ROUGH: f64 = 10.0 * TURNING.left_over;
/// Probability of something unknown beside it.
const SHOWN: f64 = 0.05;
/// Fuller sets that are looked at where one leaves what stands out.
const FULLER: usize = 3;
/// Share of a gap that an effect's formulation may leave.
const FORMULATION_LEAVES: f64 = 0.05;

/// What may be left without being told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits {
    /// Standard deviations that what is left may stand out by, and the spread of that limit.
    pub(crate) left_over: f64,
    pub(crate) left_over_scale: f64,
    /// What torques of no effect may take of it beyond chance, and the spread of that limit [nats].
    pub(crate) strange: f64,
    pub(crate) strange_scale: f64,
}

impl Limits {
    pub(crate) fn of(problem: &Problem) -> Self {
        let limits = if problem.turns_mostly { TURNING } else { MOVING };
        let wary = if problem.turns_mostly { WARY } else { caution(problem) };
        Self { strange: wary * limits.strange, ..limits }
    }

    /// Whether what is left stands out beyond them, or torques of no effect take more.
    pub(crate) fn are_passed(&self, left_over: f64, strange: f64) -> bool {
        left_over > self.left_over + self.left_over_scale || strange > self.strange + self.strange_scale
    }
}

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
    /// What these may take beyond chance without being told of [nats].
    pub strange_limit: f64,
    /// Remarks.
    pub notes: Vec<String>,
}

impl Decision {
    /// What the rest goes with, where it does with something.
    #[must_use]
    pub fn goes_with(&self) -> Option<&Stranger> {
        self.strangers.first().filter(|stranger| stranger.nats() > self.strange_limit)
    }

    /// Sets that are not told apart from one: nearly as probable, and more than it with something added.
    fn rivals(&self, own: &[&str]) -> Vec<SetProbability> {
        rivals(&self.ranking, own)
    }

    /// What stands beside the set that is named: the rest of its class, or whatever else is possible.
    pub(crate) fn others(&self) -> Vec<SetProbability> {
        let mut own: Vec<&str> = self.found.iter().map(|found| found.effect).collect();
        own.sort_unstable();
        if self.verdict == Verdict::CannotTell {
            return self.rivals(&own);
        }
        let other = |set: &&SetProbability| set.effects != own && set.probability > POSSIBLE;
        self.ranking.iter().filter(other).cloned().collect()
    }
}

/// Sets of a ranking that are not told apart from one of it.
pub(crate) fn rivals(ranking: &[SetProbability], own: &[&str]) -> Vec<SetProbability> {
    let probability = ranking.iter().find(|set| set.effects == own).map_or(0.0, |set| set.probability);
    let rival = |set: &&SetProbability| {
        !set.effects.is_empty() && !holds(&set.effects, own) && set.probability > RIVAL * probability
    };
    ranking.iter().filter(rival).cloned().collect()
}

/// Judges what the search found.
#[must_use]
pub fn decide(problem: &Problem, search: &Search, tolerance: &Tolerance) -> Decision {
    let sets = weigh(problem, search, tolerance);
    let probabilities = Probabilities::new(&sets);
    let limits = Limits::of(problem);
    let worthy = best(&sets, |set| set.nats - set.cost).map(|best| probabilities.fuller(&sets, best));
    let sure = worthy.is_some();
    let rather = || probabilities.rather_than_nothing(&sets).filter(|_| moves_freely(problem));
    let worthy = worthy.or_else(rather);
    let nominal = worthy.is_none().then(|| strangers(problem, &search.null));
    let shown = || {
        nominal.as_ref().is_some_and(|nominal| strongest(nominal) > limits.strange)
            || steps(problem, &search.null).is_some_and(|steps| steps.of_pickoff)
    };
    // a gap that torques of no effect show, or the pick-off's steps, is none that the effect has to show
    let likely = |set: &Weighed| if set.acts_on_float() { 0.0 } else { set.nats - set.rare };
    let best = worthy.or_else(|| best(&sets, likely).filter(|_| shown()));
    let best = best.map(|best| cleared(problem, search, &limits, best, &probabilities.no_less_likely(&sets, best)));
    let chosen = best.and_then(|set| set.fit);
    let before = left_over(problem, &search.null.residual);
    let after = chosen.map_or(before, |index| left_over(problem, &search.fits[index].residual));
    let fit = chosen.map_or(&search.null, |index| &search.fits[index]);
    let strangers = nominal.filter(|_| chosen.is_none()).unwrap_or_else(|| strangers(problem, fit));
    let strange = strongest(&strangers);
    let taken = 0.5 * (search.null.square + search.null.prior - fit.square - fit.prior);
    let found = chosen.is_some();
    let left =
        unknown(past(after, limits.left_over, limits.left_over_scale), after / before.max(after).max(1e-9), found);
    let share = strange / (strange + taken).max(1e-9);
    let unknown = left.max(unknown(strangeness(strange, limits.strange, limits.strange_scale), share, found));
    // what a quantised pick-off leaves is no reason to take back what brings all that a verdict asks for
    let steps = steps(problem, fit);
    let stepped = sure && unknown > UNEXPLAINED[1] && steps.is_some() && after < ROUGH;
    let unknown = if stepped { SHOWN } else { unknown };
    let hidden = best.map_or_else(Vec::new, |best| hidden_beside(problem, search, &sets, best));
    let told = [&sets[..], &hidden].concat();
    let mut decision = Decision {
        verdict: Verdict::NoGap,
        found: Vec::new(),
        ranking: Probabilities::new(&told).ranking(&told, 1.0 - unknown),
        alternatives: Vec::new(),
        unknown_probability: unknown,
        chosen,
        left_over: [before, after],
        strangers,
        strange_limit: limits.strange,
        notes: Vec::new(),
    };
    if let Some(best) = best {
        name(problem, fit, best, &mut decision);
        decision.verdict = if unknown > UNEXPLAINED[1] {
            decision.found.clear();
            decision.chosen = None;
            Verdict::Unexplained
        } else if !stepped && limits.are_passed(after, strange) {
            Verdict::PartlyExplained
        } else if decision.rivals(&best.effects).is_empty() {
            Verdict::Explained
        } else {
            Verdict::CannotTell
        };
    } else if unknown > UNEXPLAINED[0] {
        decision.verdict = Verdict::Unexplained;
    }
    decision.alternatives = decision.others();
    if let Some(stranger) = decision.goes_with() {
        decision.notes.push(format!("what is left goes with {stranger}"));
    }
    decision.notes.extend(like_a_bias(problem, &decision.found));
    let step_rad = steps.filter(|steps| steps.of_pickoff).map(|steps| steps.step_rad);
    direct(problem, step_rad, tolerance, &mut decision);
    decision
}

/// A set, or where it leaves what stands out the closest of a few fuller ones that leave nothing of it.
fn cleared<'a>(
    problem: &Problem,
    search: &Search,
    limits: &Limits,
    set: &'a Weighed,
    fuller: &[&'a Weighed],
) -> &'a Weighed {
    let fit = |set: &Weighed| set.fit.map(|index| &search.fits[index]);
    let leaves = |set: &Weighed| {
        fit(set).is_some_and(|fit| {
            limits.are_passed(left_over(problem, &fit.residual), strongest(&strangers(problem, fit)))
        })
    };
    if fuller.is_empty() || !leaves(set) || fit(set).is_some_and(|fit| steps(problem, fit).is_some()) {
        return set;
    }
    let mut fuller = fuller.to_vec();
    let cost = |set: &Weighed| fit(set).map_or(f64::INFINITY, Fit::cost);
    fuller.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    fuller.into_iter().take(FULLER).find(|set| !leaves(set)).unwrap_or(set)
}

/// A torque on the float turns the platform as an error of the logged rate seems to, `T / H`, where no reference sees it turn.
fn like_a_bias(problem: &Problem, found: &[Found]) -> Option<String> {
    if problem.record.channel(Signal::GimbalAngle).is_some() {
        return None;
    }
    let own = found.iter().find(|found| found.effect == "float_torque")?;
    let rate_radps = own.values[0] / problem.base.config.gyro.angular_momentum_nm_s;
    Some(format!(
        "a bias of the logged rate of {rate_radps:.1e} rad/s would look like this float_torque: check the rate at rest, or say in [tolerance] \
         how well it is known (`vehicle_rate_bias_radps`)"
    ))
}

/// What the likeliest of them takes beyond chance [nats].
fn strongest(strangers: &[Stranger]) -> f64 {
    strangers.first().map_or(0.0, Stranger::nats)
}

/// Fills in the effects of a set.
fn name(problem: &Problem, fit: &Fit, set: &Weighed, decision: &mut Decision) {
    let found = |(place, &index): (usize, &usize)| {
        let effect = problem.candidates[index].effect;
        let with = decision.ranking.iter().filter(|set| set.effects.contains(&effect));
        let probability = with.map(|set| set.probability).sum();
        Found { effect, probability, values: fit.values[place].clone(), errors: fit.errors[place].clone() }
    };
    debug_assert_eq!(set.effects.len(), fit.set.0.len());
    decision.found = fit.set.0.iter().enumerate().map(found).collect();
}

/// How probable it is that no effect of the library is it: from how probable what is left makes it, and from the share of
/// that in the gap, as a large effect in another formulation leaves something too.
pub(crate) fn unknown(shown: f64, share: f64, found: bool) -> f64 {
    let share = if found { share } else { 1.0 };
    (shown * share / (share + FORMULATION_LEAVES) * (1.0 + FORMULATION_LEAVES)).clamp(UNSEEN, SUREST)
}

/// How probable it is that a value stands out beyond a limit that is known to so much.
pub(crate) fn past(value: f64, limit: f64, scale: f64) -> f64 {
    1.0 / (1.0 + (-(value - limit) / scale).exp())
}

/// How probable what torques of no effect take makes something unknown [nats]: what is not enough to be told is more than
/// nothing.
pub(crate) fn strangeness(nats: f64, limit: f64, scale: f64) -> f64 {
    let odds = ODDS_AT_LIMIT * (nats / limit).max(0.0).powf(ODDS_POWER);
    past(nats, limit, scale).max((odds / (1.0 + odds)).min(BELOW_LIMIT))
}

/// What the samples show by themselves: a stop elsewhere, as the pick-off reads it, and a grid of angles. `is_rest` says whether
/// that may be what is left unexplained.
fn direct(problem: &Problem, step_rad: Option<f64>, tolerance: &Tolerance, decision: &mut Decision) {
    let scale = |found: &Found| if found.effect == "pickoff_scale" { found.values[0] } else { 0.0 };
    let pickoff = 1.0 + decision.found.iter().map(scale).sum::<f64>();
    let strange = decision.goes_with().is_some();
    let mut add = |effect: &'static str, value: f64, error: f64, probability: f64, is_rest: bool| {
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
            || decision.verdict == Verdict::Unexplained && is_rest && decision.left_over[1] < ROUGH
        {
            decision.verdict = Verdict::Explained;
            let sure = 1.0 - decision.unknown_probability;
            decision.unknown_probability = decision.unknown_probability.min(SHOWN);
            for set in decision.ranking.iter_mut().chain(&mut decision.alternatives) {
                set.probability *= (1.0 - decision.unknown_probability) / sure;
            }
        } else if decision.verdict == Verdict::Unexplained {
            decision.verdict = Verdict::PartlyExplained;
        }
    };
    if let Some((change, error)) = stop_change(problem, pickoff, tolerance) {
        add("stop_angle", change, error, 0.95, !strange);
    }
    if let Some(step_rad) = step_rad {
        // where a row is rounded to nobody knows, so that what it leaves may go with anything
        add("pickoff_quantisation", step_rad, 1e-3 * step_rad, 0.97, true);
    }
}
