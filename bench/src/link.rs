//! Links to a flight computer: bytes there, bytes back, every wait bounded.

#[cfg(unix)]
mod fifo;
mod host;
mod serial;
mod stream;

use std::time::Duration;

#[cfg(unix)]
pub use fifo::Fifo;
pub use host::Host;
pub use serial::{Serial, least_baud};
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
}
