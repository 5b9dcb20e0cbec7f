//! The limits that a diagnosis is held to, each with its interval.
//!
//! Counted are logs with rich motion whose single effect has at least twice, whose two or three effects have each at
//! least three times the detectable size; logs with nothing are counted whatever their motion.

use serde::{Deserialize, Serialize};

use super::calibration::calibration;
use super::coverage::{coverage, shrink};
use super::judge::Judged;
use super::rate::Rate;
use super::unknown::unknown_curve;
use crate::corpus::Kind;
use crate::draw::Draw;

/// A figure, its interval and its limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gate {
    /// What is counted.
    pub what: String,
    /// Share, error or median; none without a case.
    pub value: Option<f64>,
    /// Its 95 % interval: Wilson's of a rate, resampling's of anything else.
    pub interval: (f64, f64),
    /// Number of cases.
    pub of: usize,
    /// Least and largest value.
    pub limits: (f64, f64),
    /// For tables.
    pub text: String,
}

impl Gate {
    /// Whether the value keeps the limits; none without a case.
    #[must_use]
    pub fn kept(&self) -> Option<bool> {
        self.value.map(|value| (self.limits.0..=self.limits.1).contains(&value))
    }

    /// The limits for tables.
    #[must_use]
    pub fn limit_text(&self) -> String {
        match self.limits {
            (0.0, most) => format!("<= {most:.4}"),
            (least, most) if most.is_finite() && most < 1.0 => format!("{least:.2} to {most:.2}"),
            (least, _) => format!(">= {least:.2}"),
        }
    }

    fn of_rate(what: &str, rate: Rate, limits: (f64, f64)) -> Self {
        let (value, interval) = (rate.share(), rate.wilson());
        Self { what: what.to_owned(), value, interval, of: rate.of, limits, text: rate.text() }
    }

    fn of_value(what: &str, value: Option<f64>, interval: (f64, f64), of: usize, limits: (f64, f64)) -> Self {
        let text = value.map_or_else(
            || "-".to_owned(),
            |value| format!("{value:.3} ({:.3} to {:.3}), {of} cases", interval.0, interval.1),
        );
        Self { what: what.to_owned(), value, interval, of, limits, text }
    }
}

/// 95 % interval of a figure of a list, by resampling.
fn resampled(values: &[f64], figure: impl Fn(&mut [f64]) -> f64) -> (f64, f64) {
    const RESAMPLES: usize = 1000;
    if values.is_empty() {
        return (0.0, 1.0);
    }
    let mut draw = Draw::new(&Draw::seed_of(2), 0);
    let mut figures: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let mut again: Vec<f64> = (0..values.len()).map(|_| values[draw.below(values.len())]).collect();
            figure(&mut again)
        })
        .collect();
    figures.sort_by(f64::total_cmp);
    (figures[RESAMPLES / 40], figures[RESAMPLES - 1 - RESAMPLES / 40])
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// All gates of a corpus.
pub(super) fn gates(all: &[&Judged]) -> Vec<Gate> {
    let counted: Vec<&Judged> = all.iter().copied().filter(|one| one.in_gates()).collect();
    let of = |kind: Kind| counted.iter().copied().filter(move |one: &&Judged| one.answer.kind == kind);
    let known: Vec<&Judged> =
        counted.iter().copied().filter(|one| !matches!(one.answer.kind, Kind::Nothing | Kind::Beyond)).collect();
    let nothing = all.iter().copied().filter(|one| one.answer.kind == Kind::Nothing);
    let rich: Vec<&Judged> = all.iter().copied().filter(|one| one.answer.excitation.is_rich()).collect();
    let verdicts = calibration(rich.iter().map(|one| (one.confidence, one.right)).collect());
    let on_truth: Vec<f64> = counted.iter().map(|one| one.on_truth).collect();
    let (parameters, _) = coverage(&known);
    let (shrinks, closed) = shrink(&known);
    let least = |limit: f64| (limit, f64::MAX);
    vec![
        Gate::of_rate("top-1, one effect", Rate::over(of(Kind::One), |one| one.top1), least(0.95)),
        Gate::of_rate("top-3, one effect", Rate::over(of(Kind::One), |one| one.top3), least(0.99)),
        Gate::of_rate("two effects exactly named", Rate::over(of(Kind::Two), |one| one.exact), least(0.80)),
        Gate::of_rate("false alarms, nothing put in", Rate::over(nothing, |one| one.detected), (0.0, 1.0 / 600.0)),
        Gate::of_rate("unknown flagged at 5 % false unknown", unknown_curve(&counted).0, least(0.90)),
        Gate::of_value(
            "calibration error of verdicts, rich motion, all sizes",
            (verdicts.count > 0).then_some(verdicts.error),
            verdicts.interval,
            verdicts.count,
            (0.0, 0.03),
        ),
        Gate::of_value(
            "mean probability on the truth",
            (!on_truth.is_empty()).then(|| mean(&on_truth)),
            resampled(&on_truth, |values| mean(values)),
            on_truth.len(),
            least(0.90),
        ),
        Gate::of_rate("95 % intervals of parameters that hold the truth", parameters, (0.92, 0.98)),
        Gate::of_rate("95 % intervals of the reduction that hold the best possible", shrinks, (0.92, 0.98)),
        Gate::of_value(
            "median share of the closable gap closed",
            (!closed.is_empty()).then(|| median(&mut closed.clone())),
            resampled(&closed, median),
            closed.len(),
            least(0.95),
        ),
    ]
}
