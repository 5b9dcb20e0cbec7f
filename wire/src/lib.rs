//! Frames between a bench and a flight computer.
//!
//! Every frame has the same length, so that it takes the same time: a body of [`BODY_LEN`] bytes, stuffed by COBS to
//! [`FRAME_LEN`] bytes of which the last alone is zero. The body carries the protocol's version, the kind of the frame,
//! a sequence number, a tick, 32 bytes that depend on the kind, and a CRC-32 over all of it. Every byte stands in
//! `docs/wire.md`.
//!
//! ```
//! use gimbal_wire::{Frame, Message, Receiver, Run};
//!
//! let frame = Frame { sequence: 7, tick: 1_000, message: Message::Run(Run { watchdog_ticks: 20 }) };
//! let mut receiver = Receiver::default();
//! let received: Vec<Frame> = frame.emit().into_iter().filter_map(|byte| receiver.push(byte)).collect();
//! assert_eq!(received, [frame]);
//! ```
//!
//! Nothing here allocates, panics or loops without bound, on any bytes.

#![no_std]
#![forbid(unsafe_code)]

mod cobs;
mod fields;
mod frame;
mod message;
mod receiver;

pub use frame::{BODY_LEN, FRAME_LEN, Frame, PAYLOAD_LEN, Refusal, View};
pub use message::down::{Hello, LoadEnd, LoadPart, PART_VALUES, Reset, Run, Sensor};
pub use message::up::{Ack, Computer, Estimate, Faults, Identity, Mode, Outcome, RingEnd, RingRow, Telemetry};
pub use message::{Kind, Message};
pub use receiver::{Counts, Receiver};

/// Version of the protocol; a frame of another one is refused.
pub const VERSION: u8 = 1;
