//! Task `profile`: where the instructions of a step go, function by function of the source.
//!
//! The emulator writes down every instruction that runs inside the counted call of the program `cost`. What the compiler
//! inlined is told by the image's line tables, so each instruction falls to the function in whose source it stands. The
//! sum lies within a hundredth of the count that `cost` prints: the emulator notes some instructions twice, when its
//! timers make it start one again.

use super::boards::{self, Board};
use super::emulator;
use super::toolchain::Toolchain;
use crate::elf::{self, Image};
use crate::shell::{capture, program};
use anyhow::{Context, Result, anyhow, bail, ensure};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// Instructions by name of function, the number of steps that they come from, and on a Cortex-M0 their clocks.
struct Table {
    by_name: BTreeMap<String, u64>,
    steps: u64,
    clocks: Option<u64>,
}

pub(crate) fn print(board: &str) -> Result<()> {
    let board = boards::by_name(board)?;
    if !board.target.starts_with("thumb") {
        bail!("the profile is made for Arm boards alone");
    }
    let path = build(&board)?;
    let image = Image::read(&path)?;
    let functions = elf::functions(&image)?;
    let loader = addr2line::Loader::new(&path).map_err(|error| anyhow!("{}: {error}", path.display()))?;
    for (address, function) in &functions {
        if !function.name().ends_with("Counter::count::call") {
            continue;
        }
        let reached = elf::addresses(&functions, *address);
        let ranges: Vec<(u32, u32)> = reached.iter().map(|start| (*start, functions[start].bytes)).collect();
        let entry = (*address, address + function.bytes);
        let run = read(&trace(&board, &path, &ranges)?, entry, &image)?;
        let clocks = (board.core == "Cortex-M0").then_some(run.clocks);
        let mut by_name = BTreeMap::new();
        for (address, count) in run.by_address {
            *by_name.entry(name_of(address, &loader)?).or_default() += count;
        }
        let table = Table { by_name, steps: run.steps, clocks };
        print_table(&table);
    }
    Ok(())
}

/// `cost` with line tables, and short: 200 steps of the flight.
fn build(board: &Board) -> Result<PathBuf> {
    let toolchain = Toolchain::ready(&board.target)?;
    let words = "build --quiet --release --package gimbal-firmware --bin cost --features brief";
    let folder = toolchain.target_dir().join("profile");
    let mut command = toolchain.cargo(words, &board.target);
    command
        .env("GIMBAL_BOARD", &board.name)
        .env("CARGO_PROFILE_RELEASE_DEBUG", "line-tables-only")
        .env("CARGO_TARGET_DIR", &folder);
    capture(&mut command)?;
    Ok(folder.join(&board.target).join("release/cost"))
}

/// Every instruction run in `ranges`, as lines `Trace 0: HOST [../ADDRESS/..] NAME`.
fn trace(board: &Board, image: &Path, ranges: &[(u32, u32)]) -> Result<PathBuf> {
    emulator::ready(&board.emulator.program)?;
    let log = image.with_extension("trace");
    let filter: Vec<String> = ranges.iter().map(|(start, bytes)| format!("{start:#x}+{bytes:#x}")).collect();
    let mut command = program(&board.emulator.program);
    command
        .args(["-machine", &board.emulator.machine, "-nographic", "-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", "enable=on,target=native", "-icount", "shift=10,sleep=off"])
        .args(["-singlestep", "-d", "exec,nochain", "-dfilter", &filter.join(","), "-D"])
        .arg(&log)
        .arg("-kernel")
        .arg(image);
    capture(&mut command)?;
    Ok(log)
}

/// A trace added up.
#[derive(Default)]
struct Run {
    by_address: BTreeMap<u32, u64>,
    steps: u64,
    /// Were the core a Cortex-M0.
    clocks: u64,
}

/// Adds the trace up. A step begins at the start of the function `entry` and ends with a return in it; between two steps
/// the functions that a step calls may be called by others.
fn read(log: &Path, entry: (u32, u32), image: &Image) -> Result<Run> {
    let mut run = Run::default();
    let mut last = None;
    for line in BufReader::new(File::open(log)?).lines() {
        let line = line?;
        let Some(field) = line.split('/').nth(1) else { continue };
        let address = u32::from_str_radix(field, 16)?;
        // Noted twice: no instruction of a step goes to itself.
        if last == Some(address) {
            continue;
        }
        if let Some(before) = last {
            let instruction = image.half_word(before).context("code outside the image")?;
            run.clocks += u64::from(elf::cortex_m0(instruction, address == before + 2));
            if (entry.0..entry.1).contains(&before) && is_return(instruction) {
                last = None;
            }
        }
        if address == entry.0 {
            run.steps += 1;
        } else if last.is_none() {
            continue;
        }
        *run.by_address.entry(address).or_default() += 1;
        last = Some(address);
    }
    ensure!(run.steps > 0, "no step in the trace");
    Ok(run)
}

/// `pop {.., pc}` of either length, `bx lr`.
fn is_return(instruction: u16) -> bool {
    instruction & 0xFF00 == 0xBD00 || instruction == 0xE8BD || instruction == 0x4770
}

/// File and function of the source that the instruction belongs to; arithmetic falls to the function that calls it.
fn name_of(address: u32, loader: &addr2line::Loader) -> Result<String> {
    let mut frames = loader.find_frames(u64::from(address)).map_err(|error| anyhow!("{error}"))?;
    let mut last = String::from("?");
    while let Some(frame) = frames.next().map_err(|error| anyhow!("{error}"))? {
        let Some(function) = frame.function else { continue };
        let file = frame.location.and_then(|location| location.file).unwrap_or_default();
        let own = file.rsplit_once("src/").filter(|_| !file.contains("/library/") && !file.contains("/registry/"));
        let name = function.demangle().map_err(|error| anyhow!("{error}"))?;
        let Some((_, path)) = own else {
            last = name.into_owned();
            continue;
        };
        last = format!("{:<16} {name}", path.trim_end_matches(".rs"));
        if !ARITHMETIC.iter().any(|part| path.starts_with(part)) {
            break;
        }
    }
    Ok(last)
}

/// Files whose functions are operations, not blocks of the model.
const ARITHMETIC: [&str; 2] = ["number", "row"];

fn print_table(Table { by_name, steps, clocks }: &Table) {
    let mut rows: Vec<(&String, &u64)> = by_name.iter().collect();
    rows.sort_by_key(|(name, count)| (std::cmp::Reverse(**count), (*name).clone()));
    let total: u64 = by_name.values().sum();
    let mean = |count: u64| {
        let tenths = (count * 10 + steps / 2) / steps;
        format!("{}.{}", tenths / 10, tenths % 10)
    };
    println!("{:>9}  instructions a step, mean of {steps}", mean(total));
    if let Some(clocks) = clocks {
        println!("{:>9}  clocks of a Cortex-M0", mean(*clocks));
    }
    for (name, count) in rows {
        println!("{:>9}  {name}", mean(*count));
    }
    println!();
}
