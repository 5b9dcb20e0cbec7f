//! Where the flight computer is: emulated, in process, at a serial port, or at a socket.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Parser, ValueEnum};
use gimbal_bench::Patience;
use gimbal_bench::emulator::{self, Emulated, Transport};
use gimbal_bench::link::{Host, Link, LinkError, PROGRAM_BAUD, Serial, Stream, least_baud};

use crate::exit::Failure;
use crate::interrupt;

/// Which computer, and how to reach it.
#[derive(Debug, Clone, Parser)]
pub(crate) struct Place {
    /// Emulated board, or the same code in this process
    #[arg(long, value_enum, default_value_t = Target::Qemu)]
    target: Target,
    /// How frames come to the emulated board
    #[arg(long, value_enum, default_value_t = Way::Fifo)]
    transport: Way,
    /// Program for the emulated board, instead of the one that is built
    #[arg(long, value_name = "FILE")]
    image: Option<PathBuf>,
    /// A board at a serial port
    #[arg(long, value_name = "DEVICE", conflicts_with_all = ["target", "connect"])]
    port: Option<String>,
    /// Its baud rate; the default is that of the program `hil`
    #[arg(long, value_name = "N", default_value_t = PROGRAM_BAUD, requires = "port")]
    baud: u32,
    /// A computer behind a socket
    #[arg(long, value_name = "HOST:PORT", conflicts_with = "target")]
    connect: Option<String>,
    /// Longest time for an answer, before the link is given up [s]
    #[arg(long, value_name = "S", default_value_t = 30.0, value_parser = patience_s)]
    patience_s: f64,
}

/// A time that a person would wait.
fn patience_s(text: &str) -> Result<f64, String> {
    let patience_s: f64 = text.parse().map_err(|_| "is no number".to_owned())?;
    if (0.1..=3_600.0).contains(&patience_s) {
        Ok(patience_s)
    } else {
        Err("it must lie between 0.1 and 3600".to_owned())
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Target {
    Qemu,
    Host,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Way {
    /// Two pipes, by semihosting: fast
    Fifo,
    /// The emulated serial port: the real path
    Uart,
}

impl From<Way> for Transport {
    fn from(way: Way) -> Self {
        match way {
            Way::Fifo => Self::Fifo,
            Way::Uart => Self::Uart,
        }
    }
}

/// A place that has been made ready: one link after the other can be had from it.
#[derive(Debug)]
pub(crate) struct Ready {
    place: Place,
    image: Option<PathBuf>,
}

impl Place {
    /// How long an answer is waited for.
    pub(crate) fn patience(&self) -> Patience {
        Patience { answer: Duration::from_secs_f64(self.patience_s), interrupted: interrupt::raised }
    }

    /// Builds the firmware if it is needed.
    pub(crate) fn ready(&self) -> Result<Ready, Failure> {
        let emulated = self.port.is_none() && self.connect.is_none() && self.target == Target::Qemu;
        let image = match &self.image {
            _ if !emulated => None,
            Some(image) if image.exists() => Some(image.clone()),
            Some(image) => {
                return Err(Failure::input(format!("{}: no such file; --image takes an ELF file", image.display())));
            }
            None => {
                if emulator::version().is_none() {
                    let what = format!("{} is not installed", emulator::PROGRAM);
                    let mend =
                        "`sudo apt-get install qemu-system-arm`, or fly with --target host; `gimbal doctor` says more";
                    return Err(environment(LinkError::new(what, mend)));
                }
                Some(emulator::build(self.transport.into()).map_err(environment)?)
            }
        };
        Ok(Ready { place: self.clone(), image })
    }

    /// Real time needs a line that is fast enough.
    pub(crate) fn refuse_slow(&self, period_s: f64) -> Result<(), Failure> {
        let least = least_baud(period_s);
        if self.port.is_some() && self.baud < least {
            let baud = self.baud;
            let message =
                format!("--baud {baud} is too slow for one exchange each {period_s} s; it takes {least} or more");
            return Err(Failure::input(message));
        }
        if self.port.is_none() && self.connect.is_none() && self.target == Target::Qemu && self.transport == Way::Uart {
            let message = "the emulated serial port is too slow for real time; use --transport fifo, or lockstep";
            return Err(Failure::input(message));
        }
        Ok(())
    }
}

impl Ready {
    /// A link to the computer.
    pub(crate) fn link(&self) -> Result<Box<dyn Link>, Failure> {
        let place = &self.place;
        if let Some(port) = &place.port {
            return Ok(Box::new(Serial::open(port, place.baud).map_err(environment)?));
        }
        if let Some(address) = &place.connect {
            return Ok(Box::new(Stream::connect(address).map_err(environment)?));
        }
        match &self.image {
            None => Ok(Box::new(Host::new())),
            Some(image) => Ok(Box::new(Emulated::start(image, place.transport.into()).map_err(environment)?)),
        }
    }
}

fn environment(error: LinkError) -> Failure {
    Failure::Environment(error.into())
}
