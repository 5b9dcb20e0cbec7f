//! All counts over a corpus.

use std::collections::BTreeMap;

use serde::Serialize;

use super::calibration::{Calibration, calibration, weighted_error};
use super::coverage::{coverage, shrink};
use super::gates::{Gate, gates};
use super::held_out::{HeldOut, held_out};
use super::judge::{Judged, below_detectable};
use super::rate::Rate;
use super::report::Verdict;
use super::unknown::unknown_curve;
use crate::corpus::Kind;

/// Floor of a probability in the log score.
const LOG_FLOOR: f64 = 1e-4;

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
    /// The likeliest name is right, logs that the gates count.
    pub gate_top1: Rate,
    /// The verdict as a whole is right, logs that the gates count.
    pub gate_right: Rate,
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
    /// Figures that have a gate.
    pub gates: Vec<Gate>,
    /// Recalibrations with one family left out.
    pub held_out: Vec<HeldOut>,
    /// False alarms on logs with nothing.
    pub false_alarms: Rate,
    /// By kind, by effect, by excitation, by size, by motion quality.
    pub by_kind: Vec<Group>,
    /// By effect: logs with one effect, or beyond the table.
    pub by_effect: Vec<Group>,
    /// By excitation, and those whose servo takes the pick-off's noise for motion.
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
        if one.in_gates() {
            group.gate_right.add(one.right);
        }
        if !matches!(one.answer.kind, Kind::Nothing | Kind::Beyond) {
            group.top1.add(one.top1);
            group.top3.add(one.top3);
            group.exact.add(one.exact);
            if one.in_gates() {
                group.gate_top1.add(one.top1);
            }
        }
    }
    group.on_truth = if group.right.of > 0 { sum / group.right.of as f64 } else { 0.0 };
    group
}

fn is(kind: Kind) -> impl Fn(&&Judged) -> bool {
    move |one| one.answer.kind == kind
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
    for (kind, wanted) in Kind::ALL.into_iter().zip(percent) {
        let members: Vec<&&Judged> = all.iter().filter(|one| one.answer.kind == kind).collect();
        if members.is_empty() {
            continue;
        }
        let share = members.iter().filter(|one| one.right).count() as f64 / members.len() as f64;
        right += wanted as f64 * share;
        weight += wanted as f64;
        let each = wanted as f64 / members.len() as f64;
        pairs.extend(members.iter().map(|one| (one.confidence, one.right, each)));
    }
    (percent, if weight > 0.0 { right / weight } else { 0.0 }, weighted_error(pairs))
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
        let (shrink_coverage, closed) = shrink(&counted);
        let cannot = || all.iter().filter(|one| one.report.as_ref().is_some_and(|r| r.verdict == Verdict::CannotTell));
        let logs = all.len().max(1) as f64;
        let mut score = Self {
            logs: all.len(),
            failed: all.iter().filter(|one| one.report.is_none()).count(),
            gates: Vec::new(),
            held_out: Vec::new(),
            false_alarms: Rate::over(all.iter().copied().filter(is(Kind::Nothing)), |one| one.detected),
            by_kind: Kind::ALL.iter().map(|kind| group(kind.name(), all.iter().copied().filter(is(*kind)))).collect(),
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
                .chain([group("noise in the loop", all.iter().copied().filter(|one| one.answer.noise.in_loop))])
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
            median_closed: closed.get(closed.len() / 2).copied(),
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
        score.gates = gates(&all);
        score.held_out = held_out(&all);
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
