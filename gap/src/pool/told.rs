//! What is told of several logs: for programs, and in a few lines.

use serde_json::{Value, json};

use super::{Pool, Repeat, Shared};
use crate::judge::{Verdict, Yardstick};

/// Evidence in words: no digits beyond what anybody reads.
pub(crate) fn nats(value: f64) -> String {
    match value.abs() {
        size if size < 1e3 => format!("{value:.1}"),
        size if size < 1e7 => format!("{value:.0}"),
        _ => format!("{value:.1e}"),
    }
}

impl Shared {
    /// For programs; `names` are those of the logs.
    fn json(&self, names: &[String]) -> Value {
        json!({
            "effect": self.effect, "name": self.parameter, "unit": self.unit,
            "value": self.mean[0], "std": self.mean[1], "chi2": self.chi2,
            "probability_by_chance": self.by_chance, "drifts": self.drifts, "shared_nats": self.shared_nats,
            "logs": self.values.iter().map(|(log, value, std)| json!({
                "log": names[*log], "value": value, "std": std
            })).collect::<Vec<_>>(),
        })
    }

    /// Which of both the logs prefer, in words.
    #[must_use]
    pub fn preference(&self) -> String {
        let scatter = format!("chi2 {}, {:.1} % by chance", nats(self.chi2), 100.0 * self.by_chance);
        let count = self.values.len();
        match self.shared_nats {
            _ if count < 2 => format!("shown by {count} log{}", if count == 1 { "" } else { "s" }),
            Some(nats) if self.drifts => {
                format!("drifts from run to run over {count} logs: preferred by {} nats ({scatter})", self::nats(-nats))
            }
            Some(nats) if nats >= 0.0 => {
                format!("the same in {count} logs: preferred by {} nats ({scatter})", self::nats(nats))
            }
            Some(nats) => {
                format!(
                    "the same in {count} logs: a value for each is {:.1} nats likelier, too little ({scatter})",
                    -nats
                )
            }
            None if self.drifts => format!("drifts from run to run over {count} logs ({scatter})"),
            None => format!("the same in {count} logs ({scatter})"),
        }
    }

    fn line(&self) -> String {
        let [value, std] = self.mean;
        format!("  {} {}: {value:.3e} +- {std:.0e} {}, {}", self.effect, self.parameter, self.unit, self.preference())
    }
}

impl Pool {
    /// For programs; `names` are those of the logs.
    #[must_use]
    pub fn json(&self, names: &[String]) -> Value {
        json!({
            "verdict": self.verdict.name(),
            "logs": self.logs.iter().map(|&log| &names[log]).collect::<Vec<_>>(),
            "effects": self.named,
            "sets": self.sets.iter().take(12).map(|set| json!({
                "effects": set.effects, "probability": set.probability, "nats": set.nats, "cost_nats": set.cost,
                "fitted": set.is_fitted,
            })).collect::<Vec<_>>(),
            "alternatives": self.alternatives.iter().map(|set| json!({
                "effects": set.effects, "probability": set.probability
            })).collect::<Vec<_>>(),
            "unknown_probability": self.unknown_probability,
            "parameters": self.shared.iter().map(|own| own.json(names)).collect::<Vec<_>>(),
            "drifting_nominal_parameters": self.drifting.iter().map(|own| own.json(names)).collect::<Vec<_>>(),
            "fits": self.fits.iter().map(|own| json!({
                "log": names[own.log], "samples": own.samples, "chi2_nominal": own.before, "chi2": own.after
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
            "notes": self.notes,
        })
    }

    /// The verdict in a line.
    #[must_use]
    pub fn headline(&self) -> String {
        let set = |effects: &[&str]| effects.join(" + ");
        let own = self.sets.iter().find(|own| own.effects.len() == self.named.len() && !own.effects.is_empty());
        let own = own.filter(|own| self.named.iter().all(|name| own.effects.contains(name)));
        let all = format!("All {} logs together", self.logs.len());
        match self.verdict {
            Verdict::NoGap => format!("{all}: no gap."),
            Verdict::Unexplained => format!("{all}: a gap that no effect explains."),
            Verdict::CannotTell if self.named.is_empty() => format!("{all}: cannot tell."),
            Verdict::CannotTell => {
                let class = [set(&self.named)].into_iter().chain(self.alternatives.iter().map(|own| set(&own.effects)));
                format!("{all}: cannot tell: {}.", class.collect::<Vec<_>>().join(", or "))
            }
            verdict => {
                let how = if verdict == Verdict::Explained { "explained" } else { "partly explained" };
                let sure = own.filter(|own| own.cost > 0.0).map_or_else(String::new, |own| {
                    format!(
                        " ({:.0} %, {} nats where {:.0} are needed)",
                        100.0 * own.probability,
                        nats(own.nats),
                        own.cost
                    )
                });
                format!("{all}: {how} by {}{sure}.", set(&self.named))
            }
        }
    }

    /// For people; `names` are those of the logs.
    #[must_use]
    pub fn text(&self, names: &[String]) -> String {
        let mut lines = vec![self.headline()];
        lines.extend(self.shared.iter().map(Shared::line));
        lines.extend(self.drifting.iter().map(|own| format!("{} (nominal parameter)", own.line())));
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
        lines.extend(self.notes.iter().map(|note| format!("  {note}")));
        lines.join("\n")
    }
}
