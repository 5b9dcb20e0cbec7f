//! `gimbal blind freeze`: the record of a diagnosis, before the seed of its corpus is drawn.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use gimbal_forge::folder;
use gimbal_forge::freeze::{FREEZE_SCHEMA, Freeze};
use gimbal_forge::seal::sha256;

use super::{now_unix_s, refused};
use crate::exit::Failure;

/// Options of `gimbal blind freeze`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// File for the record; must not exist yet. Commit it before the corpus is made.
    record: PathBuf,
    /// Program that will diagnose; without one, this program.
    #[arg(long)]
    program: Option<PathBuf>,
    /// Commit that the program was built from; without one, the present commit.
    #[arg(long)]
    commit: Option<String>,
    /// Files of calibration that are not part of the program.
    #[arg(long, num_args = 1..)]
    calibration: Vec<PathBuf>,
}

fn git(folder: &Path, words: &[&str]) -> Result<Vec<u8>, Failure> {
    let output = Command::new("git")
        .arg("-C")
        .arg(folder)
        .args(words)
        .output()
        .map_err(|why| Failure::Environment(anyhow::anyhow!("git: cannot be run: {why}")))?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(Failure::input(format!("git {}: {}", words.join(" "), said.lines().last().unwrap_or("no word"))))
}

/// Records program, commit and calibration.
pub(super) fn freeze(args: &Args) -> Result<(), Failure> {
    if args.record.exists() {
        return Err(Failure::input(format!("{}: exists; a record is made once", args.record.display())));
    }
    let program = match &args.program {
        Some(program) => program.clone(),
        None => std::env::current_exe().map_err(|why| Failure::Environment(why.into()))?,
    };
    let commit = match &args.commit {
        Some(commit) => commit.clone(),
        None => String::from_utf8_lossy(&git(Path::new("."), &["rev-parse", "HEAD"])?).trim().to_owned(),
    };
    let hash = |path: &Path| folder::read(path).map(|bytes| sha256(&bytes)).map_err(|why| refused(&why));
    let mut calibration = BTreeMap::new();
    for path in &args.calibration {
        calibration.insert(path.display().to_string(), hash(path)?);
    }
    let record = Freeze {
        schema: FREEZE_SCHEMA.to_owned(),
        program_sha256: hash(&program)?,
        commit,
        calibration,
        frozen_unix_s: now_unix_s(),
    };
    folder::write_json(&args.record, &record).map_err(|why| refused(&why))?;
    println!("{}: SHA-256 of {} is {}", args.record.display(), program.display(), record.program_sha256);
    println!("commit it, then: gimbal blind forge CORPUS --key KEY --freeze {}", args.record.display());
    Ok(())
}

/// The bytes of a record, if the present commit holds the very same.
pub(super) fn committed(path: &Path) -> Result<Vec<u8>, Failure> {
    let bytes = fs::read(path).map_err(|why| Failure::input(format!("{}: {why}", path.display())))?;
    serde_json::from_slice::<Freeze>(&bytes)
        .map_err(|why| Failure::input(format!("{}: not a record of `gimbal blind freeze`: {why}", path.display())))?;
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let held = git(folder, &["show", &format!("HEAD:./{name}")]);
    if held.is_ok_and(|held| held == bytes) {
        return Ok(bytes);
    }
    Err(Failure::input(format!(
        "{}: commit it first; the seed is drawn after the record of the diagnosis is in the history",
        path.display()
    )))
}
