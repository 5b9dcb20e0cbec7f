//! `gimbal blind diagnose`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use gimbal_forge::folder::{self, Claim, Entry, MANIFEST_SCHEMA, Manifest, Published};
use gimbal_forge::seal::sha256;

use super::{bar, now_unix_s, refused};
use crate::exit::Failure;
use crate::interrupt;

/// Options of `gimbal blind diagnose`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folder of the corpus.
    dir: PathBuf,
    /// Folder for the reports. A manifest closes it; until then the command goes on where it was interrupted.
    #[arg(long)]
    out: PathBuf,
    /// Diagnoses that run at once.
    #[arg(long, default_value_t = 1)]
    jobs: usize,
    /// Command with `{log}`, `{model}` and `{out}`; without one, this program's `gap {log} --model {model} --out {out}`.
    #[arg(last = true)]
    command: Vec<String>,
}

struct Run<'a> {
    logs: PathBuf,
    out: &'a Path,
    command: Vec<String>,
}

impl Run<'_> {
    /// Diagnoses one log, or takes over what an interrupted run left.
    fn diagnose(&self, log: &str) -> Result<Entry, Failure> {
        let folder = self.out.join(log);
        let (report, record) = (folder.join("gap.json"), folder.join("entry.json"));
        if let Ok(entry) = folder::read_json::<Entry>(&record) {
            let there = fs::read(&report).ok().map(|bytes| sha256(&bytes));
            if there == entry.sha256 {
                return Ok(entry);
            }
        }
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).map_err(Failure::write(&folder))?;
        let fill = |word: &String| {
            word.replace("{log}", &self.logs.join(format!("{log}.csv")).to_string_lossy())
                .replace("{model}", &self.logs.join(format!("{log}.toml")).to_string_lossy())
                .replace("{out}", &folder.to_string_lossy())
        };
        let words: Vec<String> = self.command.iter().map(fill).collect();
        let from = Instant::now();
        let output = Command::new(&words[0])
            .args(&words[1..])
            .stdin(Stdio::null())
            .output()
            .map_err(|why| Failure::Environment(anyhow::anyhow!("{}: cannot be run: {why}", words[0])))?;
        let seconds = from.elapsed().as_secs_f64();
        interrupt::check()?;
        let sha256 = fs::read(&report).ok().map(|bytes| sha256(&bytes));
        let said = String::from_utf8_lossy(&output.stderr);
        let failure = sha256.is_none().then(|| {
            format!(
                "{}: {}",
                output.status,
                said.lines().last().unwrap_or("no word").chars().take(300).collect::<String>()
            )
        });
        let entry = Entry { log: log.to_owned(), sha256, seconds, failure };
        folder::write_json(&record, &entry).map_err(|why| refused(&why))?;
        Ok(entry)
    }
}

/// The program and what it is called with.
fn command(args: &Args) -> Result<Vec<String>, Failure> {
    if !args.command.is_empty() {
        return Ok(args.command.clone());
    }
    let own = std::env::current_exe().map_err(|why| Failure::Environment(why.into()))?;
    let mut words = vec![own.to_string_lossy().into_owned()];
    words.extend(["gap", "{log}", "--model", "{model}", "--out", "{out}"].map(str::to_owned));
    Ok(words)
}

/// Diagnoses every log and writes the manifest.
pub(super) fn diagnose(args: &Args) -> Result<(), Failure> {
    let corpus_path = args.dir.join("corpus.json");
    let corpus_sha256 = sha256(&folder::read(&corpus_path).map_err(|why| refused(&why))?);
    let published: Published = folder::read_json(&corpus_path).map_err(|why| refused(&why))?;
    let manifest_path = args.out.join("manifest.json");
    if manifest_path.exists() {
        return Err(Failure::input(format!("{}: exists; one diagnosis a corpus", manifest_path.display())));
    }
    folder::check_logs(&args.dir, &published).map_err(|why| refused(&why))?;
    let command = command(args)?;
    let program = fs::read(&command[0])
        .map_err(|why| Failure::input(format!("{}: {why}; give the program with its path", command[0])))?;
    let program_sha256 = sha256(&program);
    if let Some(freeze) = gimbal_forge::freeze::of_corpus(&args.dir, &published).map_err(|why| refused(&why))? {
        freeze.check_program(&program_sha256).map_err(|why| refused(&why))?;
    }
    if !published.open {
        let reports = std::path::absolute(&args.out).unwrap_or_else(|_| args.out.clone());
        let claim = Claim { reports, program_sha256: program_sha256.clone(), begun_unix_s: now_unix_s() };
        folder::claim(&args.dir, &claim).map_err(|why| refused(&why))?;
    }
    let logs: Vec<&str> = published.files.keys().filter_map(|name| name.strip_suffix(".csv")).collect();
    let from_unix_s = now_unix_s();
    let run = Run { logs: args.dir.join("logs"), out: &args.out, command };
    let bar = bar(logs.len() as u64, "diagnoses");
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..args.jobs.clamp(1, 256) {
            scope.spawn(|| {
                while let Some(log) = logs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let result = if interrupt::raised() { Err(Failure::Interrupted) } else { run.diagnose(log) };
                    let failed = result.is_err();
                    if let Ok(mut results) = results.lock() {
                        results.push(result);
                    }
                    if failed {
                        next.store(logs.len(), Ordering::Relaxed);
                    }
                    bar.inc(1);
                }
            });
        }
    });
    bar.finish_and_clear();
    let mut reports: Vec<Entry> = results.into_inner().unwrap_or_default().into_iter().collect::<Result<_, _>>()?;
    reports.sort_by(|a, b| a.log.cmp(&b.log));
    let failed = reports.iter().filter(|entry| entry.sha256.is_none()).count();
    let manifest = Manifest {
        schema: MANIFEST_SCHEMA.to_owned(),
        corpus_sha256,
        command: run.command.join(" "),
        program_sha256,
        span_unix_s: (from_unix_s, now_unix_s()),
        reports,
    };
    folder::write_json(&manifest_path, &manifest).map_err(|why| refused(&why))?;
    let hash = sha256(&folder::read(&manifest_path).map_err(|why| refused(&why))?);
    println!("{} reports, {failed} failed, in {}", manifest.reports.len(), args.out.display());
    println!("SHA-256 of the manifest: {hash}");
    Ok(())
}
