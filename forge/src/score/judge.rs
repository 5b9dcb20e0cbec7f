//! One report against its answer.
//!
//! A name is *accepted* for an effect if it is the effect's own or one that the forge finds indistinguishable on this
//! log. A set is accepted for an answer if its names and the answer's effects can be paired one to one so that every
//! name is accepted for its effect.

use crate::corpus::{Answer, AnswerEffect, Kind};
use crate::detect::DETECTABLE;
use crate::score::report::{Report, Verdict};

/// Least size of a single effect that the gates count, over the detectable one.
pub const GATE_SINGLE: f64 = 2.0;
/// Least size of each effect of a pair that the gates count.
pub const GATE_PAIR: f64 = 3.0;
/// From here on an effect counts as flagged unknown.
pub const UNKNOWN_FROM: f64 = 0.5;

/// One log with everything that is counted.
#[derive(Debug, Clone)]
#[allow(clippy::struct_excessive_bools)] // what is counted is yes or no
pub struct Judged {
    /// The answer.
    pub answer: Answer,
    /// The report; none where the diagnosis failed.
    pub report: Option<Report>,
    /// Time of the diagnosis [s].
    pub seconds: f64,
    /// A gap was reported.
    pub detected: bool,
    /// The likeliest name is accepted.
    pub top1: bool,
    /// One of the three likeliest names is accepted.
    pub top3: bool,
    /// The reported set is accepted.
    pub exact: bool,
    /// The unknown was flagged.
    pub flagged_unknown: bool,
    /// The verdict as a whole is right.
    pub right: bool,
    /// What the diagnosis gave its verdict.
    pub confidence: f64,
    /// Probability on the truth.
    pub on_truth: f64,
}

fn accepted(name: &str, effect: &AnswerEffect) -> bool {
    effect.name == name || effect.equivalents.iter().any(|other| other == name)
}

/// Whether names and effects pair up.
#[must_use]
pub fn set_accepted(names: &[&str], effects: &[AnswerEffect]) -> bool {
    let Some((first, rest)) = names.split_first() else { return effects.is_empty() };
    names.len() == effects.len()
        && effects.iter().enumerate().any(|(place, effect)| {
            let mut others = effects.to_vec();
            others.remove(place);
            accepted(first, effect) && set_accepted(rest, &others)
        })
}

/// Whether names pair up with the effects but for some that cannot be seen beside the others; an effect alone that
/// cannot be seen is for `no_gap`.
#[must_use]
pub fn seen_accepted(names: &[&str], effects: &[AnswerEffect]) -> bool {
    let without = |place: usize| {
        let mut rest = effects.to_vec();
        rest.remove(place);
        rest
    };
    let hidden = |place: &usize| effects.len() > 1 && effects[*place].d_beside_others < DETECTABLE;
    set_accepted(names, effects) || (0..effects.len()).filter(hidden).any(|place| seen_accepted(names, &without(place)))
}

/// Whether nothing of an answer can be seen.
#[must_use]
pub fn below_detectable(answer: &Answer) -> bool {
    answer.effects.iter().all(|effect| effect.d < DETECTABLE)
}

/// Whether the gates count a log.
#[must_use]
pub fn counts_for_gates(answer: &Answer) -> bool {
    let least = if matches!(answer.kind, Kind::Two | Kind::Three) { GATE_PAIR } else { GATE_SINGLE };
    answer.excitation.is_rich() && answer.effects.iter().all(|effect| effect.multiple >= least)
}

/// Holds one report against its answer.
#[must_use]
pub fn judge(answer: Answer, report: Option<Report>, seconds: f64) -> Judged {
    let mut judged = Judged {
        answer,
        report: None,
        seconds,
        detected: false,
        top1: false,
        top3: false,
        exact: false,
        flagged_unknown: false,
        right: false,
        confidence: 0.0,
        on_truth: 0.0,
    };
    if let Some(report) = report {
        fill(&mut judged, &report);
        judged.report = Some(report);
    }
    judged
}

fn fill(judged: &mut Judged, report: &Report) {
    let answer = &judged.answer;
    let effects = &answer.effects;
    // who refuses for want of motion has not seen a gap
    judged.detected = report.verdict != Verdict::NoGap && !report.refuses();
    let accepted_rank =
        report.ranking().iter().position(|(name, _)| effects.iter().any(|effect| accepted(name, effect)));
    judged.top1 = accepted_rank == Some(0);
    judged.top3 = accepted_rank.is_some_and(|rank| rank < 3);
    judged.exact = judged.detected && set_accepted(&report.names(), effects) && !effects.is_empty();
    judged.flagged_unknown = report.verdict == Verdict::Unexplained || report.unknown_probability >= UNKNOWN_FROM;
    let in_class = report.sets().iter().any(|(names, _)| seen_accepted(names, effects));
    let seen = judged.detected && !effects.is_empty() && seen_accepted(&report.names(), effects);
    judged.right = match (answer.kind, report.verdict) {
        (Kind::Nothing, _) => !judged.detected,
        (_, Verdict::CannotTell) if report.refuses() => below_detectable(answer),
        (_, Verdict::NoGap) => below_detectable(answer),
        (Kind::Beyond, _) if judged.flagged_unknown => true,
        (_, Verdict::CannotTell) => in_class,
        (_, Verdict::Explained | Verdict::PartlyExplained) => seen,
        (_, Verdict::Unexplained) => false,
    };
    judged.confidence = match report.verdict {
        _ if judged.flagged_unknown => report.unknown_probability.max(UNKNOWN_FROM),
        Verdict::CannotTell => 1.0 - report.unknown_probability,
        _ => report.set_probability(),
    };
    let on_sets: f64 = report
        .sets()
        .iter()
        .filter(|(names, _)| seen_accepted(names, effects))
        .map(|(_, probability)| probability)
        .sum();
    judged.on_truth = match answer.kind {
        // an effect of the table that leaves nothing of it is of its class
        Kind::Beyond => report.unknown_probability + on_sets,
        Kind::One => report
            .ranking()
            .iter()
            .filter(|(name, _)| effects.iter().any(|effect| accepted(name, effect)))
            .map(|(_, probability)| probability)
            .sum::<f64>(),
        Kind::Nothing | Kind::Two | Kind::Three => on_sets,
    }
    .clamp(0.0, 1.0);
}

impl Judged {
    /// Whether the gates count it.
    #[must_use]
    pub fn in_gates(&self) -> bool {
        counts_for_gates(&self.answer)
    }

    /// What stands for the answer in the confusion table.
    #[must_use]
    pub fn truth_name(&self) -> &str {
        match self.answer.kind {
            Kind::Nothing => "no_gap",
            Kind::Beyond => "unknown",
            _ => self.answer.effects.first().map_or("", |effect| effect.name.as_str()),
        }
    }

    /// The likeliest name that the report gives.
    #[must_use]
    pub fn named(&self) -> String {
        match &self.report {
            None => "failed".to_owned(),
            Some(report) => report.ranking().first().map_or_else(String::new, |(name, _)| name.clone()),
        }
    }
}
