//! All counts over a corpus.

use std::collections::BTreeMap;

use serde::Serialize;

use super::calibration::{Calibration, calibration};
use super::judge::{Judged, below_detectable};
use super::rate::Rate;
use super::report::Verdict;
use crate::corpus::Kind;

/// Floor of a probability in the log score.
const LOG_FLOOR: f64 = 1e-4;
/// Share of known cases that may be called unknown.
const FALSE_UNKNOWN: f64 = 0.05;
/// Two-sided 95 % of the normal distribution, in standard deviations.
const SIGMAS: f64 = 1.96;

/// One rate with what it says and, where there is one, its gate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gate {
    /// What is counted.
    pub what: String,
    /// The rate.
    pub rate: Rate,
    /// Its Wilson interval.
    pub interval: (f64, f64),
    /// Least share, or largest if `at_most`.
    pub limit: f64,
    /// The limit is a largest share.
    pub at_most: bool,
    /// Whether the rate keeps the limit.
    pub kept: bool,
}

/// Counts for one group of logs.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Group {
    /// Group.
    pub name: String,
    /// A gap was reported.
    pub detected: Rate,
    /// The likeliest name is right.
    pub top1: Rate,
    /// One of the three likeliest is right.
    pub top3: Rate,
    /// The set is right.
    pub exact: Rate,
    /// The verdict as a whole is right.
    pub right: Rate,
    /// Mean probability on the truth.
    pub on_truth: f64,
}

/// The score of one diagnosis of one corpus.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Score {
    /// Number of logs.
    pub logs: usize,
    /// Logs for which the diagnosis failed.
    pub failed: usize,
    /// Rates that have a gate.
    pub gates: Vec<Gate>,
    /// False alarms on logs with nothing.
    pub false_alarms: Rate,
    /// By kind, by effect, by excitation, by size, by motion quality.
    pub by_kind: Vec<Group>,
    /// By effect: logs with one effect, or beyond the table.
    pub by_effect: Vec<Group>,
    /// By excitation.
    pub by_excitation: Vec<Group>,
    /// By size over the detectable one; logs with one effect.
    pub by_size: Vec<Group>,
    /// Truth, likeliest name, count.
    pub confusion: Vec<(String, String, usize)>,
    /// Mean probability on the truth, logs that the gates count.
    pub mean_on_truth: f64,
    /// Mean of -ln(probability on the truth).
    pub log_score: f64,
    /// Verdicts: confidence against right.
    pub verdicts: Calibration,
    /// Effects: probability against accepted.
    pub effects: Calibration,
    /// Parameters whose 95 % interval holds the truth; correctly named effects.
    pub parameter_coverage: Rate,
    /// The same by effect.
    pub coverage_by_effect: Vec<(String, Rate)>,
    /// Shrink intervals that hold the best possible; exactly named logs.
    pub shrink_coverage: Rate,
    /// Median share of the closable gap that was closed.
    pub median_closed: Option<f64>,
    /// Unknown effects flagged by the report itself.
    pub unknown_flagged: Rate,
    /// Other logs flagged by the report itself.
    pub unknown_false: Rate,
    /// Unknown effects flagged at the threshold that calls 5 % of the others unknown.
    pub unknown_at_5_percent: Rate,
    /// Probability that an unknown effect ranks above another one.
    pub unknown_auroc: Option<f64>,
    /// `cannot_tell` with the truth in its class.
    pub cannot_tell_holds_truth: Rate,
    /// `cannot_tell` where the forge, too, finds effects that cannot be told apart.
    pub cannot_tell_fair: Rate,
    /// Verdicts right at other mixtures (nothing, one, two, three, beyond in percent).
    pub mixtures: Vec<([usize; 5], f64, f64)>,
    /// Mean and largest time of a diagnosis [s].
    pub seconds: (f64, f64),
}

