//! Stage `target-digests`: every board computes the bits that the host computes, with and without an FPU.

use super::{boards, emulator, image};
use crate::host;
use crate::stages::Note;
use anyhow::{Result, ensure};

/// A platform of three gimbals and its estimators need this much; boards with less end with the lines before.
const WHOLE_RAM_BYTES: u32 = 128 * 1024;
/// Lines that every board prints: the axis alone, nominal and with effects.
const LEAST_LINES: usize = 12;

pub(crate) fn check() -> Result<Note> {
    let expected = host::digests::release()?;
    let boards = boards::all()?;
    for board in &boards {
        let output = emulator::run(board, &image::of(board, "digest")?)?;
        let all = board.ram.length_bytes >= WHOLE_RAM_BYTES;
        let enough = if all { output == expected } else { output.lines().count() >= LEAST_LINES };
        ensure!(
            enough && expected.starts_with(&output),
            "{} differs from the host\n{output}\nhost:\n{expected}",
            board.name
        );
        println!("{:<12} {:<12} {} digests equal the host's", board.name, board.core, output.lines().count());
    }
    Ok(format!("up to {} cases on {} boards", expected.lines().count(), boards.len()))
}
