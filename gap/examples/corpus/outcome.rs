//! One diagnosis against what was put in.

use gimbal_gap::Diagnosis;
use gimbal_gap::judge::{Seen, Verdict};
use gimbal_plant::Effect;
use serde_json::Value;

use crate::corpus::Excitation;

/// Length of a window [s].
const WINDOW_S: f64 = 0.5;

/// What was put in.
pub(crate) struct Truth {
    pub(crate) effect: Effect,
    pub(crate) excitation: Excitation,
    pub(crate) seed: u64,
    pub(crate) values: Vec<f64>,
    pub(crate) size: f64,
    /// Smallest size that the log can show; none inside the realistic range.
    pub(crate) smallest: Option<f64>,
    /// Half-second windows in which the effect stands out of the noise.
    pub(crate) windows: Vec<bool>,
}

/// How the effect was named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Named {
    /// It alone.
    Right,
    /// It and another.
    Beside,
    /// One of several that are said not to be told apart.
    Class,
    /// Several said not to be told apart, and it is none of them; or data that do not serve.
    CannotTell,
    /// A gap that nothing of the library explains.
    Unknown,
    /// Another.
    Wrong,
    /// `no_gap`.
    NotSeen,
}

impl Named {
    pub(crate) const ALL: [(Self, &'static str); 7] = [
        (Self::Right, "right"),
        (Self::Class, "class"),
        (Self::Beside, "beside"),
        (Self::CannotTell, "cannot tell"),
        (Self::Unknown, "unknown"),
        (Self::Wrong, "wrong"),
        (Self::NotSeen, "not seen"),
    ];
}

/// What came of one log.
pub(crate) struct Outcome {
    pub(crate) truth: Truth,
    pub(crate) named: Named,
    pub(crate) found: Vec<&'static str>,
    /// Whether the largest share of the gap is given to the block of the effect.
    pub(crate) block: bool,
    /// Overlap over union of the spans, where the effect comes and goes and was named.
    pub(crate) overlap: Option<f64>,
    /// Parameters within three standard errors, of how many; where it was named.
    pub(crate) covered: (usize, usize),
    /// Share of the gap closed on held-out data [%], of the signal with most of it.
    pub(crate) closed_percent: Option<f64>,
    /// Whether the report says that this log cannot show the effect, or not at this size.
    pub(crate) marked: bool,
}

fn named(diagnosis: &Diagnosis, own: &str) -> Named {
    let Some(decision) = &diagnosis.decision else { return Named::CannotTell };
    let has = decision.found.iter().any(|found| found.effect == own);
    match decision.verdict {
        Verdict::NoGap => Named::NotSeen,
        Verdict::Unexplained => Named::Unknown,
        Verdict::CannotTell if has || decision.alternatives.iter().any(|set| set.effects.contains(&own)) => {
            Named::Class
        }
        Verdict::CannotTell => Named::CannotTell,
        _ if has && decision.found.len() == 1 => Named::Right,
        _ if has => Named::Beside,
        _ => Named::Wrong,
    }
}

/// Windows that both have over windows that either has.
fn overlap(truth: &[bool], spans: &[gimbal_gap::place::Span]) -> f64 {
    let middle_s = |window: usize| WINDOW_S * (window as f64 + 0.5);
    let inside = |window: usize| spans.iter().any(|span| (span.from_s..span.to_s).contains(&middle_s(window)));
    // the first second is not scored
    let windows = 2..truth.len();
    let both = windows.clone().filter(|&window| truth[window] && inside(window)).count();
    let either = windows.filter(|&window| truth[window] || inside(window)).count();
    both as f64 / either.max(1) as f64
}

fn covered(truth: &Truth, diagnosis: &Diagnosis) -> (usize, usize) {
    let found = diagnosis.decision.iter().flat_map(|decision| &decision.found);
    let Some(found) = found.into_iter().find(|found| found.effect == truth.effect.name()) else { return (0, 0) };
    let within =
        truth.effect.parameters().iter().zip(&truth.values).zip(found.values.iter().zip(&found.errors)).filter(
            |((parameter, truth), (value, error))| {
                let off = *value - *truth;
                // an angle, whatever its turn
                let off = if parameter.name == "phase_rad" { off.sin().atan2(off.cos()) } else { off };
                off.abs() <= 3.0 * **error
            },
        );
    (within.count(), truth.values.len())
}

fn closed_percent(report: &Value) -> Option<f64> {
    let signals = report["shrink"]["signals"].as_array()?;
    let over = |signal: &Value| Some(signal["before"].as_f64()? / signal["noise_floor"].as_f64()?);
    let most = signals.iter().max_by(|a, b| over(a).unwrap_or(0.0).total_cmp(&over(b).unwrap_or(0.0)))?;
    most["reduction_percent"].as_f64()
}

fn marked(diagnosis: &Diagnosis, truth: &Truth) -> bool {
    let own = diagnosis.detectable.iter().find(|own| own.effect == truth.effect.name());
    own.is_none_or(|own| match own.size {
        None => true,
        // a ceiling, and a stop that came nearer
        Some(size) if own.seen == Seen::Below => truth.values[0] > size,
        Some(size) => size > truth.size,
    })
}

impl Outcome {
    pub(crate) fn new(truth: Truth, diagnosis: &Diagnosis, report: &Value) -> Self {
        let named = named(diagnosis, truth.effect.name());
        let has = matches!(named, Named::Right | Named::Beside | Named::Class);
        let share = truth.windows.iter().filter(|window| **window).count() as f64 / truth.windows.len().max(1) as f64;
        let intermittent = (0.05..=0.8).contains(&share);
        let blocks = report["where"]["blocks"].as_array();
        let block = blocks.and_then(|blocks| blocks.first()).and_then(|block| block["name"].as_str());
        let gap = !matches!(named, Named::NotSeen | Named::CannotTell);
        Self {
            named,
            found: diagnosis.decision.iter().flat_map(|decision| decision.found.iter().map(|f| f.effect)).collect(),
            block: block == Some(truth.effect.block().to_string().as_str()),
            overlap: (intermittent && has).then(|| overlap(&truth.windows, &diagnosis.spans)),
            covered: covered(&truth, diagnosis),
            closed_percent: if gap { closed_percent(report) } else { None },
            marked: marked(diagnosis, &truth),
            truth,
        }
    }

    /// One line.
    pub(crate) fn told(&self) -> String {
        let truth = &self.truth;
        let values: Vec<String> = truth.values.iter().map(|value| format!("{value:.3e}")).collect();
        let multiple = truth.smallest.map_or("beyond range".to_owned(), |least| format!("x {:.1}", truth.size / least));
        let closed = self.closed_percent.map_or("-".to_owned(), |percent| format!("{percent:.0} %"));
        format!(
            "{} {} {}: {} ({multiple}) {:?} {} block {} overlap {:?} covered {:?} closed {closed} marked {}",
            truth.excitation.name(),
            truth.seed,
            truth.effect.name(),
            values.join(" "),
            self.named,
            self.found.join("+"),
            self.block,
            self.overlap.map(|share| (100.0 * share).round() / 100.0),
            self.covered,
            self.marked,
        )
    }
}
