//! Fitting: whitened residuals, sensitivities, normal equations by time block, and the search over effects.

mod normal;
mod problem;
mod refine;
mod search;
mod whiten;

pub use normal::{Normal, Solution};
pub use problem::{BLOCKS, Columns, Problem};
pub(crate) use problem::{predicted, residual as raw_residual};
pub use refine::{Fit, refine, refit, without};
pub use search::{Search, Set, search};
pub use whiten::Whitener;
