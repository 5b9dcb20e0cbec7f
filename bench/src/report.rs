//! Reports of a run: JSON, `JUnit` XML and text; schema `gimbal-hil/1` in `docs/hil.md`.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::judge::Judged;
use crate::run::{Outcome, Pace, Verdict};

/// The report as JSON.
#[must_use]
pub fn json(outcome: &Outcome) -> Value {
    let hex = |digest: u64| format!("{digest:016x}");
    let seconds = |value: Option<f64>| value.map_or(Value::Null, |value| json!(value));
    let deadlines = &outcome.deadlines;
    let simulated_s = f64::from(outcome.ticks[0]) * outcome.period_s;
    json!({
        "schema": "gimbal-hil/1",
        "scenario": outcome.scenario.name,
        "about": outcome.scenario.about,
        "started": started(outcome),
        "verdict": outcome.verdict.name(),
        "error": outcome.error.as_ref().map(ToString::to_string),
        "requirements": outcome.requirements.iter().map(requirement).collect::<Vec<_>>(),
        "measures": outcome.measures,
        "raised_s": outcome.bits,
        "link": {
            "target": outcome.target,
            "bytes_down": outcome.link.bytes[0],
            "bytes_up": outcome.link.bytes[1],
            "bench_accepted": outcome.link.accepted,
            "bench_refused": outcome.link.refused,
            "bench_lost": outcome.link.lost,
            "asked_again": outcome.link.asked_again,
        },
        "deadlines": {
            "pace": outcome.pace.name(),
            "ticks": outcome.ticks[0],
            "ticks_planned": outcome.ticks[1],
            "period_s": outcome.period_s,
            "elapsed_s": outcome.elapsed_s,
            "times_real_time": if outcome.elapsed_s > 0.0 { json!(simulated_s / outcome.elapsed_s) } else { Value::Null },
            "latency_p50_s": seconds(deadlines.latency_s(0.5)),
            "latency_p99_s": seconds(deadlines.latency_s(0.99)),
            "latency_p999_s": seconds(deadlines.latency_s(0.999)),
            "latency_max_s": seconds(deadlines.latency_s(1.0)),
            "start_jitter_p99_s": seconds(deadlines.start_s(0.99)),
            "start_jitter_max_s": seconds(deadlines.start_s(1.0)),
            "late_frames": if outcome.pace == Pace::RealTime { json!(deadlines.late) } else { Value::Null },
        },
        "host_equals_board": outcome.host_equals_board,
        "first_difference_s": outcome.first_difference_s,
        "versions": {
            "bench": env!("CARGO_PKG_VERSION"),
            "protocol": gimbal_wire::VERSION,
            "bench_build": hex(outcome.builds[0]),
            "board_build": hex(outcome.builds[1]),
            "scenario_model": hex(outcome.models[0]),
            "board_model": hex(outcome.models[1]),
            "board_image": outcome.image.map(hex),
            "scenario": hex(outcome.text),
            "seed": outcome.scenario.seed,
        },
        "digest": hex(outcome.digest),
    })
}

/// When the run began, UTC.
#[must_use]
pub fn started(outcome: &Outcome) -> String {
    humantime::format_rfc3339_seconds(outcome.started).to_string()
}

fn requirement(judged: &Judged) -> Value {
    json!({ "name": judged.name, "limit": judged.limit, "value": judged.value, "passed": judged.passed })
}

