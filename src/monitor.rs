//! Whether the model still describes the axis: predicted against measured theta, on board.
//!
//! ```text
//! r = theta measured - theta modelled      m = mean of r^2 over a block / variance expected      g = max(0, g + m - k)
//! ```
//!
//! The variance expected is that of the pick-off, and more where the model's own inputs are uncertain: near a reversal of the
//! bearing, where the rate's noise becomes torque, and, if the model is granted a tolerance, in proportion to theta. An
//! alarm is g beyond its threshold h. With r white and normal, B rows a block, `E[e^(a (m - k))] = 1` has one positive
//! root a, and an excursion of g from zero passes h with a probability of at most `e^(-a h)` (Lundberg): h follows from
//! the alarms an hour that are allowed. It says that there is a gap, when, and in which regime; naming it is the ground's
//! work, from the rows that [`Recorder`] has kept.
//!
//! Source: E. S. Page, *Continuous inspection schemes*, Biometrika 41 (1954), 100.

mod law;
mod recorder;

pub use law::{Config, Law, Regime, Report, State};
pub use recorder::{Record, Recorder};
