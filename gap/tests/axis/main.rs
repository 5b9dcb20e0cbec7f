//! Plain axes: effects that an independent simulation has are found, those that it has not are not.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::format_push_string,
    reason = "strokes are counted, rows are written line by line"
)]

mod arm;
mod columns;
mod play;
mod real;
mod simulated;
mod simulator;
mod small;
mod unseen;
mod yields;
