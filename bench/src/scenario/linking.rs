//! What goes wrong on the link, and what the bench does on the way.

use serde::Deserialize;

/// The way of a link fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Way {
    /// To the computer.
    Down,
    /// From the computer.
    Up,
}

/// What goes wrong on a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LinkFaultKind {
    /// A frame is lost.
    Drop,
    /// A frame comes twice.
    Repeat,
    /// A frame comes behind its successor.
    Reorder,
    /// A frame comes `amount` ticks late.
    Delay,
    /// One bit of a byte is turned; the rate is that of bytes.
    BitFlips,
    /// A byte becomes another; the rate is that of bytes.
    ByteErrors,
    /// The end of a frame is lost.
    Truncate,
    /// `amount` random bytes come before a frame.
    NoiseBurst,
    /// Nothing passes.
    Disconnect,
    /// `amount` frames of no use come with each.
    Flood,
}

/// A link fault for some time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkFault {
    /// What.
    pub kind: LinkFaultKind,
    /// Which way.
    pub way: Way,
    /// How often: probability for each frame, or for each byte.
    #[serde(default = "always")]
    pub rate: f64,
    /// How much.
    #[serde(default)]
    pub amount: u16,
    /// From [s].
    pub from_s: f64,
    /// To [s].
    pub to_s: f64,
}

fn always() -> f64 {
    1.0
}

/// What the bench does on the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Action {
    /// The computer loses everything, as after power-on.
    ResetBoard,
    /// The computer loses its state and runs on.
    ResetState,
    /// A `Run` with twice the watchdog's limit, which must be refused.
    RaiseLimit,
}

/// Something that the bench does at a time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// When [s].
    pub at_s: f64,
    /// What.
    pub action: Action,
}
