//! Two named pipes: the emulator's semihosting opens them as files.

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{CWD, FileType, Mode, OFlags};

use super::{Link, LinkError, read_once};

/// Name of the pipe to the computer, in its folder.
const DOWN: &str = "down";
/// Name of the pipe from the computer.
const UP: &str = "up";

/// Both pipes.
#[derive(Debug)]
pub struct Fifo {
    down: File,
    up: File,
}

impl Fifo {
    /// Makes the pipes `down` and `up` in a folder and opens this end of both.
    ///
    /// # Errors
    /// The folder takes no pipes.
    pub fn create(folder: &Path) -> Result<Self, LinkError> {
        let fail = |error: rustix::io::Errno| {
            LinkError::new(
                format!("{}: no pipe can be made: {error}", folder.display()),
                "set TMPDIR to a local folder",
            )
        };
        let open = |name: &str, flags: OFlags| {
            let path = folder.join(name);
            rustix::fs::mknodat(CWD, &path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).map_err(fail)?;
            rustix::fs::open(&path, flags | OFlags::CLOEXEC, Mode::empty()).map(File::from).map_err(fail)
        };
        // For reading, too: opening does not wait for the other end then.
        Ok(Self { down: open(DOWN, OFlags::RDWR)?, up: open(UP, OFlags::RDONLY | OFlags::NONBLOCK)? })
    }
}

impl Link for Fifo {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.down.write_all(bytes).map_err(|error| gone(&error.to_string()))
    }

    fn receive(&mut self, bytes: &mut Vec<u8>, wait: Duration) -> Result<(), LinkError> {
        let mut ready = [PollFd::new(&self.up, PollFlags::IN)];
        let wait = Timespec::try_from(wait).ok();
        match poll(&mut ready, wait.as_ref()) {
            Ok(0) | Err(rustix::io::Errno::INTR) => return Ok(()),
            Ok(_) => {}
            Err(error) => return Err(gone(&error.to_string())),
        }
        if !ready[0].revents().contains(PollFlags::IN) {
            return Err(gone("the other end is closed"));
        }
        match read_once(&mut &self.up, bytes) {
            Ok(true) => Ok(()),
            Ok(false) => Err(gone("the other end is closed")),
            Err(error) => Err(gone(&error.to_string())),
        }
    }

    fn describe(&self) -> String {
        "two pipes by semihosting".to_owned()
    }
}

fn gone(error: &str) -> LinkError {
    LinkError::new(format!("the emulator's pipe is gone: {error}"), "the emulator has ended; start again")
}
