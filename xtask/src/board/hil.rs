//! Stage `target-hil`: the emulated board in the loop. Every shipped scenario in lockstep gives the host's bytes, the
//! serial port as well as the pipes; a killed emulator leaves a partial record and report. And what the wire costs.

use super::boards::{self, DEFAULT};
use super::{emulator, image};
use crate::shell::{capture, cargo};
use crate::stages::Note;
use anyhow::{Context, Result};

pub(crate) fn check() -> Result<Note> {
    let board = boards::by_name(DEFAULT)?;
    if let Err(error) = emulator::ready(&board.emulator.program) {
        println!("SKIPPED: {error:#}");
        return Ok(format!("SKIPPED: {} is not there", board.emulator.program));
    }
    let images = image::hil(&board)?;
    let cost = emulator::run(&board, &images.join("wire"))?;
    print!("{cost}");
    let mut tests = cargo("test --package gimbal-cli --profile checked --test hil_emulated -- --nocapture");
    let output = capture(tests.env("GIMBAL_HIL_IMAGES", &images))?;
    let speed = |what: &str| output.lines().find(|line| line.contains(what)).map(str::to_owned);
    let fifo = speed("x real time").context("no rate over the pipes")?;
    let uart = speed("exchanges a second").context("no rate over the serial port")?;
    println!("pipes: {fifo}\nserial port: {uart}");
    Ok(format!("pipes {fifo}; serial port {uart}"))
}
