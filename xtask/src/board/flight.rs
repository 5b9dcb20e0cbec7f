//! Stage `target-flight`: a minute of flight at 1 kHz on every board, model, estimator and gap monitor in the tick, with
//! laws from images and nothing in the program that computes with doubles: all that they tell equal to the host's, no
//! deadline missed; and with a tick that is made too long, or rows left out, each is counted, and the watchdog bites.

use super::boards::{self, Board};
use super::{emulator, gates, image};
use crate::shell::{capture, cargo};
use crate::stages::Note;
use anyhow::{Context, Result, ensure};

pub(crate) fn check() -> Result<Note> {
    let expected = capture(&mut cargo("run --quiet --release --package gimbal-firmware --bin flight"))?;
    let mut flown = 0;
    for board in &boards::all()? {
        let Some(shift) = board.emulator.flight_shift else { continue };
        let (output, success) = emulator::run_to_end(board, &image::of(board, "flight")?, shift)?;
        ensure!(success, "{}:\n{output}", board.name);
        let digest = output.lines().find(|line| line.starts_with("flight ")).unwrap_or_default();
        ensure!(expected.lines().any(|line| line == digest), "{}: {digest}\nhost:\n{expected}", board.name);
        gates::without_doubles(&image::of(board, "flight")?)?;
        println!("{:<12} {}", board.name, output.trim_end().replace('\n', "; "));
        flown += 1;
    }
    let board = boards::by_name(boards::DEFAULT)?;
    // The gate closes on a program that builds a law itself.
    ensure!(gates::without_doubles(&image::of(&board, "digest")?).is_err(), "the gate let `digest` through");
    overload_is_counted(&board)?;
    missing_rows_are_counted(&board)?;
    watchdog_bites(&board)?;
    Ok(format!(
        "a minute on {flown} boards, no doubles in the program; overload and missing rows counted, watchdog bites"
    ))
}

/// Ten ticks of one period and a half: ten misses, reported, and nothing hidden by the steps that follow in time.
fn overload_is_counted(board: &Board) -> Result<()> {
    let (output, success) = fly(board, "overload")?;
    ensure!(!success && output.contains("deadlines missed 10,"), "an overload of ten ticks gives:\n{output}");
    println!(
        "{:<12} overload: {}",
        board.name,
        output.lines().find(|line| line.contains("without a row")).unwrap_or_default()
    );
    Ok(())
}

/// Three ticks for which no row has come: counted, reported, and none of them late or left out.
fn missing_rows_are_counted(board: &Board) -> Result<()> {
    let (output, success) = fly(board, "no-rows")?;
    let counts = "deadlines missed 0, ticks without a row 3, outputs lost 0";
    ensure!(!success && output.contains(counts), "three rows left out give:\n{output}");
    println!("{:<12} rows left out: {counts}", board.name);
    Ok(())
}

/// Every tick too long: the idle loop may never run again, and the watchdog is what ends it.
fn watchdog_bites(board: &Board) -> Result<()> {
    board.watchdog.as_ref().context("the default board has a watchdog")?;
    let (output, success) = fly(board, "hang")?;
    ensure!(!success && output.contains("watchdog: not fed"), "a tick that is always too long gives:\n{output}");
    println!("{:<12} hang: {}", board.name, output.trim_end());
    Ok(())
}

fn fly(board: &Board, feature: &str) -> Result<(String, bool)> {
    let shift = board.emulator.flight_shift.context("the default board flies")?;
    emulator::run_to_end(board, &image::with(board, "flight", feature)?, shift)
}
