//! From fits to a verdict: which effects, how sure, what else it might be, how far the gap shrinks.

mod closed_loop;
mod comb;
mod correlation;
mod curve;
mod decide;
mod detectable;
mod experiment;
mod group;
mod left_over;
mod lines;
mod moments;
mod portrait;
mod shrink;
mod strange;
mod stretch;
mod torques;
mod weigh;

pub(crate) use closed_loop::in_step;
pub use closed_loop::{Yardstick, free_running, one_step};
pub use correlation::{Correlation, bounds_hit, correlations};
pub use curve::{CurvePoint, curve};
pub use decide::{Decision, Found, SetProbability, Verdict, decide};
pub use detectable::{Detectable, Seen, detectable};
pub use experiment::experiment;
pub use portrait::{Portrait, portrait};
pub use shrink::{Shrink, ShrinkSignal, shrink};
pub use strange::Stranger;
pub(crate) use weigh::holds;
