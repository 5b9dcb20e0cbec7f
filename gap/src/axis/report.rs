//! What is told of an axis: the schema `gimbal-gap/1`, a page, and a few lines for the terminal.

use std::fmt::Write;

use serde_json::{Value, json as object};

use super::diagnose::AxisDiagnosis;
use super::experiment::experiment;
use super::judge::Found;
use crate::judge::Verdict;
use crate::report::page::{Line, SCRIPT, STYLE, escaped, plot};

/// The report of one log; `log` and `model` are their names.
#[must_use]
pub fn json(diagnosis: &AxisDiagnosis, log: &str, model: &str) -> Value {
    let signals = || {
        diagnosis.shrunk.iter().map(|s| {
            object!({
                "name": s.name, "unit": s.unit, "before": s.before, "after": s.after, "noise_floor": s.noise_floor,
                "reduction_percent": s.reduction_percent, "ci95_percent": s.ci95_percent,
            })
        })
    };
    let effects = diagnosis.found.iter().map(|found| {
        let parameters = found
            .parameters
            .iter()
            .map(|p| object!({ "name": p.name, "value": p.value, "std": p.std, "unit": p.unit }))
            .collect::<Vec<_>>();
        object!({
            "name": found.effect, "block": found.block, "probability": found.probability,
            "parameters": parameters, "removes": found.removes, "shows_in": found.shows_in,
        })
    });
    let own = own(diagnosis);
    object!({
        "schema": "gimbal-gap/1",
        "log": {
            "file": log, "rows": diagnosis.rows, "period_s": diagnosis.period_s, "first_s": diagnosis.first_s,
            "signals": ["effort"], "band_hz": diagnosis.band_hz, "columns": diagnosis.columns,
        },
        "model": { "file": model },
        "verdict": diagnosis.verdict.name(),
        "where": {
            "blocks": diagnosis.blocks.iter().map(|(name, share)| object!({ "name": name, "share": share })).collect::<Vec<_>>(),
            "signals": diagnosis.shrunk.iter().take(1).map(|s| object!({
                "name": s.name, "rms": s.before, "noise_floor": s.noise_floor, "unit": s.unit
            })).collect::<Vec<_>>(),
            "spans": diagnosis.spans.iter().map(|span| object!({
                "from_s": diagnosis.first_s + span.from_s, "to_s": diagnosis.first_s + span.to_s, "share": span.share
            })).collect::<Vec<_>>(),
            "regimes": diagnosis.regimes.iter().map(|r| object!({
                "name": r.name, "share": r.share, "time_share": r.time_share, "left": r.left
            })).collect::<Vec<_>>(),
            "bands": diagnosis.bands.iter().map(|b| object!({
                "from_hz": b.from_hz, "to_hz": b.to_hz, "share": b.share
            })).collect::<Vec<_>>(),
        },
        "effects": effects.collect::<Vec<_>>(),
        "unknown_probability": diagnosis.unknown_probability,
        "alternatives": alternatives(diagnosis).iter().map(|set| object!({
            "effects": set.effects, "probability": set.probability, "told_apart_by": apart(&own, &set.effects)
        })).collect::<Vec<_>>(),
        "shrink": { "held_out": true, "signals": signals().collect::<Vec<_>>() },
        "detectable": diagnosis.detectable.iter().map(|(name, size)| object!({ "name": name, "size": size })).collect::<Vec<_>>(),
        "ranking": diagnosis.ranking.iter().take(12).map(|set| object!({
            "effects": set.effects, "probability": set.probability
        })).collect::<Vec<_>>(),
        "notes": diagnosis.notes,
    })
}

/// Effects of the balance, which the alternatives are alternatives of.
fn own(diagnosis: &AxisDiagnosis) -> Vec<String> {
    let balanced = diagnosis.found.iter().filter(|found| found.shows_in == "effort");
    balanced.map(|found| found.effect.clone()).collect()
}

/// Alternatives belong to `cannot_tell` alone.
fn alternatives(diagnosis: &AxisDiagnosis) -> &[super::judge::Ranked] {
    if diagnosis.verdict == Verdict::CannotTell { &diagnosis.alternatives } else { &[] }
}

/// The experiment that tells two sets apart.
fn apart(own: &[String], other: &[String]) -> String {
    let a = own.iter().find(|name| !other.contains(name)).map_or("", String::as_str);
    let b = other.iter().find(|name| !own.contains(name)).map_or("", String::as_str);
    experiment(a, b).to_owned()
}

fn sentence(found: &Found) -> String {
    let parameters: Vec<String> = found
        .parameters
        .iter()
        .map(|p| {
            let unit = if p.unit == "1" { String::new() } else { format!(" {}", p.unit) };
            let error = if p.std > 0.0 { format!(" +- {:.1e}", p.std) } else { String::new() };
            format!("{} {:.4e}{error}{unit}", p.name, p.value)
        })
        .collect();
    format!("{} ({:.0} %; {})", found.effect, 100.0 * found.probability, parameters.join(", "))
}

