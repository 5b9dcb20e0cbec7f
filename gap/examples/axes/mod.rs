//! Simulated axes of any origin, with a physics of their own: nothing is shared with the diagnosis but the log.

#![allow(
    missing_docs,
    unreachable_pub,
    dead_code,
    clippy::must_use_candidate,
    clippy::missing_panics_doc,
    clippy::struct_excessive_bools,
    clippy::return_self_not_must_use,
    reason = "a corpus for an example and a test"
)]

pub mod draw;
pub mod effect;
pub mod path;
pub mod plant;
pub mod run;
pub mod score;
pub mod size;
