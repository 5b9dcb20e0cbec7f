//! Stage `package`: the library's package is whole, and a program outside the workspace that depends on it by path gets
//! the same bits with no feature, with each, and with all.

use super::digests;
use crate::shell::{capture, cargo, program, root, target_dir};
use crate::stages::Note;
use anyhow::{Result, ensure};
use std::fs;
use std::path::{Path, PathBuf};

/// Features of the library, alone and together.
const FEATURES: [&str; 4] = ["", "\"serde\"", "\"defmt\"", "\"serde\", \"defmt\""];

/// What the package's folder must hold, beside the sources.
const BESIDE: [&str; 4] = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"];

pub(crate) fn check() -> Result<Note> {
    let package = unpacked()?;
    for file in BESIDE {
        ensure!(package.join(file).exists(), "the package has no {file}");
    }
    let expected: Vec<String> =
        digests::release()?.lines().filter(|line| line.starts_with("digest stops ")).map(str::to_owned).collect();
    for features in FEATURES {
        let output = consume(&package, features)?;
        ensure!(output.lines().eq(&expected), "with features [{features}]:\n{output}in the workspace:\n{expected:?}");
        println!("features [{features}]: {} digests equal the workspace's", expected.len());
    }
    Ok(format!("the same bits outside the workspace, with {} sets of features", FEATURES.len()))
}

/// The package as cargo makes it, builds it and leaves it. Uncommitted work is packed too, but only where there is some.
fn unpacked() -> Result<PathBuf> {
    let status = capture(program("git").args(["status", "--porcelain"])).unwrap_or_else(|_| "no repository".into());
    let mut command = cargo("package --quiet --package gimbal-servo");
    if !status.is_empty() {
        command.arg("--allow-dirty");
    }
    capture(&mut command)?;
    Ok(target_dir().join("package").join(format!("gimbal-servo-{}", env!("CARGO_PKG_VERSION"))))
}

/// Runs the program of `xtask/consumer` with these features of the library.
fn consume(package: &Path, features: &str) -> Result<String> {
    let folder = target_dir().join("consumer");
    fs::create_dir_all(folder.join("src"))?;
    fs::copy(root().join("xtask/consumer/main.rs"), folder.join("src/main.rs"))?;
    fs::write(
        folder.join("Cargo.toml"),
        format!(
            "[package]\nname = \"consumer\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
             [dependencies]\ngimbal-servo = {{ path = \"{}\", features = [{features}] }}\n",
            package.display()
        ),
    )?;
    capture(cargo("run --quiet --release").current_dir(&folder).env("CARGO_TARGET_DIR", folder.join("target")))
}
