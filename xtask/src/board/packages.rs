//! Debian packages: installed where that is possible, named where it is not.

use crate::shell::{capture, program};
use crate::stages::Missing;
use anyhow::{Context, Result};
use std::sync::Once;

/// Installs `packages`, needed for `purpose`.
pub(super) fn install(packages: &[&str], purpose: &str) -> Result<()> {
    static UPDATED: Once = Once::new();
    let list = packages.join(" ");
    let advice = || Missing(format!("{purpose} is missing; install it by hand: `apt-get install {list}`, or the like"));
    if !is_root() {
        return Err(advice().into());
    }
    // Without network the lists of packages may still be good: only the installation decides.
    UPDATED.call_once(|| drop(capture(program("apt-get").args(["update", "--quiet"]))));
    let outcome = capture(
        program("apt-get")
            .env("DEBIAN_FRONTEND", "noninteractive")
            .args(["install", "--quiet", "--yes", "--no-install-recommends"])
            .args(packages),
    );
    outcome.map(drop).map_err(|error| anyhow::anyhow!("{error:#}")).with_context(advice)
}

fn is_root() -> bool {
    program("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}
