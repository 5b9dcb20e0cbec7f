//! Blind cases for the diagnosis of the gap between a model and a log: physics of its own, sealed answers, a score.

#![forbid(unsafe_code)]

mod compensator;
pub mod corpus;
pub mod detect;
mod draw;
pub mod effects;
pub mod excitation;
pub mod folder;
pub mod freeze;
mod machine;
mod memory;
mod palmgren;
pub mod scene;
pub mod score;
pub mod seal;
pub mod sensors;
mod track;
pub mod truth;
pub mod write;

pub use draw::{Draw, Seed};
pub use machine::{Machine, Sample};
pub use track::{Row, Track};
pub use truth::Truth;
