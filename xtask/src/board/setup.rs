//! Stage `target-setup`: compilers and emulators for every board are there, or are installed now.

use super::{boards, emulator, toolchain::Toolchain};
use crate::stages::Note;
use anyhow::Result;
use std::collections::BTreeSet;

pub(crate) fn check() -> Result<Note> {
    let boards = boards::all()?;
    let targets: BTreeSet<&str> = boards.iter().map(|board| board.target.as_str()).collect();
    let mut ways = BTreeSet::new();
    for target in &targets {
        ways.insert(format!("{:?}", Toolchain::ready(target)?).to_lowercase());
    }
    let emulators: BTreeSet<&str> = boards.iter().map(|board| board.emulator.program.as_str()).collect();
    for program in emulators {
        println!("{}", emulator::ready(program)?);
    }
    for board in &boards {
        println!("{:<12} {:<12} {:<30} {}", board.name, board.core, board.target, board.emulator.machine);
    }
    let ways: Vec<String> = ways.into_iter().collect();
    Ok(format!("{} boards, {} targets by {}", boards.len(), targets.len(), ways.join(" and ")))
}
