//! A value over the logs: each log's own with two standard errors, and the band of the one that they share.

use std::fmt::Write;

use crate::pool::Shared;
use crate::report::html::escaped;
use crate::report::picture::{label, ticks};

const WIDTH: f64 = 960.0;
/// Place of the names, and of what stands right of the last tick [px].
const LEFT: f64 = 200.0;
const RIGHT: f64 = 40.0;
const TOP: f64 = 8.0;
const ROW: f64 = 22.0;
/// Room for ticks and the axis' name [px].
const BOTTOM: f64 = 44.0;
/// Standard errors that are drawn.
const ERRORS: f64 = 2.0;
/// Letters of a log's name.
const LETTERS: usize = 28;

/// The chart; `names` are those of the logs.
pub(super) fn forest(own: &Shared, names: &[String]) -> String {
    let [mean, std] = own.mean;
    let reach = |(value, error): (f64, f64)| [value - ERRORS * error, value + ERRORS * error];
    let all = own.values.iter().map(|(_, value, error)| (*value, *error)).chain([(mean, std)]).flat_map(reach);
    let (low, high) =
        all.filter(|end| end.is_finite()).fold((f64::MAX, f64::MIN), |(l, h), end| (l.min(end), h.max(end)));
    let margin = if high > low { 0.06 * (high - low) } else { 0.5 * high.abs().max(1e-12) };
    let (low, high) = (low - margin, high + margin);
    let rows = own.values.len() as f64 + 1.0;
    let (bottom, height) = (TOP + ROW * rows, TOP + ROW * rows + BOTTOM);
    let x = |value: f64| LEFT + (value - low) / (high - low) * (WIDTH - LEFT - RIGHT);
    let mut out = format!(
        "<figure><figcaption>{} {} [{}]: {}</figcaption><svg viewBox=\"0 0 {WIDTH} {height}\" role=\"img\">",
        own.effect,
        own.parameter,
        own.unit,
        escaped(&own.preference())
    );
    for tick in ticks(low, high, false) {
        let at = x(tick);
        let _ = write!(
            out,
            "<path d=\"M{at:.1} {TOP}V{bottom}\" class=\"grid\"/><text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            bottom + 16.0,
            label(tick, false)
        );
    }
    let _ = write!(
        out,
        "<text x=\"{:.1}\" y=\"{}\" text-anchor=\"middle\">{} [{}], with two standard errors</text>",
        0.5 * (LEFT + WIDTH - RIGHT),
        bottom + 34.0,
        own.parameter,
        own.unit
    );
    let [from, to] = reach((mean, std));
    let _ = write!(
        out,
        "<rect x=\"{:.1}\" y=\"{TOP}\" width=\"{:.1}\" height=\"{}\" class=\"chosen\"/>",
        x(from),
        (x(to) - x(from)).max(1.0),
        bottom - TOP
    );
    let each = own.values.iter().map(|(log, value, error)| (shortened(&names[*log]), *value, *error, "#555"));
    let shared = ("one value for all logs".to_owned(), mean, std, "#1f77b4");
    for (row, (name, value, error, colour)) in each.chain([shared]).enumerate() {
        let at = TOP + ROW * (row as f64 + 0.5);
        let [from, to] = reach((value, error)).map(x);
        let _ = write!(
            out,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>\
             <path d=\"M{from:.1} {at}H{to:.1}\" stroke=\"{colour}\" stroke-width=\"2\"/>\
             <circle cx=\"{:.1}\" cy=\"{at}\" r=\"4\" fill=\"{colour}\"/>",
            LEFT - 8.0,
            at + 4.0,
            escaped(&name),
            x(value)
        );
    }
    out.push_str("</svg></figure>");
    out
}

/// The end of a name, which tells logs apart.
fn shortened(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    match letters.len().checked_sub(LETTERS) {
        Some(more) if more > 0 => format!("\u{2026}{}", letters[more..].iter().collect::<String>()),
        _ => name.to_owned(),
    }
}