fn group<'a>(name: impl Into<String>, members: impl Iterator<Item = &'a Judged>) -> Group {
    let mut group = Group { name: name.into(), ..Group::default() };
    let mut sum = 0.0;
    for one in members {
        group.detected.add(one.detected);
        group.right.add(one.right);
        sum += one.on_truth;
        if !matches!(one.answer.kind, Kind::Nothing | Kind::Beyond) {
            group.top1.add(one.top1);
            group.top3.add(one.top3);
            group.exact.add(one.exact);
        }
    }
    group.on_truth = if group.right.of > 0 { sum / group.right.of as f64 } else { 0.0 };
    group
}

fn gate(what: &str, rate: Rate, limit: f64, at_most: bool) -> Gate {
    let share = rate.share();
    let kept = share.is_some_and(|share| if at_most { share <= limit } else { share >= limit });
    Gate { what: what.to_owned(), rate, interval: rate.wilson(), limit, at_most, kept }
}

fn is(kind: Kind) -> impl Fn(&&Judged) -> bool {
    move |one| one.answer.kind == kind
}

fn unknown_p(one: &Judged) -> f64 {
    one.report.as_ref().map_or(0.0, |report| {
        // a gap without an effect for it is a claim of the unknown
        if report.verdict == Verdict::Unexplained {
            report.unknown_probability.max(0.5)
        } else {
            report.unknown_probability
        }
    })
}

/// Share of unknown cases above the threshold that the given share of the others exceeds, and the area under the curve.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a place in a list
fn unknown_curve(all: &[&Judged]) -> (Rate, Option<f64>) {
    let of = |beyond: bool| -> Vec<f64> {
        all.iter().filter(|one| (one.answer.kind == Kind::Beyond) == beyond).map(|one| unknown_p(one)).collect()
    };
    let (unknown, mut known) = (of(true), of(false));
    if unknown.is_empty() || known.is_empty() {
        return (Rate::default(), None);
    }
    known.sort_by(|a, b| b.total_cmp(a));
    let allowed = (FALSE_UNKNOWN * known.len() as f64) as usize;
    let threshold = known[allowed.min(known.len() - 1)];
    let rate = Rate::over(&unknown, |p| **p > threshold);
    let wins: f64 = unknown
        .iter()
        .map(|p| {
            known
                .iter()
                .map(|q| {
                    if p > q {
                        1.0
                    } else if p.to_bits() == q.to_bits() {
                        0.5
                    } else {
                        0.0
                    }
                })
                .sum::<f64>()
        })
        .sum();
    (rate, Some(wins / (unknown.len() * known.len()) as f64))
}

fn coverage(all: &[&Judged]) -> (Rate, Vec<(String, Rate)>) {
    let mut by_effect: BTreeMap<String, Rate> = BTreeMap::new();
    for one in all {
        let Some(report) = &one.report else { continue };
        for effect in &one.answer.effects {
            let Some(found) = report.effects.iter().find(|found| found.name == effect.name) else { continue };
            // phases turn round, and sizes beyond the table have no counterpart
            let pairs = effect.parameters.iter().zip(&found.parameters).filter(|(truth, _)| truth.name != "phase");
            for (truth, said) in pairs {
                if let Some(std) = said.std {
                    by_effect
                        .entry(effect.name.clone())
                        .or_default()
                        .add((said.value - truth.value).abs() <= SIGMAS * std);
                }
            }
        }
    }
    let mut total = Rate::default();
    for rate in by_effect.values() {
        total.hits += rate.hits;
        total.of += rate.of;
    }
    (total, by_effect.into_iter().collect())
}

/// Shrink intervals that hold what the true model closes, and the shares of the closable gap that were closed.
fn shrink(all: &[&Judged]) -> (Rate, Option<f64>) {
    let (mut held, mut closed) = (Rate::default(), Vec::new());
    for one in all {
        let Some(shrink) = one.report.as_ref().and_then(|report| report.shrink.as_ref()) else { continue };
        for said in &shrink.signals {
            let Some(truth) = one.answer.signals.iter().find(|truth| truth.name == said.name) else { continue };
            let (Some(before), Some(after)) = (said.before, said.after) else { continue };
            let closable = before * before - truth.best * truth.best;
            // a gap below a tenth of the floor's power cannot be measured
            if closable > 0.1 * truth.best * truth.best {
                closed.push((before * before - after * after) / closable);
            }
            if let (true, Some([low, high]), Some(floor)) = (one.exact, said.ci95_percent, said.noise_floor) {
                let span = before * before - floor * floor;
                if span > 0.0 {
                    let best = 100.0 * (before * before - truth.best * truth.best) / span;
                    held.add((low..=high).contains(&best));
                }
            }
        }
    }
    closed.sort_by(f64::total_cmp);
    (held, closed.get(closed.len() / 2).copied())
}

