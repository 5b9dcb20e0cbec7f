//! Fitting: whitened residuals, sensitivities, normal equations, and the search over effects.

mod hypothesis;
mod linear;
mod normal;
mod problem;
mod pull;
mod refine;
mod refit;
mod rest;
mod search;
mod whiten;

pub use normal::Solution;
pub(crate) use normal::{drive, slices, solve};
pub use problem::{BLOCKS, Columns, Problem};
pub(crate) use problem::{predicted, residual as raw_residual};
pub use refine::{Effort, Fit, refine};
pub use refit::{refit, without};
pub use search::{Search, Set, search};
pub use whiten::Whitener;
