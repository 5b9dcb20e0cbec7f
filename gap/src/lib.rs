//! The gap between a model and a log: where it lies, which effect causes it, how far it shrinks.
//!
//! A log is compared with predictions of the whole platform; every nominal parameter and every effect of the library
//! is a direction in which the prediction may move. What moves it onto the log, at the least cost, is the diagnosis.
//! The method: `docs/gap-method.md`. Its limits and measured tables: `docs/gap.md`.

#![forbid(unsafe_code)]

#[allow(
    clippy::type_complexity,
    clippy::too_many_lines,
    clippy::match_same_arms,
    clippy::format_collect,
    clippy::needless_pass_by_value,
    reason = "lists of regimes and columns, each told in its order"
)]
pub mod axis;
pub mod close;
pub mod diagnose;
pub mod fit;
pub mod judge;
pub mod library;
mod mistake;
pub mod place;
pub mod pool;
pub mod record;
pub mod report;
mod settle;
mod shake;
pub mod simulate;
mod still;
mod touch;
mod window;

pub use diagnose::{Diagnosis, diagnose};
pub use pool::{Pool, pool, pool_step_by_step};
