//! The score of a blind diagnosis: rates with Wilson intervals, probabilities against outcomes, tables and pictures.

pub mod calibration;
pub mod compare;
mod coverage;
pub mod gates;
pub mod held_out;
pub mod judge;
pub mod page;
mod picture;
pub mod rate;
pub mod report;
pub mod tally;
mod unknown;

pub use judge::Judged;
pub use tally::Score;
