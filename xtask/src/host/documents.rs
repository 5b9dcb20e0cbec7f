//! Stage `documents`: rustdoc builds without a warning, so every link in a comment leads somewhere.
//!
//! One kind of warning is expected: a unit in brackets, `[rad]`, looks to rustdoc like a link. It is printed as
//! written, which is what is wanted.

use crate::shell::{capture, cargo};
use crate::stages::Note;
use anyhow::{Result, bail};
use serde::Deserialize;

#[derive(Deserialize)]
struct Line {
    message: Option<Message>,
}

#[derive(Deserialize)]
struct Message {
    #[serde(rename = "message")]
    text: String,
    rendered: Option<String>,
    level: String,
}

/// Units and measures of one word; rustdoc takes nothing with a space or a slash for a link.
const UNITS: &[&str] = &[
    "s",
    "ms",
    "us",
    "rad",
    "mrad",
    "deg",
    "m",
    "kg",
    "K",
    "N",
    "W",
    "J",
    "Hz",
    "g",
    "rpm",
    "cSt",
    "lbf",
    "percent",
    "bytes",
    "px",
    "nats",
    "rms",
    "1",
    "pixels",
    "rows",
    "ticks",
    "instructions",
];

pub(crate) fn check() -> Result<Note> {
    let output =
        capture(&mut cargo("doc --quiet --workspace --no-deps --document-private-items --message-format json"))?;
    let mut complaints = Vec::new();
    for line in output.lines() {
        let line: Line = serde_json::from_str(line)?;
        let Some(message) = line.message else { continue };
        if message.level != "note" && !is_unit(&message.text) {
            complaints.push(message.rendered.unwrap_or(message.text));
        }
    }
    if complaints.is_empty() { Ok(Note::new()) } else { bail!("{}", complaints.join("\n")) }
}

/// "unresolved link to `s`", and the closing "3 warnings emitted".
fn is_unit(text: &str) -> bool {
    let unit = text.strip_prefix("unresolved link to `").and_then(|rest| rest.strip_suffix('`'));
    unit.is_some_and(|unit| UNITS.contains(&unit)) || text.ends_with("emitted")
}
