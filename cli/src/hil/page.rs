//! The report of a run on one page that needs no other file.

use std::fmt::Write;

use gimbal_bench::report::{started, value};
use gimbal_bench::run::{Outcome, Pace, Verdict};

use super::live::{GAP, Live};
use crate::exit::Failure;
use crate::plot::{Figure, Line, Panel};

const STYLE: &str = "body{font:16px/1.45 sans-serif;color:#222;max-width:1040px;margin:2em auto;padding:0 1em}\
table{border-collapse:collapse;width:100%;font-size:14px;margin:.6em 0}th,td{border-bottom:1px solid #d6d6d6;\
padding:.35em .5em;text-align:left;vertical-align:top}th{border-bottom:2px solid #222}td.bad{background:#deccA0;\
font-weight:bold}.verdict{font-size:22px;font-weight:bold;border:2px solid #222;padding:.2em .6em;display:inline-block}\
.no{background:#deccA0}figure{margin:1.5em 0}figure svg{width:100%;height:auto}code{font-size:13px}\
.sign{margin-top:2.5em}.sign td{height:2.6em;width:34%}.sign td:nth-child(odd){width:16%;border:0}\
pre{background:#f4f4f4;padding:1em;font-size:13px;overflow-x:auto}";

/// Where people sign; the digests above say what.
const SIGNATURE: &str = "<table class=\"sign\"><tr><td>Flown by</td><td></td><td>Judged by</td><td></td></tr>\
<tr><td>Date, signature</td><td></td><td>Date, signature</td><td></td></tr></table>\n</body></html>\n";

/// The page.
pub(super) fn html(outcome: &Outcome, live: &Live) -> Result<String, Failure> {
    let scenario = &outcome.scenario;
    let no = if outcome.verdict == Verdict::Pass { "" } else { " no" };
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{name}: {verdict}</title>\
         <style>{STYLE}</style></head><body>\n<h1>Hardware in the loop: {name}</h1>\n<p>{about}</p>\n\
         <p><span class=\"verdict{no}\">{verdict}</span></p>\n<p>{target}; begun {started}</p>\n",
        name = escaped(&scenario.name),
        verdict = outcome.verdict.name(),
        about = escaped(&scenario.about),
        target = escaped(&outcome.target),
        started = started(outcome),
    );
    if let Some(error) = &outcome.error {
        let [done, planned] = outcome.ticks;
        let told = escaped(&error.to_string());
        let _ = writeln!(page, "<p>The run ended after {done} of {planned} ticks: <b>{told}</b></p>");
    }
    requirements(&mut page, outcome);
    page.push_str("<h2>Course</h2>\n<figure>");
    page.push_str(&picture(live)?);
    page.push_str("</figure>\n");
    table(&mut page, "Measures", &outcome.measures.iter().map(|(k, v)| (*k, value(Some(*v)))).collect::<Vec<_>>());
    let bits: Vec<_> = outcome.bits.iter().map(|(name, at_s)| (*name, format!("{at_s:.3} s"))).collect();
    table(&mut page, "Bits raised, first time", &bits);
    table(&mut page, "Link and deadlines", &link(outcome));
    table(&mut page, "Versions and digests", &versions(outcome));
    let _ = writeln!(page, "<h2>Scenario</h2>\n<pre>{}</pre>", escaped(&scenario.text));
    page.push_str(SIGNATURE);
    Ok(page)
}

fn requirements(page: &mut String, outcome: &Outcome) {
    page.push_str(
        "<h2>Requirements</h2>\n<table><tr><th>requirement</th><th>limit</th><th>measured</th><th>verdict</th></tr>\n",
    );
    for judged in &outcome.requirements {
        // What a run that was broken off has kept so far is no pass.
        let (class, word) = match (judged.passed, outcome.verdict) {
            (true, Verdict::Aborted) => ("", "kept so far"),
            (true, _) => ("", "pass"),
            (false, Verdict::Aborted) => (" class=\"bad\"", "not kept so far"),
            (false, _) => (" class=\"bad\"", "fail"),
        };
        let (name, limit) = (escaped(&judged.name), escaped(&judged.limit));
        let _ = writeln!(
            page,
            "<tr><td>{name}</td><td>{limit}</td><td>{}</td><td{class}>{word}</td></tr>",
            value(judged.value)
        );
    }
    let (class, word) = match outcome.host_equals_board {
        Some(true) if outcome.verdict == Verdict::Aborted => ("", "kept so far"),
        Some(true) => ("", "pass"),
        Some(false) => (" class=\"bad\"", "fail"),
        None => (" class=\"bad\"", "no answer"),
    };
    let difference =
        outcome.first_difference_s.map_or_else(String::new, |at_s| format!("first difference at {at_s} s"));
    let _ = writeln!(
        page,
        "<tr><td>board equals host</td><td>every byte</td><td>{difference}</td><td{class}>{word}</td></tr>\n</table>"
    );
}

