//! Blind cases for the diagnosis of the gap between a model and a log: physics of its own, sealed answers, a score.

#![forbid(unsafe_code)]

mod compensator;
mod draw;
mod machine;
mod memory;
mod palmgren;
mod track;
pub mod truth;

pub use draw::{Draw, Seed};
pub use machine::{Machine, Sample};
pub use track::{Row, Track};
pub use truth::Truth;
