//! The folder of a corpus, the manifest of a diagnosis, and the rules by which answers may be opened.
//!
//! ```text
//! DIR/corpus.json          what is published: hashes of all logs and of the answers
//! DIR/logs/00001.csv       a log        DIR/logs/00001.toml   its nominal model
//! DIR/answers.age          the sealed answers; the key is elsewhere
//! REPORTS/00001/gap.json   a report     REPORTS/manifest.json hashes and times, written when all are there
//! DIR/freeze.json          the record of the diagnosis that the seed was drawn after
//! DIR/diagnosed.json       where the one diagnosis went
//! KEY.released DIR/opened.json          when the answers were opened, and for which manifest
//! ```

mod open;
mod refusal;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

pub use self::open::{development_answers, judged, open_answers};
pub use self::refusal::Refusal;
use crate::corpus::Answer;
use crate::seal::sha256;

/// Name of the form of a corpus.
pub const CORPUS_SCHEMA: &str = "gimbal-blind-corpus/1";
/// Name of the form of a manifest.
pub const MANIFEST_SCHEMA: &str = "gimbal-blind-manifest/1";

/// What is published beside the logs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Published {
    /// [`CORPUS_SCHEMA`].
    pub schema: String,
    /// When it was made [s since 1970].
    pub made_unix_s: u64,
    /// Whether the answers lie beside the logs, for development.
    #[serde(default)]
    pub open: bool,
    /// SHA-256 of the record of the diagnosis that the seed was drawn after; none for a check with a known seed.
    #[serde(default)]
    pub freeze_sha256: Option<String>,
    /// SHA-256 of the answers before sealing.
    pub answers_sha256: String,
    /// SHA-256 of the sealed answers.
    pub sealed_sha256: String,
    /// Whom the answers are sealed for.
    pub recipient: String,
    /// SHA-256 of each file in `logs`, by name.
    pub files: BTreeMap<String, String>,
}

/// The answers to a corpus.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Answers {
    /// Seed in hexadecimal digits, from which the corpus can be made again.
    pub seed: String,
    /// What was mixed with the record of the diagnosis to give the seed, in hexadecimal digits.
    #[serde(default)]
    pub nonce: Option<String>,
    /// Version of the forge.
    pub version: String,
    /// SHA-256 of the real flight that served as input, if one did.
    pub rocket_sha256: Option<String>,
    /// Least and largest length of a log [s].
    pub length_s: (f64, f64),
    /// Shares of nothing, one, two, three and beyond [percent].
    #[serde(default)]
    pub shares: [usize; 5],
    /// Least and largest size over the detectable one.
    #[serde(default)]
    pub multiples: (f64, f64),
    /// One a log.
    pub answers: Vec<Answer>,
}

/// One report in a manifest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Name of the log, without ending.
    pub log: String,
    /// SHA-256 of its `gap.json`; none where the diagnosis failed.
    pub sha256: Option<String>,
    /// Time that the diagnosis took [s].
    pub seconds: f64,
    /// What it said when it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// What a diagnosis of a corpus is committed to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`MANIFEST_SCHEMA`].
    pub schema: String,
    /// SHA-256 of the corpus's `corpus.json`.
    pub corpus_sha256: String,
    /// The command that was run.
    pub command: String,
    /// SHA-256 of the program that was run.
    pub program_sha256: String,
    /// When the first report was begun and the last one finished [s since 1970].
    pub span_unix_s: (u64, u64),
    /// One a log.
    pub reports: Vec<Entry>,
}

/// Where the one diagnosis of a corpus goes: written before its first report.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Claim {
    /// Folder of the reports.
    pub reports: PathBuf,
    /// SHA-256 of the program.
    pub program_sha256: String,
    /// [s since 1970]
    pub begun_unix_s: u64,
}

/// Claims a corpus for one diagnosis; the same one may go on.
///
/// # Errors
/// Another one has it.
pub fn claim(corpus: &Path, claim: &Claim) -> Result<(), Refusal> {
    let path = corpus.join("diagnosed.json");
    if !path.exists() {
        return write_json(&path, claim);
    }
    let before: Claim = read_json(&path)?;
    if before.reports == claim.reports && before.program_sha256 == claim.program_sha256 {
        Ok(())
    } else {
        Err(Refusal::Diagnosed(before.reports.display().to_string()))
    }
}

/// When answers were opened, and for which manifest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Release {
    /// [s since 1970]
    pub released_unix_s: u64,
    /// SHA-256 of `manifest.json`.
    pub manifest_sha256: String,
    /// SHA-256 of `corpus.json`.
    pub corpus_sha256: String,
}

/// Bytes of a file.
///
/// # Errors
/// The file cannot be read.
pub fn read(path: &Path) -> Result<Vec<u8>, Refusal> {
    std::fs::read(path).map_err(|why| Refusal::file(path, why))
}

/// A JSON file.
///
/// # Errors
/// The file cannot be read or does not have the form.
pub fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, Refusal> {
    serde_json::from_slice(&read(path)?).map_err(|why| Refusal::file(path, why))
}

/// Writes a JSON file, for people too.
///
/// # Errors
/// The file cannot be written.
pub fn write_json<T: Serialize>(path: &Path, value: &T) -> Result<(), Refusal> {
    let mut text = serde_json::to_string_pretty(value).map_err(|why| Refusal::file(path, why))?;
    text.push('\n');
    std::fs::write(path, text).map_err(|why| Refusal::file(path, why))
}

/// The record beside a key: when it was released.
#[must_use]
pub fn release_path(key: &Path) -> PathBuf {
    let mut name = key.as_os_str().to_owned();
    name.push(".released");
    PathBuf::from(name)
}

fn modified_unix_s(path: &Path) -> u64 {
    std::fs::metadata(path)
        .and_then(|data| data.modified())
        .ok()
        .and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok())
        .map_or(0, |age| age.as_secs())
}

/// Holds the logs against what was published.
///
/// # Errors
/// The first file that differs or is missing.
pub fn check_logs(corpus: &Path, published: &Published) -> Result<(), Refusal> {
    for (name, hash) in &published.files {
        if sha256(&read(&corpus.join("logs").join(name))?) != *hash {
            return Err(Refusal::Corpus(name.clone()));
        }
    }
    Ok(())
}
