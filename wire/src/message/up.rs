//! From the flight computer to the bench.

mod bits;
mod mode;
mod ring;
mod status;
mod tick;

pub use bits::Computer;
pub use mode::Mode;
pub use ring::{RingEnd, RingRow};
pub use status::{Ack, Faults, Identity, Outcome};
pub use tick::{Estimate, Telemetry};
