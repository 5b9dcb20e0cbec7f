//! The boards: one file each in `firmware/boards/`, read by `firmware/build.rs` too.

use crate::shell::root;
use anyhow::{Context, Result, bail};
use serde::Deserialize;
use std::fs;

/// One board, as its file describes it.
#[derive(Debug, Deserialize)]
pub(crate) struct Board {
    /// The file's name.
    #[serde(skip)]
    pub(crate) name: String,
    /// The core, as its vendor writes it.
    pub(crate) core: String,
    /// Rust's target triple.
    pub(crate) target: String,
    pub(crate) flash: Region,
    pub(crate) ram: Region,
    pub(crate) emulator: Emulator,
    pub(crate) watchdog: Option<toml::Table>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Region {
    pub(crate) origin: u32,
    pub(crate) length_bytes: u32,
}

impl Region {
    pub(crate) fn contains(&self, address: u32) -> bool {
        address.checked_sub(self.origin).is_some_and(|offset| offset < self.length_bytes)
    }

    /// First address after the region.
    pub(crate) fn end(&self) -> u64 {
        u64::from(self.origin) + u64::from(self.length_bytes)
    }
}

#[derive(Debug, Deserialize)]
pub(crate) struct Emulator {
    /// `qemu-system-arm`
    pub(crate) program: String,
    /// `-machine`
    pub(crate) machine: String,
    #[serde(default)]
    pub(crate) options: Vec<String>,
    /// `-icount shift` for the program `flight`, which needs a core of about the true speed; none: it does not run here.
    pub(crate) flight_shift: Option<u8>,
}

/// Every board, by name, the default one first.
pub(crate) fn all() -> Result<Vec<Board>> {
    let folder = root().join("firmware/boards");
    let mut boards = Vec::new();
    for entry in fs::read_dir(&folder)? {
        let path = entry?.path();
        let text = fs::read_to_string(&path)?;
        let mut board: Board = toml::from_str(&text).with_context(|| path.display().to_string())?;
        board.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        boards.push(board);
    }
    if boards.is_empty() {
        bail!("no board in {}", folder.display());
    }
    boards.sort_by_key(|board| (board.name != DEFAULT, board.name.clone()));
    Ok(boards)
}

/// The board of that name.
pub(crate) fn by_name(name: &str) -> Result<Board> {
    let boards = all()?;
    let names: Vec<String> = boards.iter().map(|board| board.name.clone()).collect();
    let found = boards.into_iter().find(|board| board.name == name);
    found.with_context(|| format!("no board `{name}`; there are {}", names.join(", ")))
}

/// One board for each target: what depends on the code alone is the same on all of them.
pub(crate) fn one_for_each_target() -> Result<Vec<Board>> {
    let mut boards: Vec<Board> = Vec::new();
    for board in all()? {
        if !boards.iter().any(|other| other.target == board.target) {
            boards.push(board);
        }
    }
    Ok(boards)
}

/// The board whose map is the workspace's `memory.x`.
pub(crate) const DEFAULT: &str = "an386";
