//! Stage `target-addresses`: each image lies where its board has memory.
//!
//! The root's `memory.x` shadows every other; an image linked with the wrong map would still build.

use super::boards::{self, Board};
use super::image;
use crate::elf::Image;
use crate::stages::Note;
use anyhow::{Result, ensure};

pub(crate) fn check() -> Result<Note> {
    let boards = boards::all()?;
    for board in &boards {
        let image = Image::read(&image::of(board, "calibrate")?)?;
        let used = check_image(board, &image)?;
        println!("{:<12} {used}", board.name);
    }
    Ok(format!("{} boards", boards.len()))
}

fn check_image(board: &Board, image: &Image) -> Result<String> {
    let Board { name, flash, ram, .. } = board;
    let start = image.sections.iter().filter(|section| section.loaded).map(|section| section.address).min();
    ensure!(start == Some(flash.origin), "{name}: the image starts at {start:#x?}, flash at {:#010x}", flash.origin);
    for section in image.sections.iter().filter(|section| section.bytes > 0) {
        let last = section.address + section.bytes - 1;
        let inside = |address| flash.contains(address) || ram.contains(address);
        ensure!(
            inside(section.address) && inside(last),
            "{name}: section {} at {:#010x} lies outside the board's memory",
            section.name,
            section.address
        );
    }
    // Linked for the end of the RAM, with the map of another board it would start elsewhere.
    let stack = image.symbol("_stack_start")?.address;
    ensure!(u64::from(stack) == ram.end(), "{name}: the stack starts at {stack:#010x}, RAM ends at {:#x}", ram.end());
    Ok(format!("flash from {:#010x}, stack from {stack:#010x}", flash.origin))
}
