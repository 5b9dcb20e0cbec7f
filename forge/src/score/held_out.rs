//! What it costs when a family of effects, or a motion, is not in the set that probabilities are calibrated on.
//!
//! ```text
//! q = sigma(a + b logit p)      a, b: least sum of -ln q over logs, with a ridge of one log about a = 0, b = 1
//! ```
//!
//! p: confidence of a verdict; q is fitted once on all logs but those of the family, and once on all, families weighed
//! alike so that the shares of the corpus do not enter. The cost is the difference of the two mean -ln q on the
//! family's logs, each of which is judged by a fit that leaves out its own half of the corpus.

use serde::Serialize;

use super::judge::Judged;
use crate::corpus::Kind;
use crate::excitation::Excitation;

/// One family left out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeldOut {
    /// The family.
    pub name: String,
    /// Its logs.
    pub logs: usize,
    /// Mean of -ln p of the verdicts' outcomes as reported.
    pub reported: f64,
    /// Recalibrated on the other half of the corpus, the family's own logs among it.
    pub with: f64,
    /// Recalibrated on the same without the family.
    pub without: f64,
}

/// One verdict: logit of its confidence, whether it was right, its weight.
#[derive(Debug, Clone, Copy)]
struct Case {
    logit: f64,
    right: bool,
    weight: f64,
}

fn logit(p: f64) -> f64 {
    let p = p.clamp(1e-3, 1.0 - 1e-3);
    (p / (1.0 - p)).ln()
}

fn sigma(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

fn loss(case: &Case, [a, b]: [f64; 2]) -> f64 {
    let q = sigma(a + b * case.logit).clamp(1e-4, 1.0 - 1e-4);
    if case.right { -q.ln() } else { -(1.0 - q).ln() }
}

/// What a fit makes small; no clamps, so that it stays smooth.
fn objective(cases: &[Case], [a, b]: [f64; 2]) -> f64 {
    let ridge = 0.5 * (a * a + (b - 1.0) * (b - 1.0));
    let of = |case: &Case| {
        let x = a + b * case.logit;
        // ln(1 + exp(-x)) or ln(1 + exp(x)), without overflow
        let signed = if case.right { -x } else { x };
        case.weight * (signed.max(0.0) + (-signed.abs()).exp().ln_1p())
    };
    ridge + cases.iter().map(of).sum::<f64>()
}

/// Newton's method on a convex function of two numbers.
fn fit(cases: &[Case]) -> [f64; 2] {
    let [mut a, mut b] = [0.0, 1.0];
    for _ in 0..50 {
        let (mut gradient, mut curvature) = ([a, b - 1.0], [1.0, 0.0, 1.0]);
        for case in cases {
            let q = sigma(a + b * case.logit);
            let off = case.weight * (q - f64::from(u8::from(case.right)));
            let bend = case.weight * q * (1.0 - q);
            gradient[0] += off;
            gradient[1] += off * case.logit;
            curvature[0] += bend;
            curvature[1] += bend * case.logit;
            curvature[2] += bend * case.logit * case.logit;
        }
        let determinant = curvature[0] * curvature[2] - curvature[1] * curvature[1];
        let step_a = (curvature[2] * gradient[0] - curvature[1] * gradient[1]) / determinant;
        let step_b = (curvature[0] * gradient[1] - curvature[1] * gradient[0]) / determinant;
        // halved until it goes down: far from the minimum the quadratic reaches too far
        let from = objective(cases, [a, b]);
        let mut damp = 1.0;
        while damp > 1e-6 && objective(cases, [a - damp * step_a, b - damp * step_b]) > from {
            damp *= 0.5;
        }
        a -= damp * step_a;
        b -= damp * step_b;
        if step_a.abs() + step_b.abs() < 1e-9 {
            break;
        }
    }
    [a, b]
}

/// The block of a log's first effect, `nothing` or `beyond`.
fn family(one: &Judged) -> String {
    match one.answer.kind {
        Kind::Nothing => "nothing".to_owned(),
        _ => one.answer.effects.first().map_or_else(String::new, |effect| effect.block.clone()),
    }
}

fn cases(of: &[(&Judged, String)], keep: impl Fn(usize, &str) -> bool) -> Vec<Case> {
    let kept: Vec<&(&Judged, String)> =
        of.iter().enumerate().filter(|(place, one)| keep(*place, &one.1)).map(|(_, one)| one).collect();
    let mut families: Vec<&str> = kept.iter().map(|one| one.1.as_str()).collect();
    families.sort_unstable();
    families.dedup();
    kept.iter()
        .map(|(one, name)| {
            let own = kept.iter().filter(|other| other.1 == *name).count();
            Case {
                logit: logit(one.confidence),
                right: one.right,
                weight: kept.len() as f64 / (families.len() * own) as f64,
            }
        })
        .collect()
}

fn leave_out(all: &[&Judged], title: &str, name_of: impl Fn(&Judged) -> String) -> Vec<HeldOut> {
    let named: Vec<(&Judged, String)> = all.iter().map(|one| (*one, name_of(one))).collect();
    let mut names: Vec<&str> = named.iter().map(|one| one.1.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names
        .into_iter()
        .map(|name| {
            let fits: [[[f64; 2]; 2]; 2] = [0, 1].map(|half| {
                let other_half = move |place: usize| place % 2 != half;
                [
                    fit(&cases(&named, |place, _| other_half(place))),
                    fit(&cases(&named, |place, family| other_half(place) && family != name)),
                ]
            });
            let mut result =
                HeldOut { name: format!("{title} {name}"), logs: 0, reported: 0.0, with: 0.0, without: 0.0 };
            for (place, (one, _)) in named.iter().enumerate().filter(|(_, one)| one.1 == name) {
                let case = Case { logit: logit(one.confidence), right: one.right, weight: 1.0 };
                result.logs += 1;
                result.reported += loss(&case, [0.0, 1.0]);
                result.with += loss(&case, fits[place % 2][0]);
                result.without += loss(&case, fits[place % 2][1]);
            }
            let count = result.logs.max(1) as f64;
            for sum in [&mut result.reported, &mut result.with, &mut result.without] {
                *sum /= count;
            }
            result
        })
        .collect()
}

/// Every family of effects and every motion, left out in turn.
#[must_use]
pub(super) fn held_out(all: &[&Judged]) -> Vec<HeldOut> {
    let mut rows = leave_out(all, "effects:", family);
    rows.extend(leave_out(all, "motion:", |one| Excitation::name(one.answer.excitation).to_owned()));
    rows
}
