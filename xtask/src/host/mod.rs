//! Checks that need the Rust toolchain alone.

pub(crate) mod blind;
pub(crate) mod deny;
pub(crate) mod digests;
pub(crate) mod documents;
pub(crate) mod format;
pub(crate) mod fuzz;
pub(crate) mod licences;
pub(crate) mod lints;
pub(crate) mod oldest_rust;
pub(crate) mod package;
mod spdx;
pub(crate) mod tests;
