//! `gimbal blind score`.

use std::fs;
use std::path::{Path, PathBuf};

use gimbal_forge::folder;
use gimbal_forge::score::page::{self, Head};
use gimbal_forge::score::{Score, compare};
use gimbal_forge::seal::sha256;

use super::{now_unix_s, refused};
use crate::exit::Failure;

/// Options of `gimbal blind score`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folder of the corpus.
    dir: PathBuf,
    /// The key that opens the answers; this releases it. A development set needs none.
    #[arg(long)]
    key: Option<PathBuf>,
    /// Folder of the reports with their manifest.
    #[arg(long)]
    reports: PathBuf,
    /// Folder for `score.md`, `score.html`, `score.json` and the opened answers.
    #[arg(long)]
    out: PathBuf,
    /// An older `score.json` of the same corpus: status 1 where a figure lies below the interval that it had there.
    #[arg(long)]
    against: Option<PathBuf>,
    /// Prints the score as one JSON object.
    #[arg(long)]
    json: bool,
}

#[derive(serde::Serialize)]
struct Printed<'a> {
    schema: &'static str,
    head: &'a Head,
    score: &'a Score,
}

/// Holds a score against an older one.
fn held_against(path: &Path, score: &Score) -> Result<(), Failure> {
    let before: compare::File = folder::read_json(path).map_err(|why| refused(&why))?;
    let changes = compare::compare(&before.score, score);
    for change in &changes {
        let (old, (low, high)) = change.before;
        let mark = if change.lost { "LOST" } else { "held" };
        eprintln!("{mark}  {:58} {old:.3} ({low:.3} to {high:.3}) then, {:.3} now", change.what, change.now);
    }
    let lost = changes.iter().filter(|change| change.lost).count();
    if lost == 0 {
        Ok(())
    } else {
        Err(Failure::Fails(format!("{lost} figures below the intervals of {}", path.display())))
    }
}

/// Opens the answers and writes the score.
pub(super) fn score(args: &Args) -> Result<(), Failure> {
    let now = now_unix_s();
    let published: folder::Published = folder::read_json(&args.dir.join("corpus.json")).map_err(|why| refused(&why))?;
    let opened = match &args.key {
        _ if published.open => folder::development_answers(&args.dir, &args.reports),
        Some(key) => folder::open_answers(&args.dir, &args.reports, key, now),
        None => return Err(Failure::input("--key: the answers of this corpus are sealed")),
    };
    let (answers, manifest) = opened.map_err(|why| refused(&why))?;
    fs::create_dir_all(&args.out).map_err(Failure::write(&args.out))?;
    folder::write_json(&args.out.join("answers.json"), &answers).map_err(|why| refused(&why))?;
    let opened_unix_s = if published.open {
        None
    } else {
        let release: folder::Release = folder::read_json(&args.dir.join("opened.json")).map_err(|why| refused(&why))?;
        Some(release.released_unix_s)
    };
    let freeze = gimbal_forge::freeze::of_corpus(&args.dir, &published).map_err(|why| refused(&why))?;
    let (seed, length_s, shares) = (answers.seed.clone(), answers.length_s, answers.shares);
    let judged = folder::judged(answers, &manifest, &args.reports).map_err(|why| refused(&why))?;
    let score = Score::of(&judged);
    let head = Head {
        corpus: args.dir.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        corpus_sha256: manifest.corpus_sha256.clone(),
        manifest_sha256: sha256(&folder::read(&args.reports.join("manifest.json")).map_err(|why| refused(&why))?),
        program_sha256: manifest.program_sha256.clone(),
        commit: freeze.as_ref().map(|freeze| freeze.commit.clone()),
        freeze_sha256: published.freeze_sha256.clone(),
        frozen_unix_s: freeze.as_ref().map(|freeze| freeze.frozen_unix_s),
        seed,
        length_s,
        shares,
        diagnosed_unix_s: manifest.span_unix_s.1,
        opened_unix_s,
    };
    let result = Printed { schema: "gimbal-blind-score/1", head: &head, score: &score };
    folder::write_json(&args.out.join("score.json"), &result).map_err(|why| refused(&why))?;
    let texts = [
        ("score.md", page::markdown(&head, &score)),
        ("score.html", page::html(&head, &score)),
        ("row.md", format!("{}\n", page::row(&head, &score))),
    ];
    for (name, text) in texts {
        let path = args.out.join(name);
        fs::write(&path, text).map_err(Failure::write(&path))?;
    }
    if args.json {
        println!("{}", serde_json::to_string(&result).map_err(|why| Failure::Environment(why.into()))?);
    } else {
        for gate in &score.gates {
            let kept = gate.kept().map_or("-", |kept| if kept { "kept" } else { "missed" });
            println!("{kept:6}  {:58} {}", gate.what, gate.text);
        }
        println!("{}", args.out.join("score.html").display());
    }
    args.against.as_deref().map_or(Ok(()), |path| held_against(path, &score))
}
