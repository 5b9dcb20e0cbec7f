//! Every effect: how it enters the physics, and how its signature is looked for.

mod apply;
mod candidates;
mod model;
mod nuisance;

pub(crate) use apply::WOUND;
pub use apply::apply;
pub use candidates::{Candidate, Offer, candidates, narrow};
pub(crate) use candidates::{MODE_DAMPING, NAMED, PROMISE, releases};
pub use model::{hold, not_looked_for, platform};
pub(crate) use nuisance::{DAMPING, DISPLACEMENT, PURE_DELAY, SHARPNESS};
pub use nuisance::{Nuisance, nuisances};
