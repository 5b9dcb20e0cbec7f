//! Stage `fuzz`: arbitrary bytes for everything that reads bytes from the link, from the committed corpus on, for a few
//! seconds each. `cargo xtask fuzz SECONDS` runs longer, and adds to the corpus what reaches new code.
//!
//! LLVM's fuzzer needs its coverage counters alone, and the flags for those are stable; the sanitizers, which are not,
//! look for what code without `unsafe` cannot do.

use crate::shell::{cargo, program, root, run, target_dir, version_of};
use crate::stages::Note;
use anyhow::{Context, Result, ensure};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// Flags that `cargo fuzz` would give, but for the sanitizer.
const FLAGS: &str = "--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
                     -Cllvm-args=-sanitizer-coverage-inline-8bit-counters \
                     -Cllvm-args=-sanitizer-coverage-pc-table -Cllvm-args=-sanitizer-coverage-trace-compares";
/// With a target named, what cargo builds for itself stays without counters.
const HOST: &str = "x86_64-unknown-linux-gnu";
const TARGETS: [&str; 5] = ["receiver", "frame", "computer", "bench", "record"];
/// Time for each target in the stage [s].
const SECONDS: u32 = 4;
/// Longest input [bytes].
const LONGEST: u32 = 2_048;

/// The stage.
pub(crate) fn check() -> Result<Note> {
    let missing = if !cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        Some("runs on x86-64 Linux")
    } else if version_of("c++").is_none() {
        Some("needs a C++ compiler")
    } else {
        None
    };
    if let Some(what) = missing {
        println!("SKIPPED: {what}");
        return Ok(format!("skipped: {what}"));
    }
    // Clippy sees no other workspace.
    run(&mut cargo("fmt --manifest-path fuzz/Cargo.toml --check"))?;
    let folder = build()?;
    let mut runs = Vec::new();
    for target in TARGETS {
        // Two at a time: what is found goes to a folder that is thrown away.
        let found = target_dir().join("fuzz/found").join(target);
        let _ = fs::remove_dir_all(&found);
        fs::create_dir_all(&found)?;
        runs.push((target, start(&folder, target, &found, SECONDS)?));
        if runs.len() == 2 {
            finish(&mut runs)?;
        }
    }
    finish(&mut runs)?;
    Ok(format!("{} targets, {SECONDS} s each", TARGETS.len()))
}

/// The task: `seconds` for each target; what reaches new code joins the corpus, at its smallest.
pub(crate) fn fuzz(seconds: u32) -> Result<()> {
    let folder = build()?;
    for target in TARGETS {
        let found = target_dir().join("fuzz/found").join(target);
        fs::create_dir_all(&found)?;
        finish(&mut vec![(target, start(&folder, target, &found, seconds)?)])?;
        let corpus = corpus(target);
        fs::create_dir_all(&corpus)?;
        run(program(&folder.join(target).to_string_lossy()).arg("-set_cover_merge=1").arg(&corpus).arg(&found))?;
    }
    Ok(())
}

/// The instrumented programs, in a folder of their own: other flags would throw away what the other stages have built.
fn build() -> Result<PathBuf> {
    let folder = target_dir().join("fuzz");
    let words = format!("build --quiet --release --locked --manifest-path fuzz/Cargo.toml --target {HOST}");
    run(cargo(&words).env("RUSTFLAGS", FLAGS).env("CARGO_TARGET_DIR", &folder))?;
    Ok(folder.join(HOST).join("release"))
}

fn corpus(target: &str) -> PathBuf {
    root().join("fuzz/corpus").join(target)
}

type Running = (&'static str, std::process::Child);

/// Starts a target on its corpus; what it finds goes to `found`.
fn start(folder: &Path, target: &str, found: &Path, seconds: u32) -> Result<std::process::Child> {
    println!("fuzz {target}, {seconds} s");
    program(&folder.join(target).to_string_lossy())
        .args([found.to_owned(), corpus(target), root().join("wire/tests/corpus")])
        .args([format!("-max_total_time={seconds}"), format!("-max_len={LONGEST}"), "-timeout=20".to_owned()])
        .args([format!("-artifact_prefix={}/", target_dir().join("fuzz").display()), "-seed=1".to_owned()])
        .args(["-close_fd_mask=1", "-verbosity=0", "-print_final_stats=1"])
        .stderr(Stdio::piped())
        .spawn()
        .with_context(|| format!("fuzz target {target}"))
}

/// Waits for them; a target that has found a fault is an error, with the input that shows it.
fn finish(runs: &mut Vec<Running>) -> Result<()> {
    for (target, child) in runs.drain(..) {
        let output = child.wait_with_output()?;
        let told = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "fuzz target {target}:\n{told}");
        let runs = told.lines().find_map(|line| line.strip_prefix("stat::number_of_executed_units:"));
        println!("{target}: {} inputs", runs.map_or("no", str::trim));
    }
    Ok(())
}
