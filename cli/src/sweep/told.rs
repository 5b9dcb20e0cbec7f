//! What a sweep says: first at how many g the platform saturates, and which part's tolerance decides that.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::answer::{Answer, Part, Spread};
use super::plan::{Design, METRICS, Plan};
use super::trial::Case;
use crate::report::counted;

/// Percentiles that are told.
const PERCENT: [f64; 7] = [0.1, 1.0, 5.0, 50.0, 95.0, 99.0, 99.9];
/// Metrics with a spread; the last one only says whether the gyro met its stop.
const SPREAD: usize = 5;
/// Smaller shares are not listed.
const LEAST_SHARE: f64 = 0.005;

impl Answer {
    /// For people.
    pub(super) fn text(&self, plan: &Plan) -> String {
        let mut text = self.limit(plan);
        if matches!(plan.design, Design::Draws(_)) && self.spreads[0].count > 1 {
            text += &decides(&self.parts(plan), self.spreads[0].count);
        }
        text += &self.counts(plan);
        text += &self.table();
        if matches!(plan.design, Design::Draws(_)) && self.spreads[0].count > 1 {
            text.push_str("part of the limit's variance, and its change for one standard deviation:\n");
            for Part { parameter, share, slope_g, .. } in
                self.parts(plan).iter().filter(|part| part.share > LEAST_SHARE)
            {
                let (symbol, name) = (parameter.symbol, parameter.name);
                let _ = writeln!(text, "  {symbol:<10}{:>6.1} %{slope_g:>+9.3} g   {name}", 100.0 * share);
            }
        }
        text.truncate(text.trim_end().len());
        text
    }

    /// At how many g it saturates.
    fn limit(&self, plan: &Plan) -> String {
        let limit = &self.spreads[0];
        let disturbed = match plan.case {
            Case::Unbalance => "unbalance alone",
            Case::Friction => "friction alone, rate of 0.1 rad/s reversed every 2 s",
            Case::Both => "unbalance and friction, rate of 0.1 rad/s reversed every 2 s",
        };
        let mut text = match limit.nominal {
            Some(limit_g) => format!("the nominal platform saturates at {limit_g:.2} g for 5 s ({disturbed})\n"),
            None => format!("the nominal platform does not saturate within its range ({disturbed})\n"),
        };
        if matches!(plan.design, Design::Draws(_)) && limit.count > 1 {
            let [first, low, high] = [1.0, 2.5, 97.5].map(|percent| limit.percentile(percent));
            let _ = writeln!(
                text,
                "within the tolerances 95 % of platforms saturate between {low:.2} and {high:.2} g, one in a hundred below \
                 {first:.2} g"
            );
        }
        text
    }

    fn counts(&self, plan: &Plan) -> String {
        let mut text = format!(
            "{}, seed and plan {:016x}; peaks and velocity error at {} g\n",
            counted(self.runs(), "run"),
            plan.fingerprint(),
            plan.accel_g
        );
        if self.unbuilt > 0 {
            let _ = writeln!(
                text,
                "{} with an unstable loop or a value out of range: empty cells",
                counted(self.unbuilt, "run")
            );
        }
        let missing = self.runs() - self.unbuilt - self.spreads[0].count;
        if missing > 0 {
            let _ = writeln!(text, "{} without saturation within the model's range", counted(missing, "run"));
        }
        let _ = writeln!(text, "{} of {} on a stop at {} g", self.limited, counted(self.runs(), "run"), plan.accel_g);
        text
    }

    fn table(&self) -> String {
        let number = |value: f64| if value.is_finite() { format!("{value:>13.5}") } else { format!("{:>13}", "-") };
        let mut text = format!("{:<24}{:>13}{:>13}", "", "nominal", "std");
        for percent in PERCENT {
            let _ = write!(text, "{percent:>11} %");
        }
        text.push('\n');
        for (name, spread) in METRICS.iter().zip(&self.spreads).take(SPREAD) {
            let _ = write!(text, "{name:<24}{}", number(spread.nominal.unwrap_or(f64::NAN)));
            text += &number(spread.deviation());
            for percent in PERCENT {
                text += &number(spread.percentile(percent));
            }
            text.push('\n');
        }
        text
    }

