//! Stage `target-log` and task `flight`: the flight's log by defmt, decoded.
//!
//! The board sends numbers; `defmt-print` of the project that made them turns them into text with the image at hand. It
//! is a program of its own, and not a library of this one, because its features would change what JSON is to the others.

use super::boards::{self, Board};
use super::{emulator, image};
use crate::shell::{cargo, program, run, target_dir, version_of};
use crate::stages::{Missing, Note};
use anyhow::{Context, Result, bail, ensure};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// The release whose table format the firmware's defmt writes.
const RELEASE: &str = "1.2.0";

/// The log of a plain flight can be read, and that of one whose ticks are made too long says so.
pub(crate) fn check() -> Result<Note> {
    let board = boards::by_name(boards::DEFAULT)?;
    let (text, success) = fly(&board, "defmt")?;
    print!("{text}");
    ensure!(success, "the flight fails with its log by defmt:\n{text}");
    for part in ["INFO", "0.000", "faults {}", "phi ", "; estimate ", "{saturated", "deadlines missed 0,"] {
        ensure!(text.contains(part), "no `{part}` in the log:\n{text}");
    }
    let lines = text.lines().count();
    let (text, success) = fly(&board, "defmt,overload")?;
    ensure!(
        !success && text.contains("WARN") && text.contains("deadlines missed 10,"),
        "no warning in the log:\n{text}"
    );
    Ok(format!("{lines} lines decoded, the warning of an overload too"))
}

/// Flies on a board and prints the log.
pub(crate) fn print(board: &str) -> Result<()> {
    let (text, success) = fly(&boards::by_name(board)?, "defmt")?;
    print!("{text}");
    if success { Ok(()) } else { bail!("the flight failed") }
}

fn fly(board: &Board, features: &str) -> Result<(String, bool)> {
    let decoder = ready()?;
    let shift = board.emulator.flight_shift.with_context(|| format!("`flight` does not run on {}", board.name))?;
    let image = image::with(board, "flight", features)?;
    let (bytes, errors, success) = emulator::run_to_end_raw(board, &image, shift)?;
    Ok((decode(&decoder, &image, &bytes)? + &errors, success))
}

/// The decoder, which is built if it is not there.
fn ready() -> Result<PathBuf> {
    if version_of("defmt-print").is_some() {
        return Ok("defmt-print".into());
    }
    let folder = target_dir().join("tools");
    let path = folder.join("bin/defmt-print");
    if !path.exists() {
        let words = format!("install --quiet defmt-print --version {RELEASE} --locked");
        run(cargo(&words).arg("--root").arg(&folder)).map_err(|error| {
            Missing(format!(
                "{error:#}\ndefmt-print is needed: `cargo install defmt-print --version {RELEASE} --locked`"
            ))
        })?;
    }
    Ok(path)
}

fn decode(decoder: &Path, image: &Path, bytes: &[u8]) -> Result<String> {
    let mut child = program(&decoder.to_string_lossy())
        .arg("-e")
        .arg(image)
        .args(["--log-format", "{t} {L:5} {s}"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .context("cannot start defmt-print")?;
    let mut input = child.stdin.take().context("no input")?;
    let bytes = bytes.to_vec();
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output()?;
    writer.join().expect("writing does not panic")?;
    ensure!(output.status.success(), "defmt-print failed ({})", output.status);
    Ok(String::from_utf8(output.stdout)?)
}
