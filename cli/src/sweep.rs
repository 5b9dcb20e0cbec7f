//! `gimbal sweep`: parameters over ranges and tolerances.

#![allow(dead_code, reason = "shared with the figures, which use a part")]

pub(crate) mod margin;
pub(crate) mod parameter;
pub(crate) mod trial;
