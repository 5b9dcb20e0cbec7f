//! A compiler for the boards' targets, by one of two ways:
//!
//! - `rustup`: `rustup target add`, which needs the network;
//! - `debian`: Debian's own compiler of the same age builds `core` from source, from packages alone.
//!
//! The first that works is taken; the environment variable `GIMBAL_TOOLCHAIN=rustup|debian` forces one.

use super::packages;
use crate::shell::{capture, cargo, program, target_dir, version_of};
use crate::stages::Missing;
use anyhow::{Context, Result};
use std::path::{Path, PathBuf};
use std::process::Command;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Toolchain {
    Rustup,
    Debian,
}

const DEBIAN_PACKAGES: [&str; 4] = ["rustc-web", "cargo-web", "rust-web-src", "lld"];

impl Toolchain {
    /// One that can build for `target`; installs what is missing.
    pub(crate) fn ready(target: &str) -> Result<Self> {
        match std::env::var("GIMBAL_TOOLCHAIN").as_deref() {
            Ok("rustup") => rustup(target).map(|()| Self::Rustup),
            Ok("debian") => debian().map(|()| Self::Debian),
            Ok(other) => anyhow::bail!("GIMBAL_TOOLCHAIN is `{other}`; it must be `rustup` or `debian`"),
            Err(_) => rustup(target).map(|()| Self::Rustup).or_else(|first| {
                debian().map(|()| Self::Debian).context(format!("no compiler for {target}: {first:#}"))
            }),
        }
    }

    /// `cargo WORDS --target TARGET`.
    pub(crate) fn cargo(self, words: &str, target: &str) -> Command {
        let mut command = match self {
            Self::Rustup => cargo(words),
            Self::Debian => {
                let mut command = program("/usr/bin/cargo");
                command
                    .env("RUSTC", "/usr/bin/rustc")
                    // `-Z build-std` is not stable; this compiler is.
                    .env("RUSTC_BOOTSTRAP", "1")
                    .env("RUSTFLAGS", self.flags())
                    .env("CARGO_TARGET_DIR", self.target_dir());
                // Set by the other cargo, the one that runs this program.
                for variable in ["CARGO", "RUSTUP_TOOLCHAIN", "RUSTDOC", "LD_LIBRARY_PATH"] {
                    command.env_remove(variable);
                }
                command.args(words.split_whitespace()).args(["-Z", "build-std=core,alloc"]);
                command
            }
        };
        command.args(["--target", target]);
        command
    }

    /// Flags for the compiler.
    pub(crate) fn flags(self) -> &'static str {
        match self {
            Self::Rustup => "",
            // By flag, because cargo cannot look up a linker for `thumbv8m.main`, whose name has a dot.
            Self::Debian => "-C linker=ld.lld",
        }
    }

    /// Each toolchain its own folder: one would throw away what the other has built.
    pub(crate) fn target_dir(self) -> PathBuf {
        match self {
            Self::Rustup => target_dir(),
            Self::Debian => target_dir().join("debian"),
        }
    }
}

/// The target's `core` lies in the toolchain, or rustup puts it there.
fn rustup(target: &str) -> Result<()> {
    let output = program("rustc").args(["--print", "sysroot"]).output().context("cannot start rustc")?;
    let sysroot = String::from_utf8(output.stdout)?;
    let library = Path::new(sysroot.trim()).join("lib/rustlib").join(target).join("lib");
    if library.exists() {
        return Ok(());
    }
    capture(program("rustup").args(["target", "add", target])).map(drop)
}

/// Debian's compiler, the source of `core` and a linker are there, or are installed.
fn debian() -> Result<()> {
    let have = Path::new("/usr/lib/rustlib/src/rust/library/core").exists()
        && version_of("/usr/bin/rustc").is_some()
        && version_of("/usr/bin/cargo").is_some()
        && version_of("ld.lld").is_some();
    if have {
        return Ok(());
    }
    packages::install(&DEBIAN_PACKAGES, "Debian's Rust compiler").map_err(|error| {
        Missing(format!(
            "{error:#}\na compiler for the boards is missing: `rustup target add` failed, and so did Debian's packages"
        ))
        .into()
    })
}
