//! Stage `target-stack`: the frames that are read from the binary are those that the compiler says it made.
//!
//! The budget's stack bound comes from decoding the image, which covers the run-time library too. Here the same step is
//! built with `-Z emit-stack-sizes`, and every function that the compiler names must have the frame that was decoded.

use super::boards;
use super::image;
use crate::elf::{self, Image};
use crate::stages::Note;
use anyhow::{Context, Result, ensure};

pub(crate) fn check() -> Result<Note> {
    let mut compared = 0;
    for board in boards::one_for_each_target()? {
        let path = image::step_with_stack_sizes(&board)?;
        let functions = elf::functions(&Image::read(&path)?)?;
        for (address, told) in elf::stack_sizes(&path)? {
            let function = functions.get(&address).with_context(|| format!("no function at {address:#x}"))?;
            // Decoding adds up what every path takes, so it may lie above, never below.
            ensure!(
                function.frame_bytes >= told || !function.obstacles.is_empty(),
                "{}: {} takes {told} bytes, decoded {}",
                board.target,
                function.name(),
                function.frame_bytes
            );
            compared += 1;
        }
    }
    ensure!(compared > 20, "only {compared} functions carry their stack size");
    Ok(format!("{compared} functions"))
}
