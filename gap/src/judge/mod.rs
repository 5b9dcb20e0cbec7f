//! From fits to a verdict: which effects, how sure, what else it might be, how far the gap shrinks.

mod comb;
mod decide;
mod detectable;
mod experiment;
mod left_over;
mod shrink;

pub use decide::{Decision, Found, SetProbability, Verdict, decide};
pub use detectable::{Detectable, detectable};
pub use experiment::experiment;
pub use shrink::{Shrink, ShrinkSignal, shrink};
