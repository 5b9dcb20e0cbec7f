//! Links to a flight computer: bytes there, bytes back, every wait bounded.

#[cfg(unix)]
mod fifo;
mod host;
mod serial;
mod stream;

use std::io::{ErrorKind, Read};
use std::time::Duration;

#[cfg(unix)]
pub use fifo::Fifo;
pub use host::Host;
pub use serial::{PROGRAM_BAUD, Serial, least_baud};
pub use stream::Stream;

/// A link has failed: what, and what mends it.
#[derive(Debug, thiserror::Error)]
#[error("{what}; {mend}")]
pub struct LinkError {
    what: String,
    mend: String,
}

impl LinkError {
    /// A failure in words.
    #[must_use]
    pub fn new(what: impl Into<String>, mend: impl Into<String>) -> Self {
        Self { what: what.into(), mend: mend.into() }
    }
}

/// A way to a flight computer.
pub trait Link {
    /// Sends all bytes.
    ///
    /// # Errors
    /// The link is gone.
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError>;

    /// Appends what has come, waiting at most `wait` for the first byte.
    ///
    /// # Errors
    /// The link is gone.
    fn receive(&mut self, bytes: &mut Vec<u8>, wait: Duration) -> Result<(), LinkError>;

    /// What it is, for reports.
    fn describe(&self) -> String;

    /// Digest of the program at its other end (64-bit FNV-1a over the file), where it is known.
    fn image(&self) -> Option<u64> {
        None
    }
}

/// Appends what one read brings; a wait that ends without a byte brings none. False at the end of the stream.
fn read_once(source: &mut impl Read, bytes: &mut Vec<u8>) -> std::io::Result<bool> {
    let mut buffer = [0; 4096];
    match source.read(&mut buffer) {
        Ok(count) => {
            bytes.extend_from_slice(&buffer[..count]);
            Ok(count > 0)
        }
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => {
            Ok(true)
        }
        Err(error) => Err(error),
    }
}
