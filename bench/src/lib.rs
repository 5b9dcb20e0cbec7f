//! Hardware in the loop: the platform simulated, its sensors sent to a flight computer, its answers judged.
//!
//! ```text
//! scenario -> platform (plant, noise, sensor faults) -> link faults -> link -> computer
//! report   <- judge    <- link faults                <- link <-  estimate, telemetry
//!                         twin: the same code in process, byte for byte
//! ```
//!
//! The bench trusts nothing: every frame is checked, every answer compared with the twin's, every command
//! acknowledged, every wait bounded.

#![forbid(unsafe_code)]

pub mod emulator;
mod exchange;
mod fault;
pub mod judge;
pub mod link;
mod platform;
mod profile;
mod random;
pub mod record;
pub mod replay;
pub mod report;
pub mod run;
pub mod scenario;
mod sensor;
mod station;

pub use exchange::Patience;
pub use platform::{Moment, Platform};
pub use station::{Board, StationError};
