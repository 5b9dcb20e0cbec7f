//! Stage `target-digests`: every board computes the bits that the host computes, with and without an FPU.

use super::{boards, emulator, image};
use crate::host;
use crate::stages::Note;
use anyhow::{Result, ensure};

pub(crate) fn check() -> Result<Note> {
    let expected = host::digests::release()?;
    let boards = boards::all()?;
    for board in &boards {
        let output = emulator::run(board, &image::of(board, "digest")?)?;
        ensure!(output == expected, "{} differs from the host\n{output}\nhost:\n{expected}", board.name);
        println!("{:<12} {:<12} {} digests equal the host's", board.name, board.core, output.lines().count());
    }
    Ok(format!("{} cases on {} boards", expected.lines().count(), boards.len()))
}