/// `JUnit` XML: a suite for each run, a test for each requirement.
#[must_use]
pub fn junit(outcomes: &[Outcome]) -> String {
    let mut xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"gimbal hil\">\n".to_owned();
    for outcome in outcomes {
        let failed = outcome.requirements.iter().filter(|judged| !judged.passed).count();
        let aborted = outcome.error.as_ref().map(ToString::to_string);
        let differs = outcome.host_equals_board == Some(false);
        let _ = writeln!(
            xml,
            "  <testsuite name=\"{}\" timestamp=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3}\">",
            escaped(&outcome.scenario.name),
            started(outcome).trim_end_matches('Z'),
            outcome.requirements.len() + 2,
            failed + usize::from(differs),
            u8::from(aborted.is_some()),
            outcome.elapsed_s
        );
        let mut case = |name: &str, problem: Option<(&str, String)>| {
            let head =
                format!("    <testcase classname=\"{}\" name=\"{}\"", escaped(&outcome.scenario.name), escaped(name));
            let _ = match problem {
                None => writeln!(xml, "{head}/>"),
                Some((kind, text)) => writeln!(xml, "{head}><{kind} message=\"{}\"/></testcase>", escaped(&text)),
            };
        };
        case("the run reaches its end", aborted.map(|text| ("error", text)));
        let text = outcome.first_difference_s.map(|time_s| format!("first different byte at {time_s} s"));
        case(
            "host equals board",
            differs.then(|| ("failure", text.unwrap_or_else(|| "answers are missing".to_owned()))),
        );
        for judged in &outcome.requirements {
            let text = format!("{}: {}, limit {}", judged.name, value(judged.value), judged.limit);
            case(&judged.name, (!judged.passed).then_some(("failure", text)));
        }
        xml.push_str("  </testsuite>\n");
    }
    xml.push_str("</testsuites>\n");
    xml
}

/// The report as text.
#[must_use]
pub fn text(outcome: &Outcome) -> String {
    let simulated_s = f64::from(outcome.ticks[0]) * outcome.period_s;
    let mut text =
        format!("{}: {}\n{}\n", outcome.scenario.name, outcome.verdict.name().to_uppercase(), outcome.target);
    for judged in &outcome.requirements {
        let mark = match (judged.passed, outcome.verdict) {
            (true, Verdict::Aborted) => "so far",
            (true, _) => "ok  ",
            (false, _) => "FAIL",
        };
        let _ = writeln!(text, "  {mark:<6} {:<34} {:>12}   limit {}", judged.name, value(judged.value), judged.limit);
    }
    if outcome.verdict == Verdict::Aborted {
        let [done, planned] = outcome.ticks;
        let _ = writeln!(text, "  ended after {done} of {planned} ticks");
    }
    let equal = match (outcome.host_equals_board, outcome.first_difference_s) {
        (Some(true), _) => "equals the host's, byte for byte".to_owned(),
        (Some(false), Some(time_s)) => format!("DIFFERS from the host's at {time_s} s"),
        (Some(false), None) => "DIFFERS from the host's".to_owned(),
        (None, _) => "has not answered".to_owned(),
    };
    let _ = writeln!(text, "  board {equal}; digest {:016x}", outcome.digest);
    if outcome.builds[0] != outcome.builds[1] {
        text.push_str("  NOTE the board runs flight code of another source than this bench\n");
    }
    if outcome.elapsed_s > 0.0 {
        let _ = write!(
            text,
            "  {simulated_s:.1} s in {:.2} s, {:.1} x real time",
            outcome.elapsed_s,
            simulated_s / outcome.elapsed_s
        );
    }
    if outcome.pace == Pace::RealTime {
        let microseconds = |share| outcome.deadlines.latency_s(share).unwrap_or_default() * 1e6;
        let _ = write!(
            text,
            "; latency p50 {:.0} us, p99 {:.0} us, p99.9 {:.0} us, largest {:.0} us; {} late",
            microseconds(0.5),
            microseconds(0.99),
            microseconds(0.999),
            microseconds(1.0),
            outcome.deadlines.late
        );
    }
    text
}

/// A value in few digits.
#[must_use]
pub fn value(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(value) if value.fract().abs() < f64::MIN_POSITIVE && value.abs() < 1e9 => format!("{value:.0}"),
        Some(value) if (0.01..1e6).contains(&value.abs()) => format!("{value:.4}"),
        Some(value) => format!("{value:.3e}"),
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
