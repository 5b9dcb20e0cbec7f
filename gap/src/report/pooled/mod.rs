//! The page of several logs taken together.

mod forest;

use std::fmt::Write;

use super::html::{STYLE, escaped};
use crate::pool::told::nats;
use crate::pool::{Pool, PooledSet, Shared};

/// Sets that are listed.
const SETS: usize = 8;

/// The page; `names` are those of the logs.
#[must_use]
pub fn pooled(pool: &Pool, names: &[String]) -> String {
    let mut out = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>Gap over {0} logs</title><style>{STYLE}</style><h1>Gap between model and {0} logs</h1><pre>{1}</pre>",
        pool.logs.len(),
        escaped(&pool.text(names))
    );
    let charts = |title: &str, all: &[Shared]| {
        let drawn: String =
            all.iter().filter(|own| own.values.len() > 1).map(|own| forest::forest(own, names)).collect();
        if drawn.is_empty() { drawn } else { format!("<h2>{title}</h2>{drawn}") }
    };
    out.push_str(&charts("Parameters from run to run", &pool.shared));
    out.push_str(&charts("Nominal parameters that drift from run to run", &pool.drifting));
    let mut table = |title: &str, head: &str, rows: Vec<String>| {
        if !rows.is_empty() {
            let _ = write!(out, "<h2>{title}</h2><table><tr>{head}</tr>{}</table>", rows.concat());
        }
    };
    table(
        "Ranking over all logs",
        "<th>effects</th><th>probability</th><th>evidence [nats]</th><th>needed to be named [nats]</th>",
        pool.sets.iter().take(SETS).map(set).chain([unknown(pool.unknown_probability)]).collect(),
    );
    table(
        "Values",
        "<th>parameter</th><th>log</th><th>value</th><th>standard error</th>",
        pool.shared.iter().chain(&pool.drifting).flat_map(|own| values(own, names)).collect(),
    );
    let named = |log: usize| escaped(&names[log]);
    table(
        "Each log in the fit to all: chi-square over its noise",
        "<th>log</th><th>samples</th><th>nominal parameters</th><th>with what is named</th>",
        pool.fits
            .iter()
            .map(|own| {
                let (log, samples) = (named(own.log), own.samples);
                format!("<tr><td>{log}</td><td>{samples}</td><td>{:.1}</td><td>{:.1}</td></tr>", own.before, own.after)
            })
            .collect(),
    );
    table(
        "Each log under the model corrected from the others: rms of what is left",
        "<th>log</th><th>signal</th><th>nominal</th><th>corrected</th><th>unit</th>",
        pool.unseen
            .iter()
            .flat_map(|(log, signals)| {
                signals.iter().map(|own| {
                    let (log, name, unit) = (named(*log), own.name, own.unit);
                    format!(
                        "<tr><td>{log}</td><td>{name}</td><td>{:.3e}</td><td>{:.3e}</td><td>{unit}</td></tr>",
                        own.before, own.after
                    )
                })
            })
            .collect(),
    );
    out.push_str("</html>\n");
    out
}

fn set(own: &PooledSet) -> String {
    let name = if own.effects.is_empty() { "nominal model".to_owned() } else { own.effects.join(" + ") };
    let evidence = match own {
        _ if own.effects.is_empty() => "0".to_owned(),
        // what an effect of no size or a parameter inside its tolerance has against it has no figure
        own if own.nats < -100.0 => "ruled out".to_owned(),
        own if own.is_fitted => nats(own.nats),
        own => format!("{}, not fitted", nats(own.nats)),
    };
    let cost = if own.effects.is_empty() { String::new() } else { format!("{:.0}", own.cost) };
    format!("<tr><td>{name}</td><td>{:.1} %</td><td>{evidence}</td><td>{cost}</td></tr>", 100.0 * own.probability)
}

fn unknown(probability: f64) -> String {
    format!("<tr><td>unknown</td><td>{:.1} %</td><td></td><td></td></tr>", 100.0 * probability)
}

fn values(own: &Shared, names: &[String]) -> Vec<String> {
    let kind = if own.drifts { "one value for all, which they do not prefer" } else { "one value for all" };
    let all = format!(
        "<tr><td><b>{} {}</b></td><td>{kind}</td><td><b>{:.4e}</b></td><td>{:.1e} {}</td></tr>",
        own.effect, own.parameter, own.mean[0], own.mean[1], own.unit
    );
    let each = own.values.iter().map(|(log, value, error)| {
        format!("<tr><td></td><td>{}</td><td>{value:.4e}</td><td>{error:.1e}</td></tr>", escaped(&names[*log]))
    });
    std::iter::once(all).chain(each).collect()
}
