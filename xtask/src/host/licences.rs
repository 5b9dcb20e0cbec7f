//! Stage `licences`: every package that can be linked in comes from crates.io and under a licence that `deny.toml`
//! allows.

use super::{deny, spdx};
use crate::shell::{capture, cargo, root};
use crate::stages::Note;
use anyhow::{Result, bail};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::fs;

#[derive(Deserialize)]
struct Rules {
    licenses: Licenses,
}

#[derive(Deserialize)]
struct Licenses {
    allow: BTreeSet<String>,
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
    /// None for a package of this workspace.
    source: Option<String>,
}

const CRATES_IO: &str = "registry+https://github.com/rust-lang/crates.io-index";

pub(crate) fn check() -> Result<Note> {
    let rules: Rules = toml::from_str(&fs::read_to_string(root().join("deny.toml"))?)?;
    let metadata: Metadata =
        serde_json::from_str(&capture(&mut cargo("metadata --format-version 1 --locked --all-features"))?)?;
    let complaints: Vec<String> =
        metadata.packages.iter().filter_map(|package| complaint(package, &rules.licenses.allow)).collect();
    if !complaints.is_empty() {
        bail!("{}", complaints.join("\n"));
    }
    let count = metadata.packages.len();
    if deny::installed() {
        deny::check()?;
        return Ok(format!("{count} packages, and cargo-deny"));
    }
    Ok(format!("{count} packages (advisories and duplicates: `cargo xtask deny`)"))
}

fn complaint(package: &Package, allowed: &BTreeSet<String>) -> Option<String> {
    let Package { name, version, .. } = package;
    if package.source.as_deref().is_some_and(|source| source != CRATES_IO) {
        return Some(format!("{name} {version} does not come from crates.io"));
    }
    let Some(expression) = &package.license else {
        return Some(format!("{name} {version} names no licence"));
    };
    if spdx::satisfied(expression, allowed) {
        return None;
    }
    Some(format!("{name} {version} is under `{expression}`, which deny.toml does not allow"))
}