fn sizes(all: &[&Judged]) -> Vec<Group> {
    [(0.0, 1.0), (1.0, 2.0), (2.0, 3.0), (3.0, 5.0), (5.0, f64::INFINITY)]
        .iter()
        .map(|(from, to)| {
            let inside =
                all.iter().copied().filter(is(Kind::One)).filter(|one| {
                    one.answer.effects.first().is_some_and(|effect| (*from..*to).contains(&effect.multiple))
                });
            let name = if to.is_finite() { format!("{from} to {to}") } else { format!("{from} and more") };
            group(name, inside)
        })
        .collect()
}

/// Verdicts right and calibration error at another mixture of kinds, by weighing.
fn mixture(all: &[&Judged], percent: [usize; 5]) -> ([usize; 5], f64, f64) {
    let (mut right, mut weight) = (0.0, 0.0);
    let mut pairs = Vec::new();
    for ((kind, own), wanted) in Kind::SHARES.iter().zip(percent) {
        let members: Vec<&&Judged> = all.iter().filter(|one| one.answer.kind == *kind).collect();
        if members.is_empty() {
            continue;
        }
        let share = members.iter().filter(|one| one.right).count() as f64 / members.len() as f64;
        right += wanted as f64 * share;
        weight += wanted as f64;
        // whole repeats keep the calibration's arithmetic: twenty times the ratio of the shares
        let repeats = (20 * wanted).div_ceil(*own).max(1);
        for one in members {
            pairs.extend(std::iter::repeat_n((one.confidence, one.right), repeats));
        }
    }
    (percent, if weight > 0.0 { right / weight } else { 0.0 }, calibration_error_only(pairs))
}

fn calibration_error_only(mut pairs: Vec<(f64, bool)>) -> f64 {
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    super::calibration::error(&pairs)
}

fn gates(all: &[&Judged], score: &Score) -> Vec<Gate> {
    let counted: Vec<&Judged> = all.iter().copied().filter(|one| one.in_gates()).collect();
    let of = |kind: Kind| counted.iter().copied().filter(is(kind));
    let known = |hit: &dyn Fn(&Judged) -> bool| {
        Rate::over(counted.iter().filter(|one| !matches!(one.answer.kind, Kind::Nothing | Kind::Beyond)), |one| {
            hit(one)
        })
    };
    vec![
        gate(
            "top-1, one effect of at least twice the detectable size",
            Rate::over(of(Kind::One), |one| one.top1),
            0.95,
            false,
        ),
        gate("top-3, the same logs", Rate::over(of(Kind::One), |one| one.top3), 0.99, false),
        gate("detected, all known effects that count", known(&|one| one.detected), 0.99, false),
        gate(
            "two effects exactly named, each at least three times",
            Rate::over(of(Kind::Two), |one| one.exact),
            0.80,
            false,
        ),
        gate("false alarms on logs with nothing", score.false_alarms, 1.0 / 600.0, true),
        gate("unknown flagged", Rate::over(of(Kind::Beyond), |one| one.flagged_unknown), 0.90, false),
        gate("false unknown, logs without one", score.unknown_false, 0.05, true),
        gate("95 % intervals of parameters that hold the truth", score.parameter_coverage, 0.92, false),
    ]
}

