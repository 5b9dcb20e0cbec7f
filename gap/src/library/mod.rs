//! Every effect: how it enters the physics, and how its signature is looked for.

mod apply;

pub use apply::apply;
