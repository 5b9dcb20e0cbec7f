//! Serial ports.

use std::io::ErrorKind;
use std::time::Duration;

use gimbal_wire::FRAME_LEN;
use serialport::SerialPort;

use super::{Link, LinkError, read_once};

/// Baud rate of the firmware's program `hil` [1/s].
pub const PROGRAM_BAUD: u32 = 1_000_000;
/// Bits of a byte on the line: start, eight, stop.
const BITS: f64 = 10.0;
/// Share of a period that the line may take: the rest is the computer's.
const SHARE: f64 = 0.95;
/// Down a sensor frame and the clock, then up an estimate and, in one tick of ten, telemetry.
const FRAMES: f64 = 4.0;

/// Least baud rate for one exchange a period, one way after the other [1/s].
#[must_use]
pub fn least_baud(period_s: f64) -> u32 {
    let bits = FRAMES * FRAME_LEN as f64 * BITS;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some megabaud")]
    let baud = (bits / (SHARE * period_s)).ceil() as u32;
    baud
}

/// A serial port.
pub struct Serial {
    port: Box<dyn SerialPort>,
    name: String,
}

impl Serial {
    /// Opens a port for this program alone.
    ///
    /// # Errors
    /// No such port, no right to it, or another program holds it.
    pub fn open(path: &str, baud: u32) -> Result<Self, LinkError> {
        let port = serialport::new(path, baud).timeout(Duration::from_millis(10)).open().map_err(|error| {
            let mend = match error.kind() {
                serialport::ErrorKind::NoDevice => "is the board plugged in? `gimbal doctor --port ...` looks",
                serialport::ErrorKind::Io(ErrorKind::PermissionDenied) => {
                    "`sudo usermod -aG dialout $USER`, and log in anew"
                }
                _ => "`gimbal doctor --port ...` says more",
            };
            LinkError::new(format!("{path}: cannot be opened: {error}"), mend)
        })?;
        Ok(Self { port, name: format!("{path} at {baud} baud") })
    }
}

impl Link for Serial {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.port.write_all(bytes).map_err(|error| gone(&self.name, &error))
    }

    fn receive(&mut self, bytes: &mut Vec<u8>, wait: Duration) -> Result<(), LinkError> {
        let wait = wait.max(Duration::from_millis(1));
        if self.port.timeout() != wait {
            let fail = |error: serialport::Error| LinkError::new(format!("{}: {error}", self.name), "plug it in again");
            self.port.set_timeout(wait).map_err(fail)?;
        }
        if read_once(&mut self.port, bytes).map_err(|error| gone(&self.name, &error))? {
            return Ok(());
        }
        Err(LinkError::new(format!("{}: the port is gone", self.name), "plug it in again, and start again"))
    }

    fn describe(&self) -> String {
        self.name.clone()
    }
}

fn gone(name: &str, error: &std::io::Error) -> LinkError {
    LinkError::new(format!("{name}: the port is gone: {error}"), "plug it in again, and start again")
}
