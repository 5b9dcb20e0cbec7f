//! Unknown effects against known ones.

use super::judge::Judged;
use super::rate::Rate;
use super::report::Verdict;
use crate::corpus::Kind;

/// Share of known cases that may be called unknown.
const FALSE_UNKNOWN: f64 = 0.05;

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

/// Whether an effect of the table takes the place of an unknown one: no log can say then that it is unknown.
fn is_like_a_known_one(one: &Judged) -> bool {
    one.answer.effects.iter().any(|effect| !effect.equivalents.is_empty())
}

/// Share of unknown cases above the threshold that the given share of the others exceeds, and the area under the curve;
/// without the unknown ones whose place an effect of the table takes.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a place in a list
pub(super) fn unknown_curve(all: &[&Judged]) -> (Rate, Option<f64>) {
    let of = |beyond: bool| -> Vec<f64> {
        let counts =
            |one: &&&Judged| (one.answer.kind == Kind::Beyond) == beyond && !(beyond && is_like_a_known_one(one));
        all.iter().filter(counts).map(|one| unknown_p(one)).collect()
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
