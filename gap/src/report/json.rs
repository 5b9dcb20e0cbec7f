//! `gap.json`, schema `gimbal-gap/1`.

use gimbal_plant::Effect;
use serde_json::{Value, json};

use crate::diagnose::Diagnosis;
use crate::judge::{Portrait, Verdict, Yardstick, experiment};

/// The report of one log; `log` and `model` are their names.
#[must_use]
#[allow(clippy::too_many_lines, reason = "the schema, told in its order")]
pub fn json(diagnosis: &Diagnosis, log: &str, model: &str) -> Value {
    let record = &diagnosis.record;
    let head = json!({
        "file": log,
        "rows": record.rows(),
        "period_s": record.inputs.period_s,
        "first_s": record.first_s,
        "signals": record.channels.iter().map(|channel| channel.signal.column().name()).collect::<Vec<_>>(),
    });
    let mut notes: Vec<String> = record.faults.iter().map(|fault| format!("data: {fault}")).collect();
    notes.extend(record.notes.iter().cloned());
    let mut report = json!({
        "schema": "gimbal-gap/1",
        "log": head,
        "model": { "file": model },
        "verdict": diagnosis.verdict().name(),
        "where": places(diagnosis),
        "effects": [],
        "unknown_probability": 0.0,
        "alternatives": [],
        "shrink": { "held_out": true, "signals": [], "velocity_error_mps": { "before": 0.0, "after": 0.0 } },
        "detectable": diagnosis.detectable.iter().map(|d| json!({
            "name": d.effect, "parameter": d.parameter, "unit": d.unit, "size": d.size, "seen": d.seen.name()
        })).collect::<Vec<_>>(),
        "ranking": [],
        "left_over": null,
        "parameter_correlations": diagnosis.correlations.iter().map(|own| json!({
            "value": own.value, "other": own.other, "correlation": own.correlation
        })).collect::<Vec<_>>(),
        "bounds_hit": diagnosis.bounds_hit,
        "not_looked_for": diagnosis.not_looked_for,
        "notes": [],
    });
    let Some(decision) = &diagnosis.decision else {
        report["notes"] = json!(notes);
        return report;
    };
    let effects: Vec<Value> = decision
        .found
        .iter()
        .enumerate()
        .map(|(place, found)| {
            let effect = Effect::from_name(found.effect);
            let parameters: Vec<Value> = effect
                .map(Effect::parameters)
                .unwrap_or_default()
                .iter()
                .zip(found.values.iter().zip(&found.errors))
                .map(|(parameter, (value, std))| json!({ "name": parameter.name, "value": value, "std": std, "unit": parameter.unit }))
                .collect();
            json!({
                "name": found.effect,
                "block": effect.map(|effect| effect.block().to_string()),
                "probability": found.probability.min(1.0),
                "parameters": parameters,
                "removes": diagnosis.removes.get(place).copied().unwrap_or(0.0),
            })
        })
        .collect();
    let own = decision.found.first().map_or("", |found| found.effect);
    let alternatives: Vec<Value> = decision
        .alternatives
        .iter()
        .map(|set| {
            let other = set.effects.iter().find(|effect| !decision.found.iter().any(|found| found.effect == **effect));
            json!({
                "effects": set.effects,
                "probability": set.probability,
                "told_apart_by": experiment(own, other.copied().unwrap_or_default()),
            })
        })
        .collect();
    if let Some(shrink) = &diagnosis.shrink {
        report["shrink"]["signals"] = shrink
            .signals
            .iter()
            .map(|signal| {
                json!({
                    "name": signal.name, "unit": signal.unit, "before": signal.before, "after": signal.after,
                    "noise_floor": signal.noise_floor, "reduction_percent": signal.reduction_percent,
                    "ci95_percent": signal.ci95_percent,
                })
            })
            .collect();
        report["shrink"]["velocity_error_mps"] =
            json!({ "before": shrink.velocity_before_mps, "after": shrink.velocity_after_mps });
        if diagnosis.verdict() != Verdict::NoGap && shrink.signals.iter().all(|signal| signal.ci95_percent[0] <= 0.0) {
            notes.push("no improvement is shown: the interval of the reduction includes zero".to_owned());
        }
    }
    report["shrink"]["free_running"] = diagnosis.free_running.iter().map(Yardstick::json).collect();
    report["shrink"]["one_step"] = diagnosis.one_step.iter().map(Yardstick::json).collect();
    if let Some(portrait) = &diagnosis.portrait {
        report["left_over"] = left_over(portrait, diagnosis.record.first_s);
    }
    let hidden: Vec<&str> = diagnosis.detectable.iter().filter(|d| d.size.is_none()).map(|d| d.effect).collect();
    if !hidden.is_empty() {
        notes.push(format!("this log cannot show: {}", hidden.join(", ")));
    }
    notes.extend(decision.notes.iter().cloned());
    report["effects"] = json!(effects);
    report["unknown_probability"] = json!(decision.unknown_probability);
    report["alternatives"] = json!(alternatives);
    report["ranking"] = decision
        .ranking
        .iter()
        .take(12)
        .map(|set| json!({ "effects": set.effects, "probability": set.probability }))
        .collect();
    report["notes"] = json!(notes);
    report
}

fn left_over(portrait: &Portrait, first_s: f64) -> Value {
    json!({
        "told": portrait.told(),
        "signal": portrait.signal, "unit": portrait.unit, "rms": portrait.rms[0], "noise_floor": portrait.rms[1],
        "block": portrait.block.as_ref().map(|(name, share)| json!({ "name": name, "share": share })),
        "band": portrait.band.map(|band| json!({ "from_hz": band.from_hz, "to_hz": band.to_hz, "share": band.share })),
        "regimes": portrait.regimes.iter().map(|r| json!({ "name": r.name, "share": r.share })).collect::<Vec<_>>(),
        "span": { "from_s": first_s + portrait.span_s[0], "to_s": first_s + portrait.span_s[1] },
        "burst_share": portrait.burst_share,
        "depends_on": portrait.depends_on.iter().map(|(on, share)| json!({ "on": on, "share": share })).collect::<Vec<_>>(),
        "nearest": portrait.nearest.iter().map(|(name, share)| json!({ "effect": name, "would_take": share })).collect::<Vec<_>>(),
    })
}

fn places(diagnosis: &Diagnosis) -> Value {
    let signals: Vec<Value> = diagnosis
        .shrink
        .iter()
        .flat_map(|shrink| &shrink.signals)
        .map(|signal| json!({ "name": signal.name, "rms": signal.before, "noise_floor": signal.noise_floor, "unit": signal.unit }))
        .collect();
    json!({
        "blocks": diagnosis.blocks.iter().map(|(name, share)| json!({ "name": name, "share": share })).collect::<Vec<_>>(),
        "signals": signals,
        "spans": diagnosis.spans.iter().map(|span| json!({
            "from_s": diagnosis.record.first_s + span.from_s, "to_s": diagnosis.record.first_s + span.to_s, "share": span.share
        })).collect::<Vec<_>>(),
        "regimes": diagnosis.regimes.iter().map(|r| json!({ "name": r.name, "share": r.share, "time_share": r.time_share })).collect::<Vec<_>>(),
        "bands": diagnosis.bands.iter().map(|b| json!({ "from_hz": b.from_hz, "to_hz": b.to_hz, "share": b.share })).collect::<Vec<_>>(),
    })
}
