//! Programs of `firmware/`, built for a board.

use super::boards::Board;
use super::toolchain::Toolchain;
use crate::shell::{capture, target_dir};
use anyhow::{Context, Result};
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;

/// Programs that run on a board; `step` is only looked at.
const PROGRAMS: [&str; 4] = ["calibrate", "cost", "digest", "flight"];

/// Image of `program` for `board`. All programs of a board are built at once, the first time one is asked for.
pub(crate) fn of(board: &Board, program: &str) -> Result<PathBuf> {
    static BUILT: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let mut built = BUILT.lock().expect("no build panics");
    if !built.contains(&board.name) {
        build(board, &PROGRAMS, None)?;
        built.insert(board.name.clone());
    }
    Ok(folder(board).join(program))
}

/// The program `step`, which holds nothing but the step; `feature` spoils it, or makes it that of another law.
pub(crate) fn step(board: &Board, feature: Option<&str>) -> Result<PathBuf> {
    build(board, &["step"], feature)?;
    Ok(folder(board).join("step"))
}

/// The same, linked although it can panic.
pub(crate) fn step_that_may_panic(board: &Board, law: Option<&str>) -> Result<PathBuf> {
    step(board, Some(&law.map_or("panic-allowed".into(), |law| format!("{law},panic-allowed"))))
}

/// The program `computer`, which holds nothing but what a board does with bytes from a bench; `feature` spoils it.
pub(crate) fn computer(board: &Board, feature: Option<&str>) -> Result<PathBuf> {
    build(board, &["computer"], feature)?;
    Ok(folder(board).join("computer"))
}

/// `program`, changed by `feature`.
pub(crate) fn with(board: &Board, program: &str, feature: &str) -> Result<PathBuf> {
    let (plain, changed) = (of(board, program)?, folder(board).join(format!("{program}-{feature}")));
    let kept = folder(board).join(format!("{program}-kept"));
    fs::copy(&plain, &kept)?;
    build(board, &[program], Some(feature))?;
    fs::rename(&plain, &changed)?;
    fs::rename(&kept, &plain)?;
    Ok(changed)
}

/// An example of the firmware, with the feature that it needs.
pub(crate) fn example(board: &Board, name: &str, feature: Option<&str>) -> Result<PathBuf> {
    let toolchain = Toolchain::ready(&board.target)?;
    let words = format!("build --quiet --release --package gimbal-firmware --example {name}");
    let mut command = toolchain.cargo(&words, &board.target);
    command.args(feature.iter().flat_map(|feature| ["--features", feature]));
    capture(command.env("GIMBAL_BOARD", &board.name)).with_context(|| format!("board {}", board.name))?;
    Ok(toolchain.target_dir().join(&board.target).join("release/examples").join(name))
}

/// The program `step` with the compiler's record of its stack frames.
pub(crate) fn step_with_stack_sizes(board: &Board) -> Result<PathBuf> {
    let toolchain = Toolchain::ready(&board.target)?;
    let words = "build --quiet --release --package gimbal-firmware --bin step";
    let mut command = toolchain.cargo(words, &board.target);
    // Other flags would throw away what the other stages have built.
    let folder = toolchain.target_dir().join("stack-sizes");
    command
        .env("GIMBAL_BOARD", &board.name)
        .env("RUSTC_BOOTSTRAP", "1")
        .env("RUSTFLAGS", format!("{} -Z emit-stack-sizes", toolchain.flags()))
        .env("CARGO_TARGET_DIR", &folder);
    capture(&mut command)?;
    Ok(folder.join(&board.target).join("release/step"))
}

/// Folder of the programs for a bench: `hil`, `hil_fifo`, and `wire`, which counts what frames cost.
pub(crate) fn hil(board: &Board) -> Result<PathBuf> {
    build(board, &["hil", "hil_fifo", "wire"], None)?;
    Ok(folder(board))
}

fn folder(board: &Board) -> PathBuf {
    target_dir().join("boards").join(&board.name)
}

fn build(board: &Board, programs: &[&str], feature: Option<&str>) -> Result<()> {
    let toolchain = Toolchain::ready(&board.target)?;
    let mut command = toolchain.cargo("build --quiet --release --package gimbal-firmware", &board.target);
    for program in programs {
        command.args(["--bin", program]);
    }
    if let Some(feature) = feature {
        command.args(["--features", feature]);
    }
    capture(command.env("GIMBAL_BOARD", &board.name)).with_context(|| format!("board {}", board.name))?;
    // Boards of one target share cargo's folder, so the images are taken out of it.
    let from = toolchain.target_dir().join(&board.target).join("release");
    fs::create_dir_all(folder(board))?;
    for program in programs {
        fs::copy(from.join(program), folder(board).join(program))?;
    }
    Ok(())
}
