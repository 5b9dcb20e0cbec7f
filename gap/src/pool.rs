//! Several logs of one platform: one verdict, what stays the same from run to run, and how far the correction goes on a
//! log that it was not made from.
//!
//! ```text
//! p(set)   ~ product over the logs of p_log(set), none below 1e-4           a log that did not look at a set does not veto it
//! mean     = sum w v / sum w     w = 1 / se^2     chi2 = sum w (v - mean)^2     drifts: beyond 99 % of chi2 with n - 1
//! unseen   rms of a log under the model corrected from all the others, predicted free from its first row
//! floor    rms of half the difference of two logs under equal inputs, times sqrt 2
//! ```

use std::collections::BTreeMap;

use gimbal_model_file::{ModelEffect, ModelFile, effects};
use gimbal_plant::Effect;
use serde_json::{Value, json};

use crate::diagnose::Diagnosis;
use crate::fit::raw_residual;
use crate::judge::{Verdict, Yardstick, holds, in_step};
use crate::library::{nuisances, platform, releases};
use crate::place::erfc;
use crate::simulate::{Physics, predict};

/// Least probability that one log counts with.
const LEAST: f64 = 1e-4;
/// A set this many times as probable as any other is the explanation.
const CLEAR: f64 = 10.0;
/// Probability of a scatter by chance below which a parameter drifts.
const BY_CHANCE: f64 = 0.01;
/// Inputs are equal when their difference is this share of their change.
const EQUAL: f64 = 0.05;
/// A set of effects and its probability over all logs.
#[derive(Debug, Clone, PartialEq)]
pub struct PooledSet {
    /// Names; none is the nominal model.
    pub effects: Vec<&'static str>,
    /// Over all logs.
    pub probability: f64,
}

/// A parameter over the logs.
#[derive(Debug, Clone, PartialEq)]
pub struct Shared {
    /// Effect.
    pub effect: &'static str,
    /// Parameter.
    pub parameter: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Log, value and standard error where the effect was fitted.
    pub values: Vec<(usize, f64, f64)>,
    /// Weighted mean and its standard error.
    pub mean: [f64; 2],
    /// Sum of squares over the errors.
    pub chi2: f64,
    /// How probable such a scatter is by chance.
    pub by_chance: f64,
}

impl Shared {
    /// Whether it drifts from run to run.
    #[must_use]
    pub fn drifts(&self) -> bool {
        self.by_chance < BY_CHANCE
    }
}

/// Two runs under equal inputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeat {
    /// Both logs.
    pub logs: [usize; 2],
    /// Signal, unit, rms of what is one run's own.
    pub floors: Vec<(&'static str, &'static str, f64)>,
}

/// All logs together.
#[derive(Debug, Clone)]
pub struct Pool {
    /// Logs that serve.
    pub logs: Vec<usize>,
    /// Verdict over them.
    pub verdict: Verdict,
    /// Sets, the most probable first.
    pub sets: Vec<PooledSet>,
    /// That none of them is it.
    pub unknown_probability: f64,
    /// Parameters of the best set.
    pub shared: Vec<Shared>,
    /// Each log under the model corrected from the others.
    pub unseen: Vec<(usize, Vec<Yardstick>)>,
    /// Pairs of logs under equal inputs.
    pub repeats: Vec<Repeat>,
}

/// Takes diagnoses of several logs together.
#[must_use]
pub fn pool(diagnoses: &[Diagnosis], model: &ModelFile) -> Pool {
    let logs: Vec<usize> = (0..diagnoses.len()).filter(|&log| diagnoses[log].decision.is_some()).collect();
    let (sets, unknown_probability) = sets(diagnoses, &logs);
    let best = sets.first().map(|set| set.effects.clone()).unwrap_or_default();
    let verdict = verdict(diagnoses, &logs, &sets, unknown_probability);
    let shared = best.iter().flat_map(|effect| shared(diagnoses, &logs, effect)).collect();
    let unseen = if best.is_empty() || logs.len() < 2 {
        Vec::new()
    } else {
        logs.iter().map(|&log| (log, score(diagnoses, &logs, log, &best, model))).collect()
    };
    let repeats = pairs(&logs).filter_map(|(a, b)| repeat(a, b, diagnoses)).collect();
    Pool { logs, verdict, sets, unknown_probability, shared, unseen, repeats }
}

