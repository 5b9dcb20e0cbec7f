//! A flight computer on a bench: frames in, model and estimator, frames out.
//!
//! [`Computer`] owns no clock and no transport: bytes are handed in, frames are taken out, and a tick is a frame
//! ([`gimbal_wire::Message::Clock`]), as a synchronisation pulse would be. So the same bytes give the same answers on
//! a board, on an emulated one, and in the bench's own process, where it is the twin that a board is compared with.
//!
//! ```
//! use gimbal_computer::Computer;
//! use gimbal_wire::{Frame, Hello, Message, Receiver};
//!
//! let mut computer = Computer::<f32>::new();
//! computer.receive(&Frame { sequence: 0, tick: 0, message: Message::Hello(Hello { build: 0 }) }.emit());
//! let answer = computer.take().unwrap();
//! let mut receiver = Receiver::default();
//! let frame = answer.into_iter().find_map(|byte| receiver.push(byte)).unwrap();
//! assert!(matches!(frame.message, Message::Identity(_)));
//! ```
//!
//! A tick neither allocates, panics nor loops without bound. Building a model, which is done once and while nothing
//! runs, takes the library's own time.

#![no_std]
#![forbid(unsafe_code)]

mod axis;
mod computer;
pub mod limits;
pub mod parameters;

pub use computer::Computer;

mod build {
    include!(concat!(env!("OUT_DIR"), "/build.rs"));
}

pub use build::BUILD;