/// A share in per cent, to be printed with one digit: what rounds to nothing has no sign.
fn percent(share: f64) -> f64 {
    if share.abs() < 5e-4 { 0.0 } else { 100.0 * share }
}

/// The verdict in words.
#[must_use]
pub fn text(diagnosis: &AxisDiagnosis) -> String {
    let mut out = String::new();
    let named: Vec<String> = diagnosis.found.iter().map(sentence).collect();
    let left = diagnosis.shrunk.first().map_or(0.0, |s| 100.0 - s.reduction_percent);
    let _ = match diagnosis.verdict {
        Verdict::NoGap => writeln!(out, "No gap: nothing beyond noise and the tolerance of the parameters."),
        Verdict::Explained => writeln!(out, "Explained by:"),
        Verdict::PartlyExplained => writeln!(out, "Partly explained; {left:.1} % of the gap's power remains:"),
        Verdict::Unexplained if named.is_empty() => writeln!(out, "A gap that no effect of the library explains."),
        Verdict::Unexplained => writeln!(out, "A gap that no effect of the library explains; what fits it best:"),
        Verdict::CannotTell => writeln!(out, "Cannot tell: this, or one of the sets below:"),
    };
    for (found, sentence) in diagnosis.found.iter().zip(&named) {
        let _ = match found.shows_in {
            "effort" => writeln!(out, "  {:5.1} %  {sentence}", percent(found.removes)),
            domain => writeln!(out, "  in the {domain}: {sentence}"),
        };
    }
    let own = own(diagnosis);
    let others: &[super::judge::Ranked] =
        if diagnosis.verdict == Verdict::Unexplained { &[] } else { &diagnosis.alternatives };
    for set in others.iter().take(4) {
        let instead: Vec<&str> = set.effects.iter().filter(|name| !own.contains(name)).map(String::as_str).collect();
        let of: Vec<&str> = own.iter().filter(|name| !set.effects.contains(name)).map(String::as_str).collect();
        if instead.is_empty() && of.is_empty() {
            continue;
        }
        let _ = writeln!(
            out,
            "  or ({:.0} %) {} instead of {}; to tell them apart: {}",
            100.0 * set.probability,
            if instead.is_empty() { "nothing".to_owned() } else { instead.join(" + ") },
            of.join(" + "),
            apart(&own, &set.effects)
        );
    }
    if diagnosis.unknown_probability > 0.05 {
        let _ = writeln!(out, "  something unknown: {:.0} %", 100.0 * diagnosis.unknown_probability);
    }
    for s in &diagnosis.shrunk {
        let [low, high] = s.ci95_percent;
        let _ = writeln!(
            out,
            "  {}: rms {:.4e} to {:.4e} {}, noise {:.1e}: {:.1} % of the gap's power gone ({low:.1} to {high:.1})",
            s.name,
            s.before,
            s.after,
            s.unit,
            s.noise_floor,
            percent(0.01 * s.reduction_percent)
        );
        if low <= 0.0 && diagnosis.verdict != Verdict::NoGap {
            let _ = writeln!(out, "    no improvement is shown: the interval includes zero");
        }
    }
    let mut regimes: Vec<_> = diagnosis.regimes.iter().collect();
    regimes.sort_by(|a, b| (b.share / b.time_share).total_cmp(&(a.share / a.time_share)));
    if !regimes.is_empty() {
        let told: Vec<String> = regimes
            .iter()
            .take(4)
            .map(|r| {
                format!("{} ({:.0} % of it in {:.0} % of the time)", r.name, 100.0 * r.share, 100.0 * r.time_share)
            })
            .collect();
        let _ = writeln!(out, "  densest: {}", told.join(", "));
    }
    let _ = writeln!(out, "Columns:");
    for words in &diagnosis.columns {
        let _ = writeln!(out, "  {words}");
    }
    if !diagnosis.notes.is_empty() {
        let _ = writeln!(out, "Notes:");
        for note in &diagnosis.notes {
            let _ = writeln!(out, "  {note}");
        }
    }
    out.trim_end().to_owned()
}

