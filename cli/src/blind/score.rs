//! `gimbal blind score`.

use std::fs;
use std::path::PathBuf;

use gimbal_forge::folder;
use gimbal_forge::score::Score;
use gimbal_forge::score::page::{self, Head};
use gimbal_forge::seal::sha256;

use super::{now_unix_s, refused};
use crate::exit::Failure;

/// Options of `gimbal blind score`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Folder of the corpus.
    dir: PathBuf,
    /// The key that opens the answers; this releases it.
    #[arg(long)]
    key: PathBuf,
    /// Folder of the reports with their manifest.
    #[arg(long)]
    reports: PathBuf,
    /// Folder for `score.md`, `score.html`, `score.json` and the opened answers.
    #[arg(long)]
    out: PathBuf,
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

/// Opens the answers and writes the score.
pub(super) fn score(args: &Args) -> Result<(), Failure> {
    let now = now_unix_s();
    let (answers, manifest) =
        folder::open_answers(&args.dir, &args.reports, &args.key, now).map_err(|why| refused(&why))?;
    fs::create_dir_all(&args.out).map_err(Failure::write(&args.out))?;
    folder::write_json(&args.out.join("answers.json"), &answers).map_err(|why| refused(&why))?;
    let release: folder::Release = folder::read_json(&args.dir.join("opened.json")).map_err(|why| refused(&why))?;
    let judged = folder::judged(answers, &manifest, &args.reports).map_err(|why| refused(&why))?;
    let score = Score::of(&judged);
    let head = Head {
        corpus: args.dir.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
        corpus_sha256: manifest.corpus_sha256.clone(),
        manifest_sha256: sha256(&folder::read(&args.reports.join("manifest.json")).map_err(|why| refused(&why))?),
        program_sha256: manifest.program_sha256.clone(),
        diagnosed_unix_s: manifest.span_unix_s.1,
        opened_unix_s: release.released_unix_s,
    };
    let result = Printed { schema: "gimbal-blind-score/1", head: &head, score: &score };
    folder::write_json(&args.out.join("score.json"), &result).map_err(|why| refused(&why))?;
    for (name, text) in [("score.md", page::markdown(&head, &score)), ("score.html", page::html(&head, &score))] {
        let path = args.out.join(name);
        fs::write(&path, text).map_err(Failure::write(&path))?;
    }
    if args.json {
        println!("{}", serde_json::to_string(&result).map_err(|why| Failure::Environment(why.into()))?);
    } else {
        for gate in &score.gates {
            let kept = if gate.kept { "kept  " } else { "missed" };
            println!("{kept}  {:58} {}", gate.what, gate.rate.text());
        }
        println!("{}", args.out.join("score.html").display());
    }
    Ok(())
}
