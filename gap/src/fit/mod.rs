//! Fitting: whitened residuals, sensitivities, normal equations, and the search over effects.

mod draft;
mod gross;
mod ground;
mod heavy;
mod hypothesis;
mod linear;
mod normal;
mod path;
mod plans;
mod power;
mod problem;
mod pull;
mod refine;
mod refit;
mod resonance;
mod rest;
mod ripple;
mod search;
mod shapes;
mod signals;
mod slip;
mod turning;
mod vectors;
mod whiten;

pub(crate) use ground::Ground;
pub(crate) use linear::Linear;
pub use normal::Solution;
pub(crate) use normal::{drive, slices, solve};
pub use problem::{BLOCKS, Columns, Problem};
pub use refine::{Effort, Fit, refine};
pub use refit::{refit, without};
pub use search::{Glimpse, Search, Set, search};
pub(crate) use search::{null, search_from};
pub(crate) use signals::{of_channel, predicted, residual as raw_residual};
pub use whiten::Whitener;
