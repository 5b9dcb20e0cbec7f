//! Stage `digests`: debug, release and `-C target-cpu=native` builds give the same bits.

use crate::shell::{capture, cargo, target_dir};
use crate::stages::Note;
use anyhow::{Result, ensure};

const DIGEST: &str = "run --quiet --package gimbal-firmware --bin digest";

pub(crate) fn check() -> Result<Note> {
    let release = release()?;
    let debug = capture(&mut cargo(DIGEST))?;
    let native = capture(
        cargo(DIGEST)
            .arg("--release")
            .env("RUSTFLAGS", "-C target-cpu=native")
            // Other flags would throw away what the other stages have built.
            .env("CARGO_TARGET_DIR", target_dir().join("native")),
    )?;
    ensure!(debug == release, "debug:\n{debug}release:\n{release}");
    ensure!(native == release, "native:\n{native}release:\n{release}");
    print!("{release}");
    Ok(format!("{} cases equal in debug, release and native", release.lines().count()))
}

/// The digests that every board is held to.
pub(crate) fn release() -> Result<String> {
    capture(cargo(DIGEST).arg("--release"))
}
