//! Stage `target-hil`: the emulated board in the loop. Every shipped scenario in lockstep gives the host's bytes, the
//! serial port as well as the pipes; a killed emulator leaves a partial record and report. What the wire costs. And no
//! byte from the bench leads the board to a panic.

use super::boards::{self, Board, DEFAULT};
use super::{emulator, image};
use crate::elf::{self, Function, Image};
use crate::shell::{capture, cargo};
use crate::stages::Note;
use anyhow::{Context, Result, bail, ensure};
use std::collections::BTreeSet;
use std::path::Path;

pub(crate) fn check() -> Result<Note> {
    let board = boards::by_name(DEFAULT)?;
    panics(&board)?;
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

/// The functions that `firmware/src/bin/computer.rs` exports.
const ROOTS: [&str; 5] = ["wire_receive", "wire_emit", "computer_receive", "computer_take", "computer_silence"];
/// Where the gate ends: a model is built once, on command, while nothing steps.
const BUILD: &str = "gimbal_computer::axis::Axis<N>::build";

/// Passes if no byte from a bench leads to a panic or to a call that the image does not tell; and shows that the gate
/// closes on a frame that does.
fn panics(board: &Board) -> Result<()> {
    let ways = ways_to_panic(&image::computer(board, None)?)?;
    if !ways.is_empty() {
        bail!("{}: bytes from a bench can lead to a panic:\n{}", board.target, ways.join("\n"));
    }
    if ways_to_panic(&image::computer(board, Some("bad-panic"))?)?.is_empty() {
        bail!("{}: the gate let bad-panic through", board.target);
    }
    println!("{}: no byte from a bench leads to a panic; the gate closes", board.target);
    Ok(())
}

/// Every way from the roots to a panic or to an unknown function, the building of a model left out.
fn ways_to_panic(image: &Path) -> Result<Vec<String>> {
    let functions = elf::functions(&Image::read(image)?)?;
    let roots = ROOTS.iter().map(|root| {
        let named = |function: &Function| function.names.iter().any(|name| name == root);
        let (address, _) =
            functions.iter().find(|(_, function)| named(function)).with_context(|| format!("no {root}"))?;
        Ok((*address, (*root).to_owned()))
    });
    let mut open: Vec<(u32, String)> = roots.collect::<Result<_>>()?;
    let (mut seen, mut ways, mut built) = (BTreeSet::new(), Vec::new(), false);
    while let Some((address, path)) = open.pop() {
        if !seen.insert(address) {
            continue;
        }
        let function = functions.get(&address).with_context(|| format!("no function at {address:#x}"))?;
        let panics =
            |name: &String| name.contains("panic") || name.contains("index_fail") || name.contains("unwrap_failed");
        if function.name().contains(BUILD) {
            built = true;
            continue;
        }
        if function.names.iter().any(panics) || function.obstacles.iter().any(|what| what.contains("indirect call")) {
            ways.push(path);
            continue;
        }
        let named = |callee: &u32| functions.get(callee).map(Function::name).unwrap_or_default();
        open.extend(function.calls.iter().map(|callee| (*callee, format!("{path} > {}", named(callee)))));
    }
    // Where it is not a function of its own, its panics stand above, and the gate says so.
    ensure!(built || !ways.is_empty(), "no {BUILD} is reached");
    Ok(ways)
}
