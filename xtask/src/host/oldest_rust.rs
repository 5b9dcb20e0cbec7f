//! Stage `oldest-rust`: the library builds with the oldest compiler that its Cargo.toml promises.
//!
//! The workspace needs a newer one (lock file, tools), so the library is copied out and checked alone.

use crate::shell::{capture, cargo, program, root, target_dir, version_of};
use crate::stages::Note;
use anyhow::{Context, Result};
use std::fs;
use std::path::Path;

pub(crate) fn check() -> Result<Note> {
    let version = promised_version()?;
    if version_of("rustup").is_none() {
        return Ok(format!("skipped: needs rustup to fetch Rust {version}"));
    }
    let toolchain = format!("{version}-x86_64-unknown-linux-gnu");
    let installed = capture(program("rustup").args(["toolchain", "list"]))?.contains(&toolchain)
        || capture(program("rustup").args(["toolchain", "install", "--profile", "minimal", &version])).is_ok();
    if !installed {
        return Ok(format!("skipped: Rust {version} cannot be fetched here"));
    }
    let copy = target_dir().join("oldest-rust/package");
    if copy.exists() {
        fs::remove_dir_all(&copy)?;
    }
    copy_folder(&root().join("src"), &copy.join("src"))?;
    fs::write(copy.join("Cargo.toml"), manifest()?)?;
    for features in ["--no-default-features", "--all-features"] {
        // RUSTC and the like were set by the newer cargo that runs this program.
        capture(
            program("rustup")
                .current_dir(&copy)
                .env_remove("RUSTC")
                .env_remove("RUSTDOC")
                .env_remove("CARGO")
                .env_remove("RUSTUP_TOOLCHAIN")
                .env("CARGO_TARGET_DIR", target_dir().join("oldest-rust/target"))
                .args(["run", &version, "cargo", "check", "--quiet", "--package", "gimbal-servo", features]),
        )
        .with_context(|| format!("Rust {version} does not build the library"))?;
    }
    Ok(format!("Rust {version}"))
}

/// `rust-version` of the library.
fn promised_version() -> Result<String> {
    let metadata: serde_json::Value =
        serde_json::from_str(&capture(&mut cargo("metadata --format-version 1 --no-deps"))?)?;
    let packages = metadata["packages"].as_array().context("no packages in cargo metadata")?;
    let library = packages.iter().find(|package| package["name"] == "gimbal-servo").context("no library")?;
    let version = library["rust_version"].as_str().context("the library promises no Rust version")?;
    Ok(version.to_owned())
}

/// The library's manifest without the workspace around it: dependencies and features are what matters.
fn manifest() -> Result<String> {
    let text = fs::read_to_string(root().join("Cargo.toml"))?;
    let whole: toml::Table = toml::from_str(&text)?;
    let mut alone = toml::Table::new();
    let mut package = toml::Table::new();
    for (key, value) in [("name", "gimbal-servo"), ("version", "0.0.0"), ("edition", "2024")] {
        package.insert(key.into(), toml::Value::String(value.into()));
    }
    alone.insert("package".into(), package.into());
    alone.insert("workspace".into(), toml::Table::new().into());
    for key in ["dependencies", "features"] {
        alone.insert(key.into(), whole.get(key).with_context(|| format!("no [{key}]"))?.clone());
    }
    Ok(toml::to_string(&alone)?)
}

fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy_folder(&entry.path(), &target)?;
        } else {
            fs::copy(entry.path(), target)?;
        }
    }
    Ok(())
}
