//! Progress of reading and of long work, shown when standard error is a terminal; Ctrl-C ends the reading.

use std::fs::File;
use std::io::{self, IsTerminal, Read};
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};

use crate::interrupt;

/// Files below this are read before a bar could be seen [bytes].
const SHOWN_FROM_BYTES: u64 = 16 << 20;

/// Steps of work whose number nobody knows beforehand.
pub(crate) fn steps(of: &'static str) -> ProgressBar {
    if !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}: {pos} done, {elapsed}") {
        bar.set_style(style);
    }
    bar.tick();
    bar.with_message(of)
}

/// A file that tells how far it is read.
#[derive(Debug)]
pub(crate) struct Watched {
    file: File,
    bar: ProgressBar,
}

impl Watched {
    /// Opens a file.
    pub(crate) fn open(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let length = file.metadata().map_or(0, |metadata| metadata.len());
        let bar = if length >= SHOWN_FROM_BYTES && io::stderr().is_terminal() {
            let bar = ProgressBar::new(length);
            if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent} %  {bytes_per_sec}  {eta} left") {
                bar.set_style(style);
            }
            bar
        } else {
            ProgressBar::hidden()
        };
        Ok(Self { file, bar })
    }
}

impl Read for Watched {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if interrupt::raised() {
            return Err(io::Error::other("interrupted"));
        }
        let read = self.file.read(buffer)?;
        self.bar.inc(read as u64);
        Ok(read)
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
