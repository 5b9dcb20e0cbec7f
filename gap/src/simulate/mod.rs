//! The platform predicted at every row, fast: fixed steps, exact between them for everything that is linear.
//!
//! A third solution of the same equations, beside the flight code and the reference plant. It is made for being run
//! a hundred times over a log: one full step a row while the bearing slips, a few where friction turns around or the
//! float is on a stop. A test holds it against the plant.

mod bearing;
mod begin;
mod cable;
mod chain;
mod corner;
mod discrete;
mod inputs;
mod lanes;
mod law;
mod machine;
mod noisy;
mod now;
mod physics;
mod predict;
mod prediction;
mod running;
mod sprung;

pub(crate) use bearing::{GRAVITY_MPS2, Viscous, load_nm};
pub use begin::Begin;
pub(crate) use chain::{ANGLES, TORQUES};
pub use corner::Corner;
pub(crate) use inputs::turned;
pub use inputs::{Curve, Inputs};
pub use physics::{BuildUp, Fall, Friction, Hysteresis, Loop, Measurement, Physics, Ripple, Stribeck};
pub use predict::{Push, Variant, predict, predict_each};
pub use prediction::Prediction;