/// The page.
#[must_use]
pub fn html(diagnosis: &AxisDiagnosis, log: &str) -> String {
    let mut out = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>Gap: {0}</title><style>{STYLE}</style><h1>Gap between model and log: {0}</h1><pre>{1}</pre>",
        escaped(log),
        escaped(&text(diagnosis))
    );
    let lines = &diagnosis.lines;
    let effort = &diagnosis.effort_unit;
    let thin = |values: &[f64]| -> Vec<(f64, f64)> {
        let stride = (values.len() / 900).max(1);
        let chunks = values.chunks(stride).zip(lines.time_s.chunks(stride));
        chunks
            .flat_map(|(chunk, times)| {
                let (low, high) = chunk.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
                [(times[0], low), (times[0], high)]
            })
            .collect()
    };
    let difference = |of: &[f64]| -> Vec<f64> { lines.effort.iter().zip(of).map(|(u, m)| u - m).collect() };
    let line = |name, colour, values: &[f64]| Line { name, colour, points: thin(values) };
    out.push_str(&plot(
        &format!("effort [{effort}]: measured against what the motion needs"),
        "time [s]",
        &[
            line("measured", "#888", &lines.effort),
            line("nominal model", "#c0392b", &lines.nominal),
            line("with the effects found", "#1f77b4", &lines.fitted),
        ],
        &[],
        false,
    ));
    let marks: Vec<(f64, f64)> =
        diagnosis.spans.iter().map(|span| (diagnosis.first_s + span.from_s, diagnosis.first_s + span.to_s)).collect();
    out.push_str(&plot(
        &format!("residual [{effort}], with the spans of the effects"),
        "time [s]",
        &[line("before", "#c0392b", &difference(&lines.nominal)), line("after", "#1f77b4", &difference(&lines.fitted))],
        &marks,
        false,
    ));
    if diagnosis.curve.points.len() > 3 {
        let of = |place: usize| diagnosis.curve.points.iter().map(|p| (p[0], p[place])).collect::<Vec<_>>();
        let curves = [
            Line { name: "data, quartiles", colour: "#bbb", points: of(2) },
            Line { name: "data, quartiles", colour: "#bbb", points: of(3) },
            Line { name: "data, median", colour: "#444", points: of(1) },
            Line { name: "nominal model", colour: "#c0392b", points: of(4) },
            Line { name: "identified", colour: "#1f77b4", points: of(5) },
            Line { name: "2.5 %", colour: "#7fb6dc", points: of(6) },
            Line { name: "97.5 %", colour: "#7fb6dc", points: of(7) },
        ];
        out.push_str(&plot(
            &format!("friction [{effort}] over rate, with its 95 % band"),
            &format!("rate [{}/s]", diagnosis.position_unit),
            &curves,
            &[],
            false,
        ));
    }
    let spectrum = |which: usize| -> Vec<(f64, f64)> {
        let spectrum = &diagnosis.spectra[which];
        let lines = spectrum.power.iter().enumerate().skip(1);
        lines.map(|(line, power)| (line as f64 * spectrum.step_hz, power.max(1e-3))).collect()
    };
    out.push_str(&plot(
        "power of the residual over the noise",
        "frequency [Hz]",
        &[
            Line { name: "before", colour: "#c0392b", points: spectrum(0) },
            Line { name: "after", colour: "#1f77b4", points: spectrum(1) },
        ],
        &[],
        true,
    ));
    tables(&mut out, diagnosis);
    let _ = writeln!(out, "<script>{SCRIPT}</script></html>");
    out
}

fn tables(out: &mut String, diagnosis: &AxisDiagnosis) {
    let mut table = |title: &str, head: &str, rows: Vec<String>| {
        if !rows.is_empty() {
            let _ = write!(out, "<h2>{title}</h2><table><tr>{head}</tr>{}</table>", rows.concat());
        }
    };
    let row = |cells: &[String]| {
        format!("<tr>{}</tr>", cells.iter().map(|cell| format!("<td>{}</td>", escaped(cell))).collect::<String>())
    };
    let percent = |share: f64| format!("{:.1} %", percent(share));
    table(
        "Ranking",
        "<th>effects</th><th>probability</th>",
        diagnosis
            .ranking
            .iter()
            .take(10)
            .map(|set| {
                let name = if set.effects.is_empty() { "nominal model".to_owned() } else { set.effects.join(" + ") };
                row(&[name, percent(set.probability)])
            })
            .chain([row(&["unknown".to_owned(), percent(diagnosis.unknown_probability)])])
            .collect(),
    );
    table(
        "Blocks",
        "<th>block</th><th>share</th>",
        diagnosis.blocks.iter().map(|(name, share)| row(&[name.clone(), percent(*share)])).collect(),
    );
    table(
        "Regimes",
        "<th>regime</th><th>share of the gap</th><th>share of the time</th><th>rms left</th>",
        diagnosis
            .regimes
            .iter()
            .map(|r| row(&[r.name.clone(), percent(r.share), percent(r.time_share), percent(r.left)]))
            .collect(),
    );
    table(
        "Bands",
        "<th>band</th><th>share</th>",
        diagnosis.bands.iter().map(|b| row(&[format!("{} to {} Hz", b.from_hz, b.to_hz), percent(b.share)])).collect(),
    );
    table(
        "What would have been seen",
        "<th>effect</th><th>smallest amplitude (of its column)</th>",
        diagnosis
            .detectable
            .iter()
            .map(|(name, size)| {
                row(&[name.clone(), size.map_or("this log cannot show it".to_owned(), |size| format!("{size:.2e}"))])
            })
            .collect(),
    );
}
