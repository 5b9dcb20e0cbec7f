//! Stage `target-counter`: on every board the instruction counter reads sequences of known length exactly.

use super::{boards, emulator, image};
use crate::stages::Note;
use anyhow::{Result, ensure};

pub(crate) fn check() -> Result<Note> {
    let boards = boards::all()?;
    for board in &boards {
        let output = emulator::run(board, &image::of(board, "calibrate")?)?;
        let passed = output.lines().filter(|line| line.ends_with(" ok")).count();
        println!("{}: {passed} sequences counted exactly", board.name);
        ensure!(passed == 6, "{}: 6 sequences were expected\n{output}", board.name);
    }
    Ok(format!("{} boards", boards.len()))
}