impl Score {
    /// Counts a corpus.
    #[must_use]
    pub fn of(judged: &[Judged]) -> Self {
        let all: Vec<&Judged> = judged.iter().collect();
        let names = |of: &dyn Fn(&Judged) -> Option<String>| {
            let mut names: Vec<String> = judged.iter().filter_map(of).collect();
            names.sort();
            names.dedup();
            names
        };
        let effect_of = |one: &Judged| match one.answer.kind {
            Kind::One | Kind::Beyond => one.answer.effects.first().map(|effect| effect.name.clone()),
            _ => None,
        };
        let mut confusion: BTreeMap<(String, String), usize> = BTreeMap::new();
        for one in all.iter().filter(|one| matches!(one.answer.kind, Kind::Nothing | Kind::One | Kind::Beyond)) {
            if !(one.answer.kind == Kind::One && below_detectable(&one.answer)) {
                *confusion.entry((one.truth_name().to_owned(), one.named())).or_default() += 1;
            }
        }
        let counted: Vec<&Judged> =
            all.iter().copied().filter(|one| one.in_gates() && one.answer.kind == Kind::One).collect();
        let (unknown_at_5_percent, unknown_auroc) = unknown_curve(&all);
        let (parameter_coverage, coverage_by_effect) = coverage(&all);
        let (shrink_coverage, median_closed) = shrink(&counted);
        let cannot = || all.iter().filter(|one| one.report.as_ref().is_some_and(|r| r.verdict == Verdict::CannotTell));
        let logs = all.len().max(1) as f64;
        let mut score = Self {
            logs: all.len(),
            failed: all.iter().filter(|one| one.report.is_none()).count(),
            gates: Vec::new(),
            false_alarms: Rate::over(all.iter().copied().filter(is(Kind::Nothing)), |one| one.detected),
            by_kind: Kind::SHARES
                .iter()
                .map(|(kind, _)| group(kind.name(), all.iter().copied().filter(is(*kind))))
                .collect(),
            by_effect: names(&effect_of)
                .into_iter()
                .map(|name| {
                    let members: Vec<&Judged> =
                        all.iter().copied().filter(|one| effect_of(one).as_ref() == Some(&name)).collect();
                    group(name, members.into_iter())
                })
                .collect(),
            by_excitation: crate::excitation::Excitation::ALL
                .iter()
                .map(|kind| group(kind.name(), all.iter().copied().filter(|one| one.answer.excitation == *kind)))
                .collect(),
            by_size: sizes(&all),
            confusion: confusion.into_iter().map(|((truth, named), count)| (truth, named, count)).collect(),
            mean_on_truth: counted.iter().map(|one| one.on_truth).sum::<f64>() / counted.len().max(1) as f64,
            log_score: all.iter().map(|one| -one.on_truth.max(LOG_FLOOR).ln()).sum::<f64>() / logs,
            verdicts: calibration(all.iter().map(|one| (one.confidence, one.right)).collect()),
            effects: calibration(effect_pairs(&all)),
            parameter_coverage,
            coverage_by_effect,
            shrink_coverage,
            median_closed,
            unknown_flagged: Rate::over(all.iter().copied().filter(is(Kind::Beyond)), |one| one.flagged_unknown),
            unknown_false: Rate::over(all.iter().filter(|one| one.answer.kind != Kind::Beyond), |one| {
                one.flagged_unknown
            }),
            unknown_at_5_percent,
            unknown_auroc,
            cannot_tell_holds_truth: Rate::over(cannot(), |one| one.right),
            cannot_tell_fair: Rate::over(cannot(), |one| {
                one.answer.effects.iter().any(|effect| !effect.equivalents.is_empty()) || below_detectable(&one.answer)
            }),
            mixtures: [[50, 25, 10, 5, 10], [5, 45, 30, 10, 10]].map(|percent| mixture(&all, percent)).to_vec(),
            seconds: (
                all.iter().map(|one| one.seconds).sum::<f64>() / logs,
                all.iter().map(|one| one.seconds).fold(0.0, f64::max),
            ),
        };
        score.gates = gates(&all, &score);
        score
    }
}

/// Each reported effect: its probability, and whether it is accepted.
fn effect_pairs(all: &[&Judged]) -> Vec<(f64, bool)> {
    let mut pairs = Vec::new();
    for one in all {
        for said in one.report.iter().flat_map(|report| &report.effects) {
            let right = one
                .answer
                .effects
                .iter()
                .any(|effect| effect.name == said.name || effect.equivalents.contains(&said.name));
            pairs.push((said.probability, right));
        }
    }
    pairs
}
