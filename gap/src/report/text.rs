//! A few lines that a person can act on.

use std::fmt::Write;

use gimbal_plant::Effect;

use crate::diagnose::Diagnosis;
use crate::judge::{Decision, SetProbability, Verdict, experiment};

/// Least probability of another set that the verdict tells of.
const WORTH_A_WORD: f64 = 0.05;

/// The verdict in words.
#[must_use]
pub fn text(diagnosis: &Diagnosis) -> String {
    let mut out = String::new();
    let Some(decision) = &diagnosis.decision else {
        for fault in &diagnosis.record.faults {
            let _ = writeln!(out, "The data do not serve: {fault}.");
        }
        return out.trim_end().to_owned();
    };
    let named: Vec<String> = decision
        .found
        .iter()
        .map(|found| sentence(found.effect, found.probability, &found.values, &found.errors))
        .collect();
    let _ = match diagnosis.verdict() {
        Verdict::NoGap => writeln!(out, "No gap: nothing beyond noise and the tolerance of the parameters."),
        Verdict::Explained => writeln!(out, "Explained by {}.", named.join(" and ")),
        Verdict::PartlyExplained => writeln!(
            out,
            "Partly explained by {}; something else remains{}.",
            named.join(" and "),
            remains(decision, decision.left_over[1])
        ),
        Verdict::Unexplained => {
            writeln!(out, "A gap that no effect of the library explains{}.", remains(decision, decision.left_over[0]))
        }
        Verdict::CannotTell => writeln!(out, "Cannot tell: {} or one of these:", named.join(" and ")),
    };
    let _ = write!(out, "{}", beside(decision));
    if let Some(portrait) = &diagnosis.portrait {
        let _ = writeln!(out, "  {}", portrait.told());
    }
    if diagnosis.verdict() != Verdict::NoGap
        && let Some(shrink) = &diagnosis.shrink
    {
        for signal in &shrink.signals {
            let [low, high] = signal.ci95_percent;
            let _ = writeln!(
                out,
                "  {}: rms {:.3e} to {:.3e} {} on blocks not fitted, noise {:.1e}: {:.1} % of the gap gone ({low:.1} to {high:.1})",
                signal.name, signal.before, signal.after, signal.unit, signal.noise_floor, signal.reduction_percent
            );
        }
        for own in &diagnosis.free_running {
            let _ = writeln!(
                out,
                "  {}: the reference plant, running free, is off by {:.3e}, corrected {:.3e} {}",
                own.name, own.before, own.after, own.unit
            );
        }
        for hit in &diagnosis.bounds_hit {
            let _ = writeln!(out, "  {hit}");
        }
        let _ = writeln!(
            out,
            "  velocity error over the log: {:.3e} to {:.1e} m/s",
            shrink.velocity_before_mps, shrink.velocity_after_mps
        );
    }
    out.trim_end().to_owned()
}

/// The class that cannot be told apart, or what else is possible.
fn beside(decision: &Decision) -> String {
    let own = decision.found.first().map_or("", |found| found.effect);
    let set = |set: &SetProbability| {
        let name = if set.effects.is_empty() { "nothing".to_owned() } else { set.effects.join(" + ") };
        format!("{name} ({:.0} %)", 100.0 * set.probability)
    };
    if decision.verdict == Verdict::CannotTell {
        let line = |own_set: &SetProbability| {
            let other =
                own_set.effects.iter().find(|&&effect| decision.found.iter().all(|found| found.effect != effect));
            let told = experiment(own, other.copied().unwrap_or_default());
            format!("  {}; to tell them apart: {told}\n", set(own_set))
        };
        return decision.alternatives.iter().map(line).collect();
    }
    let possible: Vec<String> =
        decision.alternatives.iter().filter(|own| own.probability > WORTH_A_WORD).take(4).map(set).collect();
    if possible.is_empty() {
        return String::new();
    }
    // evidence that makes an effect likelier than not is not yet what a verdict asks for
    let hinted = decision.verdict == Verdict::NoGap && decision.alternatives[0].probability > 0.5;
    let how = if hinted { "too weak to be named" } else { "not excluded" };
    format!("  {how}: {}\n", possible.join(", "))
}

/// How far what is left stands out, and what it goes with.
fn remains(decision: &Decision, far: f64) -> String {
    let mut told = Vec::new();
    if far > 1.0 {
        told.push(format!("stands out by {far:.0} standard deviations"));
    }
    told.extend(decision.goes_with().map(|stranger| format!("goes with {stranger}")));
    if told.is_empty() { String::new() } else { format!(": it {}", told.join(" and ")) }
}

fn sentence(name: &str, probability: f64, values: &[f64], errors: &[f64]) -> String {
    let parameters: Vec<String> = Effect::from_name(name)
        .map(Effect::parameters)
        .unwrap_or_default()
        .iter()
        .zip(values.iter().zip(errors))
        .map(|(parameter, (value, error))| {
            let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
            format!("{} {value:.3e} +- {error:.0e}{unit}", parameter.name)
        })
        .collect();
    format!("{name} ({:.0} %; {})", 100.0 * probability.min(1.0), parameters.join(", "))
}