fn picture(live: &Live) -> Result<String, Failure> {
    let shaded = live.not_running.spans_above(0.5);
    let panels = vec![
        Panel::new("phi", "rad", vec![Line::new("true", &live.truth), Line::new("estimate", &live.estimate)]),
        Panel::new("Estimate less truth", "rad", vec![Line::new("error", &live.error)])
            .with_band("+- 2 sigma", &live.bounds),
        Panel::new("theta", "rad", vec![Line::new("true", &live.theta)]),
        Panel::new("Motor torque", "N m", vec![Line::new("true", &live.torque)]),
        Panel::new("Specific force along y", "m/s2", vec![Line::new("true", &live.accel)]),
        Panel::new("Vehicle rate", "rad/s", vec![Line::new("true", &live.rate)]),
    ];
    let shaded_name = format!("no running estimate for {GAP} ticks");
    let figure = Figure { title: "Platform and estimate", panels, shaded: &shaded, shaded_name: &shaded_name };
    let svg = figure.draw().map_err(|error| Failure::Environment(anyhow::Error::msg(error)))?;
    Ok(svg[svg.find("<svg").unwrap_or(0)..].to_owned())
}

fn link(outcome: &Outcome) -> Vec<(&'static str, String)> {
    let deadlines = &outcome.deadlines;
    let microseconds =
        |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{:.0} us", 1e6 * value));
    let simulated_s = f64::from(outcome.ticks[0]) * outcome.period_s;
    let mut rows = vec![
        ("computer", outcome.target.clone()),
        ("clock", outcome.pace.name().to_owned()),
        ("ticks, planned", format!("{}, {}", outcome.ticks[0], outcome.ticks[1])),
        ("simulated, elapsed", format!("{simulated_s:.1} s, {:.2} s", outcome.elapsed_s)),
        ("bytes down, up", format!("{}, {}", outcome.link.bytes[0], outcome.link.bytes[1])),
        ("bench: frames accepted, refused, lost", {
            format!("{}, {}, {}", outcome.link.accepted, outcome.link.refused, outcome.link.lost)
        }),
        ("computer: frames refused, lost, late, ignored; ticks without a frame", {
            let names = ["refused_frames", "lost_frames", "stale_frames", "ignored_frames", "held_ticks"];
            let counts = names.map(|name| value(outcome.measures.get(format!("board_{name}").as_str()).copied()));
            counts.join(", ")
        }),
        ("ticks asked again", outcome.link.asked_again.to_string()),
        ("latency p50, p99, p99.9, largest", {
            let at = [0.5, 0.99, 0.999, 1.0].map(|share| microseconds(deadlines.latency_s(share)));
            at.join(", ")
        }),
    ];
    if outcome.pace == Pace::RealTime {
        rows.push(("late answers", deadlines.late.to_string()));
        let at = [0.5, 0.99, 1.0].map(|share| microseconds(deadlines.start_s(share)));
        rows.push(("start of a tick behind its time: p50, p99, largest", at.join(", ")));
    }
    rows
}

fn versions(outcome: &Outcome) -> Vec<(&'static str, String)> {
    let hex = |digest: u64| format!("{digest:016x}");
    vec![
        ("bench", env!("CARGO_PKG_VERSION").to_owned()),
        ("protocol", gimbal_wire::VERSION.to_string()),
        ("flight code: bench, board", format!("{}, {}", hex(outcome.builds[0]), hex(outcome.builds[1]))),
        ("model: scenario, board", format!("{}, {}", hex(outcome.models[0]), hex(outcome.models[1]))),
        ("program on the board", outcome.image.map_or_else(|| "-".to_owned(), hex)),
        ("text of the scenario", hex(outcome.text)),
        ("seed", outcome.scenario.seed.to_string()),
        ("digest of all answers", hex(outcome.digest)),
    ]
}

fn table(page: &mut String, title: &str, rows: &[(&str, String)]) {
    if rows.is_empty() {
        return;
    }
    let _ = writeln!(page, "<h2>{title}</h2>\n<table>");
    for (name, text) in rows {
        let _ = writeln!(page, "<tr><td>{}</td><td>{}</td></tr>", escaped(name), escaped(text));
    }
    page.push_str("</table>\n");
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
