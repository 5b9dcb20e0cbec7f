//! From fits to a verdict: which effects, how sure, what else it might be, how far the gap shrinks.

mod closed_loop;
mod comb;
mod correlation;
mod curve;
mod decide;
mod detectable;
mod experiment;
mod grid;
mod group;
mod in_loop;
mod input_noise;
mod left_over;
mod lines;
mod moments;
mod on_float;
mod portrait;
mod probability;
mod samples;
mod scale;
mod shrink;
mod spread;
mod strange;
mod stretch;
mod torques;
mod weigh;

pub(crate) use closed_loop::in_step;
pub use closed_loop::{Yardstick, free_running, one_step};
pub use correlation::{Correlation, bounds_hit, correlations};
pub use curve::{CurvePoint, curve};
pub use decide::{Decision, Found, Verdict, decide};
pub(crate) use decide::{Limits, UNEXPLAINED, UNSEEN, past, rivals, strangeness, unknown};
pub use detectable::{Detectable, Seen, detectable};
pub use experiment::experiment;
pub(crate) use left_over::left_over;
pub use portrait::{Portrait, portrait};
pub(crate) use probability::Probabilities;
pub use probability::SetProbability;
pub(crate) use samples::READ_OFF;
pub use shrink::{Shrink, ShrinkSignal, shrink};
pub use spread::Spread;
pub use strange::Stranger;
pub(crate) use strange::strangers;
pub(crate) use stretch::{carried_by_one_log, carried_by_one_stretch, pieces};
pub(crate) use weigh::{
    COST_OF_SHIFT, HELPS, NEVER, RARE_SHIFT, Weighed, at_a_bound, best, beyond, caution, costs_of, is_part,
    worth_their_more,
};
