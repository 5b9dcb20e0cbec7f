//! How large an effect must be to be seen, from the true plant with and without it.
//!
//! ```text
//! d(size) = min over |p_i| <= tolerance_i, b of | W (y(effect) - y(without) - S p - B b) |
//! ```
//!
//! y: the logged channels of the record without its first second. W: one over the amplitude of the noise floor by frequency
//! and by time, which is the instruments' noise plus the noise of the logged inputs carried through the plant. S: finite
//! differences of y by the nominal parameters; a parameter may move from where it truly is to either end of its
//! tolerance. b: what the servo's integrator holds at the record's beginning, which nobody knows. Where a difference is
//! large, y(without) is taken anew where they have moved to, as y is no line in them. The smallest detectable size is the
//! one with d = 5.

mod floor;
mod frames;
mod projection;

pub use floor::{UNSCORED_S, Whitener};
pub use projection::{Nuisance, Projection};

/// d at which an effect counts as detectable.
pub const DETECTABLE: f64 = 5.0;
