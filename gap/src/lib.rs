//! The gap between a model and a log: where it lies, which effect causes it, how far it shrinks.

#![forbid(unsafe_code)]

pub mod library;
pub mod simulate;
