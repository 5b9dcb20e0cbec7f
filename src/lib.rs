//! Real-time model of a gimballed inertial platform's servo.
//!
//! A gimballed inertial navigation system holds a stable member still with gyro-driven servos. Bearing friction and mass
//! unbalance disturb it, the servo yields, the stable member tilts by phi, and tilt times acceleration becomes velocity
//! error. This crate models one axis at a fixed period, 1 ms by default, whole loop: gimbal, single-axis gyro with its
//! stops, servo, friction, unbalance and the velocity and position error.
//!
//! ```
//! use gimbal_servo::{Config, Faults, Input};
//!
//! let law = Config::consistent().build::<f32>()?; // once
//! let mut state = law.start();
//! // once a millisecond:
//! let output = law.step(&mut state, Input { accel_y_mps2: 196.1, vehicle_rate_radps: 0.1, ..Input::default() });
//! assert!(output.faults == Faults::NONE);
//! # Ok::<(), gimbal_servo::BuildError>(())
//! ```
//!
//! With [`Fixed`] instead of `f32` signals are fractions of full scales; [`Units::input`] and [`Units::output`] translate.
//!
//! Three kinds of value, three lives: a [`Config`] in SI, which may be wrong; a [`Law`], quantised and immutable; a
//! [`State`], plain data. Only `build` can fail. `step` does not allocate, panic, loop without bound or read a clock;
//! what is wrong with its input is a bit of [`Faults`] in its [`Output`]. The same inputs give the same bits on every
//! machine, in `f32` as in [`Fixed`].
//!
//! Features: `serde` derives `Serialize` and `Deserialize` on the configuration; `defmt` gives inputs, outputs, faults and
//! errors a `defmt::Format`. Neither needs the other, and no feature changes a number.

#![no_std]
#![forbid(unsafe_code)]

pub mod batch;
pub mod bearing;
mod bits;
mod build;
mod config;
mod crossing;
mod digest;
pub mod effects;
mod error;
pub mod estimator;
mod faults;
mod free;
mod friction;
mod guard;
pub mod gyro;
mod identity;
pub mod image;
mod ins;
mod law;
pub mod monitor;
mod number;
pub mod paper;
#[doc(hidden)]
pub mod parts;
pub mod platform;
mod row;
mod saved;
pub mod servo;
mod signals;
mod state;
mod step;
mod stop;
mod stored;
mod table;
pub mod unbalance;
mod units;

pub use config::{Config, Interpolation, Range};
pub use digest::Digest;
pub use error::BuildError;
pub use faults::Faults;
pub use image::ImageError;
pub use law::Law;
pub use number::{Fixed, Number};
pub use saved::{RestoreError, SAVED_LEN, Saved};
pub use signals::{Input, Output, Stop};
pub use state::State;
pub use units::Units;
