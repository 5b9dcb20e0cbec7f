//! Task `deny`: cargo-deny with `deny.toml`.
//!
//! Not part of `cargo xtask test` unless it is installed: building it takes longer than all the rest together. The
//! stage `licences` checks the same lists without it; only the advisories are left out, and those change by the day,
//! so a test of a commit should not depend on them.

use crate::shell::{cargo, run, version_of};
use crate::stages::Missing;
use anyhow::Result;

pub(crate) fn installed() -> bool {
    version_of("cargo-deny").is_some()
}

/// Everything but the advisories, whose database comes over the network.
pub(crate) fn check() -> Result<()> {
    run(&mut cargo("deny --log-level error check --hide-inclusion-graph licenses bans sources"))
}

pub(crate) fn install_and_check() -> Result<()> {
    if !installed() {
        run(&mut cargo("install cargo-deny --locked")).map_err(|error| {
            Missing(format!("{error:#}\ncargo-deny is needed: `cargo install cargo-deny --locked`, or a packaged one"))
        })?;
    }
    check()?;
    run(&mut cargo("deny check advisories"))
}
