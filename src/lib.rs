//! Real-time model of a gimballed inertial platform's servo.

#![no_std]
#![forbid(unsafe_code)]

pub mod bearing;
mod config;
mod error;
pub mod gyro;
pub mod paper;
pub mod servo;
pub mod unbalance;

pub use config::{Config, Interpolation, Range};
pub use error::BuildError;