fn sets(diagnoses: &[Diagnosis], logs: &[usize]) -> (Vec<PooledSet>, f64) {
    let mut sums: BTreeMap<Vec<&'static str>, f64> = BTreeMap::new();
    let decisions = || logs.iter().filter_map(|&log| diagnoses[log].decision.as_ref());
    for set in decisions().flat_map(|decision| &decision.ranking) {
        sums.entry(set.effects.clone()).or_default();
    }
    let mut unknown = 0.0;
    for decision in decisions() {
        unknown += decision.unknown_probability.max(LEAST).ln();
        for (effects, sum) in &mut sums {
            let own: f64 =
                decision.ranking.iter().filter(|set| set.effects == *effects).map(|set| set.probability).sum();
            *sum += own.max(LEAST).ln();
        }
    }
    let top = sums.values().copied().fold(unknown, f64::max);
    let all: f64 = sums.values().map(|sum| (sum - top).exp()).sum::<f64>() + (unknown - top).exp();
    let mut sets: Vec<PooledSet> =
        sums.into_iter().map(|(effects, sum)| PooledSet { effects, probability: (sum - top).exp() / all }).collect();
    sets.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    (sets, (unknown - top).exp() / all)
}

fn verdict(diagnoses: &[Diagnosis], logs: &[usize], sets: &[PooledSet], unknown: f64) -> Verdict {
    let Some(best) = sets.first() else { return Verdict::CannotTell };
    // a set that holds the best one and more is no rival
    let rival = |set: &&PooledSet| best.effects.is_empty() || !holds(&set.effects, &best.effects);
    let second = sets.iter().skip(1).find(rival).map_or(0.0, |set| set.probability);
    let is = |verdict| logs.iter().any(|&log| diagnoses[log].verdict() == verdict);
    if unknown > best.probability {
        Verdict::Unexplained
    } else if best.effects.is_empty() {
        Verdict::NoGap
    } else if best.probability < CLEAR * second {
        Verdict::CannotTell
    } else if is(Verdict::PartlyExplained) || is(Verdict::Unexplained) {
        Verdict::PartlyExplained
    } else {
        Verdict::Explained
    }
}

/// The parameters of an effect over the logs in which it was found.
fn shared(diagnoses: &[Diagnosis], logs: &[usize], effect: &'static str) -> Vec<Shared> {
    let Some(entry) = Effect::from_name(effect) else { return Vec::new() };
    let found = |log: usize| diagnoses[log].decision.iter().flat_map(|own| &own.found).find(|own| own.effect == effect);
    let parameters = entry.parameters().iter().enumerate();
    parameters
        .map(|(place, parameter)| {
            let values: Vec<(usize, f64, f64)> = logs
                .iter()
                .filter_map(|&log| found(log).map(|own| (log, own.values[place], own.errors[place])))
                .filter(|(_, _, error)| *error > 0.0)
                .collect();
            let weights: f64 = values.iter().map(|(_, _, error)| error.powi(-2)).sum();
            let mean = values.iter().map(|(_, value, error)| value * error.powi(-2)).sum::<f64>() / weights.max(1e-300);
            let chi2 = values.iter().map(|(_, value, error)| ((value - mean) / error).powi(2)).sum();
            let by_chance = chance(chi2, values.len().saturating_sub(1));
            let (parameter, unit) = (parameter.name, parameter.unit);
            Shared { effect, parameter, unit, values, mean: [mean, weights.max(1e-300).powf(-0.5)], chi2, by_chance }
        })
        .collect()
}

/// Probability of a larger chi-square by chance: Wilson and Hilferty's cube root.
fn chance(chi2: f64, freedom: usize) -> f64 {
    if freedom == 0 {
        return 1.0;
    }
    let n = freedom as f64;
    let spread = 2.0 / (9.0 * n);
    let z = ((chi2 / n).cbrt() - (1.0 - spread)) / spread.sqrt();
    0.5 * erfc(z / std::f64::consts::SQRT_2)
}

