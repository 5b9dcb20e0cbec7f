//! Real-time model of a gimballed inertial platform's servo.

#![no_std]
#![forbid(unsafe_code)]

pub mod bearing;
mod build;
mod config;
mod crossing;
mod digest;
mod error;
mod faults;
mod free;
mod friction;
mod guard;
pub mod gyro;
mod ins;
mod law;
mod number;
pub mod paper;
mod row;
mod saved;
pub mod servo;
mod signals;
mod state;
mod step;
mod stop;
mod table;
pub mod unbalance;
mod units;

pub use config::{Config, Interpolation, Range};
pub use digest::Digest;
pub use error::BuildError;
pub use faults::Faults;
pub use law::Law;
pub use number::{Fixed, Number};
pub use saved::{RestoreError, SAVED_LEN, Saved};
pub use signals::{Input, Output, Stop};
pub use state::State;
pub use units::Units;
