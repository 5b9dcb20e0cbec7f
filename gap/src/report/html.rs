//! `gap.html`: one file, no network.

use std::fmt::Write;

use super::picture::{Line, SCRIPT, Tube, chart, plot, thinned};
use crate::diagnose::Diagnosis;
use crate::judge::{Seen, Verdict, experiment};

pub(crate) const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;max-width:1000px;margin:2em auto;padding:0 1em;color:#222}\
h1{font-size:1.4em}h2{font-size:1.1em;margin-top:1.6em}table{border-collapse:collapse}td,th{padding:2px 12px 2px 0;text-align:left;\
border-bottom:1px solid #ddd}figure>svg{width:100%;height:auto}svg text{font-size:11px;fill:#555}.grid{stroke:#eee}.line{fill:none;\
stroke-width:1;vector-effect:non-scaling-stroke}.span{fill:#f5b04155}.tube{opacity:.25}.chosen{fill:#1f77b433}\
.chart svg{touch-action:pan-y;cursor:crosshair;user-select:none}.hint{color:#777;font-size:.85em}.legend{font-size:.85em;margin:.2em 0}figure{margin:1em 0}figcaption{font-weight:600}\
pre{white-space:pre-wrap;background:#f6f6f6;padding:.8em}@media print{body{margin:0;max-width:none;font-size:12px}.hint{display:none}figure,table,tr{break-inside:avoid}h2{break-after:avoid}\
.columns{columns:2}}.columns{columns:2;column-gap:2em}.columns section{break-inside:avoid}.columns td:last-child:not(:only-child),.columns td:nth-child(n+3){white-space:nowrap}@media(max-width:700px){.columns{columns:1}}";

/// The page.
#[must_use]
pub fn html(diagnosis: &Diagnosis, log: &str) -> String {
    let mut out = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>Gap: {0}</title><style>{STYLE}</style><h1>Gap between model and log: {0}</h1><pre>{1}</pre>",
        escaped(log),
        escaped(&super::text(diagnosis))
    );
    out.push_str("<p class=\"hint\">Drag in a chart to zoom, Shift and drag to move, double click for all of it.</p>");
    told_apart(&mut out, diagnosis);
    left_over(&mut out, diagnosis);
    signals(&mut out, diagnosis);
    friction(&mut out, diagnosis);
    out.push_str("<div class=\"columns\">");
    tables(&mut out, diagnosis);
    let _ = writeln!(out, "</div><script>{SCRIPT}</script></html>");
    out
}

fn signals(out: &mut String, diagnosis: &Diagnosis) {
    let [before, after] = &diagnosis.residuals;
    let record = &diagnosis.record;
    let (period_s, first_s) = (record.inputs.period_s, record.first_s);
    let marks: Vec<(f64, f64)> =
        diagnosis.spans.iter().map(|span| (first_s + span.from_s, first_s + span.to_s)).collect();
    let named = diagnosis.decision.as_ref().is_some_and(|decision| !decision.found.is_empty());
    let fitted = if named { "with the effects found" } else { "nominal parameters fitted" };
    let residual = if marks.is_empty() { "residual" } else { "residual, with the spans of the effects" };
    for (place, (channel, (before, after))) in record.channels.iter().zip(before.iter().zip(after)).enumerate() {
        let column = channel.signal.column();
        let (name, unit) = (column.name(), column.unit());
        let _ = write!(out, "<h2>{name} [{unit}]</h2>");
        let thin = |values: &[f64]| thinned(values, period_s, first_s, 1500, |row| !channel.is_missing(row));
        let model = |residual: &[f64]| -> Vec<f64> {
            channel.values.iter().zip(residual).map(|(measured, residual)| measured - residual).collect()
        };
        let lines = [
            Line { name: "measured", colour: "#888", points: thin(&channel.values) },
            Line { name: "nominal model", colour: "#c0392b", points: thin(&model(before)) },
            Line { name: fitted, colour: "#1f77b4", points: thin(&model(after)) },
        ];
        out.push_str(&plot("measured against model", "time [s]", &lines, &[], false));
        let lines = [
            Line { name: "before", colour: "#c0392b", points: thin(before) },
            Line { name: "after", colour: "#1f77b4", points: thin(after) },
        ];
        out.push_str(&plot(residual, "time [s]", &lines, &marks, false));
        let spectrum = |which: usize| -> Vec<(f64, f64)> {
            let spectrum = &diagnosis.spectra[which][place];
            spectrum
                .power
                .iter()
                .enumerate()
                .skip(1)
                .map(|(line, power)| (line as f64 * spectrum.step_hz, power.max(1e-2)))
                .collect()
        };
        let floor =
            spectrum(0).first().zip(spectrum(0).last()).map_or(Vec::new(), |(a, b)| vec![(a.0, 1.0), (b.0, 1.0)]);
        let lines = [
            Line { name: "before", colour: "#c0392b", points: spectrum(0) },
            Line { name: "after", colour: "#1f77b4", points: spectrum(1) },
            Line { name: "noise", colour: "#222", points: floor },
        ];
        out.push_str(&plot("power of the residual over the noise", "frequency [Hz]", &lines, &[], true));
    }
}

/// What could not be told apart, and what would tell it.
fn told_apart(out: &mut String, diagnosis: &Diagnosis) {
    let Some(decision) = diagnosis.decision.as_ref().filter(|decision| decision.verdict == Verdict::CannotTell) else {
        return;
    };
    let own = decision.found.first().map_or("", |found| found.effect);
    let rows: Vec<String> = decision
        .alternatives
        .iter()
        .map(|set| {
            let other = set.effects.iter().find(|effect| !decision.found.iter().any(|found| found.effect == **effect));
            let told = experiment(own, other.copied().unwrap_or_default());
            format!(
                "<tr><td>{}</td><td>{:.0} %</td><td>{told}</td></tr>",
                set.effects.join(" + "),
                100.0 * set.probability
            )
        })
        .collect();
    let _ = write!(
        out,
        "<h2>Could not be told apart</h2><table><tr><th>or</th><th>probability</th><th>experiment that tells</th></tr>{}</table>",
        rows.concat()
    );
}

/// The portrait of what is left.
fn left_over(out: &mut String, diagnosis: &Diagnosis) {
    let Some(portrait) = &diagnosis.portrait else { return };
    let row = |name: &str, value: &str| format!("<tr><td>{name}</td><td>{}</td></tr>", escaped(value));
    let listed = |all: &[(String, f64)]| {
        let each: Vec<String> = all.iter().map(|(name, share)| format!("{name} ({:.0} %)", 100.0 * share)).collect();
        if each.is_empty() { "nothing that was tried".to_owned() } else { each.join("; ") }
    };
    let nearest: Vec<(String, f64)> =
        portrait.nearest.iter().map(|(name, share)| ((*name).to_owned(), *share)).collect();
    let regimes: Vec<&str> = portrait.regimes.iter().map(|regime| regime.name).collect();
    let first_s = diagnosis.record.first_s;
    let mut rows = vec![row("signal", &format!("{}, rms {:.2e} {}", portrait.signal, portrait.rms[0], portrait.unit))];
    if let Some((name, share)) = &portrait.block {
        rows.push(row("nearest block", &format!("{name} ({:.0} %)", 100.0 * share)));
    }
    if let Some(band) = portrait.band {
        rows.push(row("band", &format!("{} to {} Hz ({:.0} %)", band.from_hz, band.to_hz, 100.0 * band.share)));
    }
    rows.push(row("regimes", &if regimes.is_empty() { "none".to_owned() } else { regimes.join("; ") }));
    rows.push(row(
        "when",
        &format!(
            "60 % of it in {:.0} % of the time; the shortest stretch with as much: {:.1} to {:.1} s",
            100.0 * portrait.burst_share,
            first_s + portrait.span_s[0],
            first_s + portrait.span_s[1]
        ),
    ));
    let goes_with = diagnosis.decision.iter().find_map(|decision| decision.goes_with());
    rows.extend(goes_with.map(|stranger| row("goes with", &stranger.to_string())));
    if goes_with.is_none() || !portrait.depends_on.is_empty() {
        rows.push(row("follows", &listed(&portrait.depends_on)));
    }
    rows.push(row("effects that would take some", &listed(&nearest)));
    let _ = write!(out, "<h2>What is left</h2><table>{}</table>", rows.concat());
}

/// Friction over the rate, as the log has it.
fn friction(out: &mut String, diagnosis: &Diagnosis) {
    let curve = &diagnosis.curve;
    if curve.is_empty() {
        return;
    }
    let of = |value: &dyn Fn(&crate::judge::CurvePoint) -> f64| -> Vec<(f64, f64)> {
        curve.iter().map(|point| (point.rate_radps, value(point))).collect()
    };
    let lines = [
        Line { name: "nominal model", colour: "#c0392b", points: of(&|point| point.nominal_nm) },
        Line { name: "as fitted", colour: "#1f77b4", points: of(&|point| point.fitted_nm) },
        Line { name: "as the log has it", colour: "#444", points: of(&|point| point.measured_nm) },
    ];
    let edge = |point: &crate::judge::CurvePoint, side: f64| point.measured_nm + 2.0 * side * point.error_nm;
    let tube = Tube {
        name: "two standard errors",
        colour: "#444",
        points: curve.iter().map(|point| (point.rate_radps, edge(point, -1.0), edge(point, 1.0))).collect(),
    };
    out.push_str("<h2>Friction [N m]</h2>");
    out.push_str(&chart("friction over the bearing's rate", "rate [rad/s]", &lines, &[], false, Some(&tube)));
}

fn tables(out: &mut String, diagnosis: &Diagnosis) {
    let mut table = |title: &str, head: &str, rows: Vec<String>| {
        if !rows.is_empty() {
            let _ = write!(out, "<section><h2>{title}</h2><table><tr>{head}</tr>{}</table></section>", rows.concat());
        }
    };
    let percent =
        |name: &str, share: f64| format!("<tr><td>{}</td><td>{:.1} %</td></tr>", escaped(name), 100.0 * share);
    if let Some(decision) = &diagnosis.decision {
        let rows = decision.ranking.iter().take(10).map(|set| {
            let name = if set.effects.is_empty() { "nominal model".to_owned() } else { set.effects.join(" + ") };
            percent(&name, set.probability)
        });
        table(
            "Ranking",
            "<th>effects</th><th>probability</th>",
            rows.chain([percent("unknown", decision.unknown_probability)]).collect(),
        );
    }
    table(
        "Blocks",
        "<th>block</th><th>share</th>",
        diagnosis.blocks.iter().map(|(name, share)| percent(name, *share)).collect(),
    );
    let regimes = diagnosis.regimes.iter().map(|r| {
        format!("<tr><td>{}</td><td>{:.1} %</td><td>{:.1} %</td></tr>", r.name, 100.0 * r.share, 100.0 * r.time_share)
    });
    table("Regimes", "<th>regime</th><th>share of the gap</th><th>share of the time</th>", regimes.collect());
    let bands = diagnosis.bands.iter().map(|b| percent(&format!("{} to {} Hz", b.from_hz, b.to_hz), b.share));
    table("Bands", "<th>band</th><th>share</th>", bands.collect());
    let sizes = diagnosis.detectable.iter().map(|d| match d.size {
        Some(size) => {
            // a ratio has no unit: its name says of what
            let unit = if d.unit == "1" { d.parameter } else { d.unit };
            let side = if d.seen == Seen::Below { "at or below " } else { "" };
            format!("<tr><td>{}</td><td>{side}{size:.2e} {unit}</td></tr>", d.effect)
        }
        None => format!("<tr><td>{}</td><td>this log cannot show it</td></tr>", d.effect),
    });
    let yardsticks = [("one step ahead", &diagnosis.one_step), ("reference plant, free", &diagnosis.free_running)];
    let rows = yardsticks.into_iter().flat_map(|(how, all)| {
        all.iter().map(move |own| {
            format!(
                "<tr><td>{how}</td><td>{}</td><td>{:.2e}</td><td>{:.2e} {}</td></tr>",
                own.name, own.before, own.after, own.unit
            )
        })
    });
    table("How far, by other yardsticks", "<th>how</th><th>signal</th><th>before</th><th>after</th>", rows.collect());
    let rows = diagnosis
        .correlations
        .iter()
        .map(|own| format!("<tr><td>{}</td><td>{}</td><td>{:.2}</td></tr>", own.value, own.other, own.correlation));
    table("Values that move together", "<th>value</th><th>with</th><th>correlation</th>", rows.collect());
    let rows = diagnosis.bounds_hit.iter().map(|hit| format!("<tr><td>{}</td></tr>", escaped(hit)));
    table("At the end of its range", "<th>value</th>", rows.collect());
    table("What would have been seen", "<th>effect</th><th>smallest size</th>", sizes.collect());
    let rows = diagnosis.not_looked_for.iter().map(|effect| format!("<tr><td>{effect}</td></tr>"));
    table("Not looked for: known to be good, or in the model already", "<th>effect</th>", rows.collect());
}

pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
