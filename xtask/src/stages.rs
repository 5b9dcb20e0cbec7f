//! The named stages of `cargo xtask test`: run in order, timed, summed up in a table at the end.
//!
//! A failed stage does not stop the later ones: one run shows everything that is wrong.

use crate::{board, host, shell};
use anyhow::Result;
use std::fmt;
use std::time::{Duration, Instant};

/// What a passed stage has to say in the table: a count, a figure, or nothing.
pub(crate) type Note = String;

/// What all stages together leave on the disk, from nothing, rounded up.
const DISK_GB: f64 = 8.0;

/// One stage: its name, and what it does.
struct Stage {
    name: &'static str,
    run: fn() -> Result<Note>,
}

/// Something that a check needs is not on this machine and cannot be put there: the message says what to install.
#[derive(Debug)]
pub(crate) struct Missing(pub(crate) String);

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Missing {}

/// Stages to run, in order.
pub(crate) struct Stages(Vec<Stage>);

impl Stages {
    /// Every stage. The quick ones come first; the host's tests come last, so that a log ends with their results.
    pub(crate) fn all() -> Self {
        Self(vec![
            Stage { name: "format", run: host::format::check },
            Stage { name: "licences", run: host::licences::check },
            Stage { name: "lints", run: host::lints::check },
            Stage { name: "documents", run: host::documents::check },
            Stage { name: "oldest-rust", run: host::oldest_rust::check },
            Stage { name: "package", run: host::package::check },
            Stage { name: "digests", run: host::digests::check },
            Stage { name: "target-setup", run: board::setup::check },
            Stage { name: "target-lints", run: board::lints::check },
            Stage { name: "target-counter", run: board::calibration::check },
            Stage { name: "target-addresses", run: board::addresses::check },
            Stage { name: "target-digests", run: board::digests::check },
            Stage { name: "target-flight", run: board::flight::check },
            Stage { name: "target-log", run: board::log::check },
            Stage { name: "target-examples", run: board::examples::check },
            Stage { name: "c-interface", run: board::c::check },
            Stage { name: "target-hil", run: board::hil::check },
            Stage { name: "target-gates", run: board::gates::check },
            Stage { name: "target-stack", run: board::stack::check },
            Stage { name: "target-budget", run: board::budget::check },
            Stage { name: "fuzz", run: host::fuzz::check },
            Stage { name: "blind", run: host::blind::check },
            Stage { name: "tests", run: host::tests::run },
        ])
    }

    /// Those whose name contains `text`.
    pub(crate) fn only(self, text: &str) -> Self {
        Self(self.0.into_iter().filter(|stage| stage.name.contains(text)).collect())
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn list(&self) {
        for stage in &self.0 {
            println!("{}", stage.name);
        }
    }

    /// Runs them all; the exit status.
    pub(crate) fn run(&self) -> u8 {
        let start = Instant::now();
        let free_gb = shell::free_disk_gb();
        if self.0.len() > 1 && free_gb.is_some_and(|free| free < DISK_GB) {
            println!(
                "only {:.1} GB of disk are free: all stages together leave about {DISK_GB} GB",
                free_gb.unwrap_or_default()
            );
        }
        let mut rows = Vec::new();
        for (index, stage) in self.0.iter().enumerate() {
            println!("\n=== {}/{} {} ===", index + 1, self.0.len(), stage.name);
            let stage_start = Instant::now();
            let outcome = (stage.run)();
            let time = stage_start.elapsed();
            match &outcome {
                Ok(note) => println!("--- {}: passed in {:.1} s  {note}", stage.name, time.as_secs_f64()),
                Err(error) => println!("--- {}: FAILED after {:.1} s\n{error:#}", stage.name, time.as_secs_f64()),
            }
            rows.push((stage.name, time, outcome));
        }
        if let (Some(before), Some(after)) = (free_gb, shell::free_disk_gb()) {
            println!("\ndisk: {before:.1} GB were free, {after:.1} GB are");
        }
        summary(&rows, start.elapsed())
    }
}

fn summary(rows: &[(&str, Duration, Result<Note>)], total: Duration) -> u8 {
    println!("\n{:<24} {:>8}  result", "stage", "time");
    for (name, time, outcome) in rows {
        let result = match outcome {
            Ok(note) => format!("passed  {note}"),
            Err(error) => format!("FAILED  {}", error.to_string().lines().next().unwrap_or_default()),
        };
        println!("{name:<24} {:>6.1} s  {result}", time.as_secs_f64());
    }
    let failed: Vec<_> = rows.iter().filter_map(|(name, _, outcome)| Some((name, outcome.as_ref().err()?))).collect();
    println!(
        "{} stages, {} failed, {:.0} s{}",
        rows.len(),
        failed.len(),
        total.as_secs_f64(),
        if failed.is_empty() { "" } else { "; one by itself: cargo xtask test --only NAME" }
    );
    match failed.as_slice() {
        [] => 0,
        some if some.iter().all(|(_, error)| error.is::<Missing>()) => 3,
        _ => 1,
    }
}