    /// For programs.
    pub(super) fn json(&self, plan: &Plan) -> Value {
        let metrics: Map<String, Value> = METRICS
            .iter()
            .zip(&self.spreads)
            .take(SPREAD)
            .map(|(name, spread)| ((*name).to_owned(), spread_json(spread)))
            .collect();
        let parts = self.parts(plan);
        let blocks: Map<String, Value> =
            blocks(&parts).into_iter().map(|(block, share)| (block.to_owned(), json!(share))).collect();
        let parts: Vec<Value> = parts
            .iter()
            .map(|Part { parameter, share, scatter, slope_g }| {
                json!({
                    "parameter": parameter.name,
                    "symbol": parameter.symbol,
                    "variance_share": share,
                    "variance_share_std": scatter,
                    "change_per_std_g": slope_g,
                })
            })
            .collect();
        json!({
            "case": plan.case.name(),
            "accel_g": plan.accel_g,
            "runs": self.runs(),
            "unbuilt": self.unbuilt,
            "limited": self.limited,
            "metrics": metrics,
            "decides": parts,
            "variance_share_by_part": blocks,
        })
    }
}

/// Which part's tolerance decides the limit, and which single one counts most.
fn decides(parts: &[Part], runs: u64) -> String {
    let Some(first) = parts.first() else { return String::new() };
    let blocks = blocks(parts);
    let mut text = String::new();
    if let [(block, share), others @ ..] = &blocks[..] {
        let others: Vec<String> =
            others.iter().map(|(block, share)| format!("{block} {:.0} %", 100.0 * share)).collect();
        let _ = writeln!(
            text,
            "the part whose tolerances decide it is the {block}: {:.0} % of the limit's variance ({})",
            100.0 * share,
            others.join(", ")
        );
    }
    let alike = |part: &&Part| first.share - part.share < 2.0 * first.scatter.hypot(part.scatter);
    let alike: Vec<&str> = parts
        .iter()
        .skip(1)
        .filter(alike)
        .filter(|part| part.share > LEAST_SHARE)
        .map(|p| p.parameter.symbol)
        .collect();
    let chance = match &alike[..] {
        [] => String::new(),
        alike => format!("; {} cannot tell it from {}", counted(runs, "run"), alike.join(", ")),
    };
    let _ = writeln!(
        text,
        "the single tolerance that counts most is that of {} ({}): {:.0} %, {:+.2} g for one standard deviation{chance}",
        first.parameter.symbol,
        first.parameter.name,
        100.0 * first.share,
        first.slope_g
    );
    text
}

/// Shares of the parts of a platform, which are the tables of the model file; the largest first.
fn blocks(parts: &[Part]) -> Vec<(&'static str, f64)> {
    let mut blocks: Vec<(&'static str, f64)> = Vec::new();
    for part in parts {
        let block = part.parameter.name.split('.').next().unwrap_or_default();
        match blocks.iter_mut().find(|(known, _)| *known == block) {
            Some((_, share)) => *share += part.share,
            None => blocks.push((block, part.share)),
        }
    }
    blocks.sort_by(|a, b| b.1.total_cmp(&a.1));
    blocks
}

fn spread_json(spread: &Spread) -> Value {
    let percentiles: Map<String, Value> =
        PERCENT.iter().map(|percent| (percent.to_string(), json!(spread.percentile(*percent)))).collect();
    json!({
        "nominal": spread.nominal,
        "runs": spread.count,
        "mean": spread.mean,
        "std": spread.deviation(),
        "percentiles": percentiles,
    })
}
