//! Stage `blind`: the diagnosis on a small corpus whose answers are sealed, held against the committed score.
//!
//! The corpus is made again from its seed, which everybody knows: it guards what was reached, it is no blind score.

use crate::shell::{cargo, program, run, target_dir};
use crate::stages::Note;
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Where the score of the small corpus is committed.
const COMMITTED: &str = "docs/blind/check/score.json";
/// The corpus: 36 logs of 12 to 15 s; without the real flight, which is not part of the repository.
const FORGE: &str = "--logs 36 --seconds 12 15 --seed 8 --rocket none";

/// Forges, diagnoses and scores; the folder of the score.
fn score(against: Option<&str>) -> Result<PathBuf> {
    run(&mut cargo("build --release --quiet --package gimbal-cli"))?;
    let gimbal = target_dir().join("release/gimbal");
    let folder = target_dir().join("blind");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let [corpus, key, reports, into] = ["check", "key", "reports", "score"].map(|name| folder.join(name));
    let gimbal = |words: &str| {
        let mut command = program(&gimbal.to_string_lossy());
        command.arg("blind").args(words.split_whitespace());
        command
    };
    let path = |path: &Path| path.to_string_lossy().into_owned();
    run(gimbal("forge").arg(path(&corpus)).args(["--key", &path(&key)]).args(FORGE.split_whitespace()))?;
    let jobs = std::thread::available_parallelism().map_or(1, usize::from).to_string();
    // logs side by side use the processors better than one log on all of them
    run(gimbal("diagnose")
        .arg(path(&corpus))
        .args(["--out", &path(&reports), "--jobs", &jobs])
        .env("RAYON_NUM_THREADS", "1"))?;
    let mut last = gimbal("score");
    last.arg(path(&corpus)).args(["--key", &path(&key), "--reports", &path(&reports), "--out", &path(&into)]);
    if let Some(against) = against {
        last.args(["--against", against]);
    }
    run(&mut last)?;
    Ok(into)
}

/// The stage.
pub(crate) fn check() -> Result<Note> {
    let start = Instant::now();
    let committed = crate::shell::root().join(COMMITTED).exists();
    score(committed.then_some(COMMITTED))?;
    let held = if committed { "no loss against" } else { "scored; nothing to hold it against without" };
    Ok(format!("36 logs, {held} {COMMITTED}, {:.0} s", start.elapsed().as_secs_f64()))
}

/// Writes the committed score anew.
pub(crate) fn write() -> Result<()> {
    let from = score(None)?;
    let into = crate::shell::root().join(COMMITTED);
    let into = into.parent().context("a folder")?;
    fs::create_dir_all(into)?;
    for name in ["score.json", "score.md"] {
        fs::copy(from.join(name), into.join(name)).with_context(|| into.join(name).display().to_string())?;
    }
    Ok(())
}
