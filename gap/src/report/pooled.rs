//! The page of several logs taken together.

use std::fmt::Write;

use super::html::{STYLE, escaped};
use crate::pool::Pool;

/// The page; `names` are those of the logs.
#[must_use]
pub fn pooled(pool: &Pool, names: &[String]) -> String {
    let mut out = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>Gap over {0} logs</title><style>{STYLE}</style><h1>Gap between model and {0} logs</h1><pre>{1}</pre>",
        pool.logs.len(),
        escaped(&pool.text(names))
    );
    let mut table = |title: &str, head: &str, rows: Vec<String>| {
        if !rows.is_empty() {
            let _ = write!(out, "<h2>{title}</h2><table><tr>{head}</tr>{}</table>", rows.concat());
        }
    };
    let set = |effects: &[&str]| if effects.is_empty() { "nominal model".to_owned() } else { effects.join(" + ") };
    let percent = |name: &str, share: f64| format!("<tr><td>{name}</td><td>{:.1} %</td></tr>", 100.0 * share);
    table(
        "Ranking over all logs",
        "<th>effects</th><th>probability</th>",
        pool.sets
            .iter()
            .take(8)
            .map(|own| percent(&set(&own.effects), own.probability))
            .chain([percent("unknown", pool.unknown_probability)])
            .collect(),
    );
    table(
        "Parameters from run to run",
        "<th>parameter</th><th>log</th><th>value</th><th>standard error</th>",
        pool.shared
            .iter()
            .flat_map(|own| {
                let verdict = if own.drifts() { "drifts" } else { "the same" };
                let all = format!(
                    "<tr><td><b>{} {}</b></td><td>all: {verdict}</td><td><b>{:.4e}</b></td><td>{:.1e} {}</td></tr>",
                    own.effect, own.parameter, own.mean[0], own.mean[1], own.unit
                );
                let each = own.values.iter().map(|(log, value, error)| {
                    format!(
                        "<tr><td></td><td>{}</td><td>{value:.4e}</td><td>{error:.1e}</td></tr>",
                        escaped(&names[*log])
                    )
                });
                std::iter::once(all).chain(each).collect::<Vec<_>>()
            })
            .collect(),
    );
    table(
        "Each log under the model corrected from the others",
        "<th>log</th><th>signal</th><th>nominal</th><th>corrected</th>",
        pool.unseen
            .iter()
            .flat_map(|(log, signals)| {
                signals.iter().map(|own| {
                    format!(
                        "<tr><td>{}</td><td>{}</td><td>{:.3e}</td><td>{:.3e} {}</td></tr>",
                        escaped(&names[*log]),
                        own.name,
                        own.before,
                        own.after,
                        own.unit
                    )
                })
            })
            .collect(),
    );
    out.push_str("</html>\n");
    out
}