/// A log under the nominal model and under what the others say.
fn score(
    diagnoses: &[Diagnosis],
    logs: &[usize],
    unseen: usize,
    best: &[&'static str],
    model: &ModelFile,
) -> Vec<Yardstick> {
    let others: Vec<usize> = logs.iter().copied().filter(|&log| log != unseen).collect();
    let record = &diagnoses[unseen].record;
    let rms = |physics: &Physics| {
        let mut physics = physics.clone();
        physics.config.period_s = record.inputs.period_s;
        let begin = record.begin(&physics, &record.inputs);
        in_step(record, &raw_residual(record, &predict(&physics, &record.inputs, &begin, usize::MAX)))
    };
    let (before, after) = (rms(&platform(model)), rms(&of_others(diagnoses, &others, best, model)));
    Yardstick::of_channels(record, &before, &after)
}

/// The platform with the mean of what the fits of some logs say.
fn of_others(diagnoses: &[Diagnosis], logs: &[usize], best: &[&'static str], model: &ModelFile) -> Physics {
    let mut physics = platform(model);
    let parameters = nuisances(&model.tolerance, &physics);
    let fits: Vec<_> = logs.iter().filter_map(|&log| diagnoses[log].fit.as_ref()).collect();
    for (place, parameter) in parameters.iter().enumerate() {
        let sum: f64 = fits.iter().filter_map(|fit| fit.shifts.get(place)).sum();
        parameter.shift(&mut physics, sum / fits.len().max(1) as f64);
    }
    for effect in best.iter().filter(|effect| releases(effect).is_empty()) {
        let values: Vec<f64> = shared(diagnoses, logs, effect).iter().map(|own| own.mean[0]).collect();
        if let Some(entry) = Effect::from_name(effect).filter(|_| values.iter().all(|value| value.is_finite())) {
            let mut config = physics.config;
            if effects::fold(entry, &values, &mut config) {
                physics.config = config;
            } else {
                let entry = ModelEffect { effect: entry, values };
                crate::library::apply(effect, &entry.values, &mut physics);
            }
        }
    }
    physics
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

fn pairs(logs: &[usize]) -> impl Iterator<Item = (usize, usize)> {
    logs.iter().enumerate().flat_map(move |(place, &a)| logs[place + 1..].iter().map(move |&b| (a, b)))
}

/// What two runs under equal inputs have differently.
fn repeat(a: usize, b: usize, diagnoses: &[Diagnosis]) -> Option<Repeat> {
    let (one, other) = (&diagnoses[a].record, &diagnoses[b].record);
    let rows = one.rows();
    if rows != other.rows() {
        return None;
    }
    let equal = |x: &[f64], y: &[f64]| {
        let level = mean(x.iter().copied());
        let change = mean(x.iter().map(|value| (value - level).powi(2)));
        let off = mean(x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).collect::<Vec<_>>().into_iter());
        off <= EQUAL * EQUAL * change.max(1e-12)
    };
    let same = equal(&one.inputs.rate_radps, &other.inputs.rate_radps)
        && (0..2).all(|axis| equal(&one.inputs.accel_mps2[axis], &other.inputs.accel_mps2[axis]));
    if !same {
        return None;
    }
    let floors = one.channels.iter().filter_map(|channel| {
        let twin = other.channel(channel.signal)?;
        let valid = (0..rows).filter(|&k| channel.valid[k] && twin.valid[k]);
        let half: Vec<f64> = valid.map(|k| 0.5 * (channel.values[k] - twin.values[k])).collect();
        let column = channel.signal.column();
        let rms = (2.0 * mean(half.iter().map(|value| value * value))).sqrt();
        Some((column.name(), column.unit(), rms))
    });
    Some(Repeat { logs: [a, b], floors: floors.collect() })
}

impl Pool {
    /// For programs; `names` are those of the logs.
    #[must_use]
    pub fn json(&self, names: &[String]) -> Value {
        json!({
            "verdict": self.verdict.name(),
            "logs": self.logs.iter().map(|&log| &names[log]).collect::<Vec<_>>(),
            "sets": self.sets.iter().take(12).map(|set| json!({
                "effects": set.effects, "probability": set.probability
            })).collect::<Vec<_>>(),
            "unknown_probability": self.unknown_probability,
            "parameters": self.shared.iter().map(|own| json!({
                "effect": own.effect, "name": own.parameter, "unit": own.unit,
                "value": own.mean[0], "std": own.mean[1], "chi2": own.chi2,
                "probability_by_chance": own.by_chance, "drifts": own.drifts(),
                "logs": own.values.iter().map(|(log, value, std)| json!({
                    "log": names[*log], "value": value, "std": std
                })).collect::<Vec<_>>(),
            })).collect::<Vec<_>>(),
            "unseen": self.unseen.iter().map(|(log, signals)| json!({
                "log": names[*log],
                "signals": signals.iter().map(Yardstick::json).collect::<Vec<_>>(),
            })).collect::<Vec<_>>(),
            "repeats": self.repeats.iter().map(|own| json!({
                "logs": own.logs.map(|log| &names[log]),
                "noise_floor": own.floors.iter().map(|(name, unit, rms)| json!({
                    "name": name, "unit": unit, "rms": rms
                })).collect::<Vec<_>>(),
            })).collect::<Vec<_>>(),
        })
    }

    /// For people; `names` are those of the logs.
    #[must_use]
    pub fn text(&self, names: &[String]) -> String {
        let set =
            |effects: &[&str]| if effects.is_empty() { "the nominal model".to_owned() } else { effects.join(" + ") };
        let best = self.sets.first().map(|best| set(&best.effects)).unwrap_or_default();
        let probability = self.sets.first().map_or(0.0, |best| 100.0 * best.probability);
        let mut lines = vec![match self.verdict {
            Verdict::NoGap => format!("All {} logs together: no gap.", self.logs.len()),
            Verdict::Unexplained => format!("All {} logs together: a gap that no effect explains.", self.logs.len()),
            Verdict::CannotTell => {
                let others: Vec<String> = self.sets.iter().take(3).map(|own| set(&own.effects)).collect();
                format!("All {} logs together: cannot tell: {}.", self.logs.len(), others.join(", or "))
            }
            verdict => {
                let how = if verdict == Verdict::Explained { "explained" } else { "partly explained" };
                format!("All {} logs together: {how} by {best} ({probability:.0} %).", self.logs.len())
            }
        }];
        for own in &self.shared {
            let same = match (own.values.len(), own.drifts()) {
                (0 | 1, _) => "found in one log".to_owned(),
                (count, false) => format!("the same in {count} logs"),
                (count, true) => format!("drifts from run to run over {count} logs"),
            };
            lines.push(format!(
                "  {} {}: {:.3e} +- {:.0e} {}, {same} (chi2 {:.1}, {:.1} % by chance)",
                own.effect,
                own.parameter,
                own.mean[0],
                own.mean[1],
                own.unit,
                own.chi2,
                100.0 * own.by_chance
            ));
        }
        for (log, signals) in &self.unseen {
            let told: Vec<String> = signals
                .iter()
                .map(|own| format!("{} {:.2e} to {:.2e} {}", own.name, own.before, own.after, own.unit))
                .collect();
            lines.push(format!("  {}, under the model corrected from the others: {}", names[*log], told.join(", ")));
        }
        for Repeat { logs: [a, b], floors } in &self.repeats {
            let told: Vec<String> = floors.iter().map(|(name, unit, rms)| format!("{name} {rms:.2e} {unit}")).collect();
            lines.push(format!("  {} repeats {}; one run's own: {}", names[*b], names[*a], told.join(", ")));
        }
        lines.join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::chance;

    #[test]
    fn closed_form_tails_of_chi_square_are_those_of_tables() {
        // 95 % and 99 % points of 1, 4 and 10 degrees of freedom; the cube root is good to a tenth of the tail.
        for (chi2, freedom, tail) in [(3.841, 1, 0.05), (9.488, 4, 0.05), (18.307, 10, 0.05), (13.277, 4, 0.01)] {
            let found = chance(chi2, freedom);
            assert!((found / tail - 1.0).abs() < 0.12, "{chi2} of {freedom}: {found}");
        }
        assert!((chance(5.0, 0) - 1.0).abs() < 1e-12);
    }
}
