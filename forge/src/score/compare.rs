//! One score against an older one of the same corpus: what was lost.

use serde::Deserialize;

use super::gates::Gate;
use super::rate::Rate;
use super::tally::{Group, Score};

/// The parts of a written score that are compared.
#[derive(Debug, Clone, Deserialize)]
pub struct Written {
    /// Figures.
    pub gates: Vec<Gate>,
    /// By what was put in.
    pub by_kind: Vec<WrittenGroup>,
    /// By motion.
    pub by_excitation: Vec<WrittenGroup>,
}

/// A group of a written score.
#[derive(Debug, Clone, Deserialize)]
pub struct WrittenGroup {
    /// Its name.
    pub name: String,
    /// Verdicts right.
    pub right: Rate,
}

/// A file of a score.
#[derive(Debug, Clone, Deserialize)]
pub struct File {
    /// The score.
    pub score: Written,
}

/// A figure and what it was.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// What is compared.
    pub what: String,
    /// Value and interval then.
    pub before: (f64, (f64, f64)),
    /// Value now.
    pub now: f64,
    /// Below what the interval then allows.
    pub lost: bool,
}

/// A value is lost when it lies beyond the interval it had on the side away from its limits, and does not keep them.
fn gate(before: &Gate, now: &Gate) -> Option<Change> {
    let (old, value) = (before.value?, now.value?);
    let (low, high) = before.interval;
    let worse = if value < before.limits.0 { value < low } else { value > before.limits.1 && value > high };
    Some(Change { what: before.what.clone(), before: (old, before.interval), now: value, lost: worse })
}

/// As for a gate; one log alone that turned is chance and no loss.
fn group(title: &str, before: &WrittenGroup, now: &Group) -> Option<Change> {
    let (old, value, interval) = (before.right.share()?, now.right.share()?, before.right.wilson());
    let what = format!("verdicts right, {title} {}", before.name);
    let turned = old * now.right.of as f64 - now.right.hits as f64;
    Some(Change { what, before: (old, interval), now: value, lost: value < interval.0 && turned > 1.5 })
}

/// Every figure that both have.
#[must_use]
pub fn compare(before: &Written, now: &Score) -> Vec<Change> {
    let mut changes: Vec<Change> = before
        .gates
        .iter()
        .filter_map(|old| now.gates.iter().find(|new| new.what == old.what).and_then(|new| gate(old, new)))
        .collect();
    for (title, old, new) in
        [("put in:", &before.by_kind, &now.by_kind), ("motion:", &before.by_excitation, &now.by_excitation)]
    {
        changes.extend(
            old.iter()
                .filter_map(|old| new.iter().find(|new| new.name == old.name).and_then(|new| group(title, old, new))),
        );
    }
    changes
}
