//! `gap.html`: one file, no network.

use std::fmt::Write;

use super::picture::{Line, plot, thinned};
use crate::diagnose::Diagnosis;
use crate::fit::{predicted, raw_residual};

pub(crate) const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;max-width:1000px;margin:2em auto;padding:0 1em;color:#222}\
h1{font-size:1.4em}h2{font-size:1.1em;margin-top:1.6em}table{border-collapse:collapse}td,th{padding:2px 12px 2px 0;text-align:left;\
border-bottom:1px solid #ddd}svg{width:100%;height:auto}svg text{font-size:11px;fill:#555}.grid{stroke:#eee}.line{fill:none;\
stroke-width:1}.span{fill:#f5b04155}.legend{font-size:.85em;margin:.2em 0}figure{margin:1em 0}figcaption{font-weight:600}\
pre{white-space:pre-wrap;background:#f6f6f6;padding:.8em}@media print{body{margin:0}}";

/// The page.
#[must_use]
pub fn html(diagnosis: &Diagnosis, log: &str) -> String {
    let mut out = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>Gap: {0}</title><style>{STYLE}</style><h1>Gap between model and log: {0}</h1><pre>{1}</pre>",
        escaped(log),
        escaped(&super::text(diagnosis))
    );
    signals(&mut out, diagnosis);
    tables(&mut out, diagnosis);
    out.push_str("</html>\n");
    out
}

fn signals(out: &mut String, diagnosis: &Diagnosis) {
    let (Some(shrink), Some(fit)) = (&diagnosis.shrink, &diagnosis.fit) else { return };
    let record = &diagnosis.record;
    let (period_s, first_s) = (record.inputs.period_s, record.first_s);
    let thin = |values: &[f64]| thinned(values, period_s, first_s, 900);
    let (before, after) = (raw_residual(record, &shrink.nominal), raw_residual(record, &fit.prediction));
    let marks: Vec<(f64, f64)> =
        diagnosis.spans.iter().map(|span| (first_s + span.from_s, first_s + span.to_s)).collect();
    for (place, channel) in record.channels.iter().enumerate() {
        let column = channel.signal.column();
        let (name, unit) = (column.name(), column.unit());
        let _ = write!(out, "<h2>{name} [{unit}]</h2>");
        let model = predicted(channel.signal, &fit.prediction);
        let lines = [
            Line { name: "measured", colour: "#888", points: thin(&channel.values) },
            Line { name: "nominal model", colour: "#c0392b", points: thin(predicted(channel.signal, &shrink.nominal)) },
            Line { name: "with the effects found", colour: "#1f77b4", points: thin(model) },
        ];
        out.push_str(&plot("measured against model", "time [s]", &lines, &[], false));
        let lines = [
            Line { name: "before", colour: "#c0392b", points: thin(&before[place]) },
            Line { name: "after", colour: "#1f77b4", points: thin(&after[place]) },
        ];
        out.push_str(&plot("residual, with the spans of the effects", "time [s]", &lines, &marks, false));
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

fn tables(out: &mut String, diagnosis: &Diagnosis) {
    let mut table = |title: &str, head: &str, rows: Vec<String>| {
        if !rows.is_empty() {
            let _ = write!(out, "<h2>{title}</h2><table><tr>{head}</tr>{}</table>", rows.concat());
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
        Some(size) => format!("<tr><td>{}</td><td>{} {size:.2e} {}</td></tr>", d.effect, d.parameter, d.unit),
        None => format!("<tr><td>{}</td><td>this log cannot show it</td></tr>", d.effect),
    });
    table("What would have been seen", "<th>effect</th><th>smallest size</th>", sizes.collect());
}

pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
