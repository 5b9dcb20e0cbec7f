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

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::corpus::Answer;
use crate::freeze;
use crate::seal::{self, sha256};

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

/// Why answers are not opened.
#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    /// A file cannot be read or written.
    #[error("{path}: {why}")]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// A log or the answers are not those that were published.
    #[error("{0} is not the file that was published with the corpus")]
    Corpus(String),
    /// The manifest belongs to another corpus.
    #[error("the manifest was made for another corpus")]
    OtherCorpus,
    /// A report is not the one in the manifest.
    #[error("report {0} was changed after the manifest was written; its hash differs")]
    ReportChanged(String),
    /// A report is there that the manifest does not have, or the other way round.
    #[error("report {0} is in the manifest or in the corpus, but not in both")]
    ReportCount(String),
    /// The reports are newer than the key's release.
    #[error("the reports are newer than the key's release ({reports_unix_s} against {released_unix_s} s since 1970)")]
    ReportsNewer {
        /// When the last report was written.
        reports_unix_s: u64,
        /// When the key was released.
        released_unix_s: u64,
    },
    /// The corpus was opened for another diagnosis before.
    #[error("this corpus was opened for another diagnosis already; one diagnosis a corpus")]
    OpenedBefore,
    /// The program or its calibration is not the one on record.
    #[error("the diagnosis is not the one that was recorded before the seed was drawn ({recorded}, not {found})")]
    OtherProgram {
        /// On record.
        recorded: String,
        /// Found.
        found: String,
    },
    /// An act came too early.
    #[error("{later} is newer than {earlier}; a scoring corpus is made after the record and before the diagnosis")]
    Order {
        /// Should be the older one.
        later: &'static str,
        /// Should be the newer one.
        earlier: &'static str,
    },
    /// The seed does not come from the record.
    #[error("the seed was not drawn after the record of the diagnosis")]
    Seed,
    /// The logs were seen by another diagnosis.
    #[error("{0}: this corpus is being diagnosed there, or was; one diagnosis a corpus")]
    Diagnosed(String),
    /// Key or sealed answers.
    #[error(transparent)]
    Seal(#[from] seal::SealError),
}

impl Refusal {
    /// Whether a file could not be read or written because of the environment.
    #[must_use]
    pub fn file(path: &Path, why: impl std::fmt::Display) -> Self {
        Self::File { path: path.to_owned(), why: why.to_string() }
    }
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

/// Opens the answers, if reports, manifest and release allow it, and records the release.
///
/// # Errors
/// A [`Refusal`], before anything is opened.
pub fn open_answers(
    corpus: &Path,
    reports: &Path,
    key: &Path,
    now_unix_s: u64,
) -> Result<(Answers, Manifest), Refusal> {
    let published_bytes = read(&corpus.join("corpus.json"))?;
    let published: Published = read_json(&corpus.join("corpus.json"))?;
    let manifest_path = reports.join("manifest.json");
    let manifest_bytes = read(&manifest_path)?;
    let manifest: Manifest = read_json(&manifest_path)?;
    let corpus_sha256 = sha256(&published_bytes);
    if manifest.corpus_sha256 != corpus_sha256 {
        return Err(Refusal::OtherCorpus);
    }
    let newest = check_reports(&published, &manifest, reports)?;
    let freeze = freeze::of_corpus(corpus, &published)?;
    if let Some(freeze) = &freeze {
        freeze.check_order(&published, &manifest)?;
    }
    let sealed = read(&corpus.join("answers.age"))?;
    if sha256(&sealed) != published.sealed_sha256 {
        return Err(Refusal::Corpus("answers.age".to_owned()));
    }
    let key_text = read(key)?;
    let release = Release { released_unix_s: now_unix_s, manifest_sha256: sha256(&manifest_bytes), corpus_sha256 };
    let records = [release_path(key), corpus.join("opened.json")];
    for record in &records {
        if !record.exists() {
            continue;
        }
        let before: Release = read_json(record)?;
        let same_manifest = before.manifest_sha256 == release.manifest_sha256;
        if before.corpus_sha256 != release.corpus_sha256 || same_manifest {
            continue;
        }
        let reports_unix_s = manifest.span_unix_s.1.max(newest);
        if reports_unix_s > before.released_unix_s {
            return Err(Refusal::ReportsNewer { reports_unix_s, released_unix_s: before.released_unix_s });
        }
        return Err(Refusal::OpenedBefore);
    }
    if manifest.span_unix_s.1 > now_unix_s {
        return Err(Refusal::ReportsNewer { reports_unix_s: manifest.span_unix_s.1, released_unix_s: now_unix_s });
    }
    // the release is on record before anything is opened
    for record in &records {
        if !record.exists() {
            write_json(record, &release)?;
        }
    }
    let plain = seal::open(&sealed, &String::from_utf8_lossy(&key_text))?;
    if sha256(&plain) != published.answers_sha256 {
        return Err(Refusal::Corpus("the answers inside answers.age".to_owned()));
    }
    let answers: Answers =
        serde_json::from_slice(&plain).map_err(|why| Refusal::file(&corpus.join("answers.age"), why))?;
    if let (Some(freeze), Some(sha256)) = (&freeze, &published.freeze_sha256) {
        freeze.check_seed(sha256, &answers)?;
    }
    Ok((answers, manifest))
}

/// The answers of a development set, whose reports may be made again and again.
///
/// # Errors
/// A file is missing or not the one that was published, or the manifest belongs to another corpus.
pub fn development_answers(corpus: &Path, reports: &Path) -> Result<(Answers, Manifest), Refusal> {
    let published_path = corpus.join("corpus.json");
    let published: Published = read_json(&published_path)?;
    let manifest: Manifest = read_json(&reports.join("manifest.json"))?;
    if manifest.corpus_sha256 != sha256(&read(&published_path)?) {
        return Err(Refusal::OtherCorpus);
    }
    check_reports(&published, &manifest, reports)?;
    let path = corpus.join("answers.json");
    let plain = read(&path)?;
    if sha256(&plain) != published.answers_sha256 {
        return Err(Refusal::Corpus("answers.json".to_owned()));
    }
    let answers = serde_json::from_slice(&plain).map_err(|why| Refusal::file(&path, why))?;
    Ok((answers, manifest))
}

/// Every log has one entry, every entry its report; gives the newest report's time.
fn check_reports(published: &Published, manifest: &Manifest, reports: &Path) -> Result<u64, Refusal> {
    let mut logs: Vec<&str> = published.files.keys().filter_map(|name| name.strip_suffix(".csv")).collect();
    for entry in &manifest.reports {
        let Some(place) = logs.iter().position(|log| *log == entry.log) else {
            return Err(Refusal::ReportCount(entry.log.clone()));
        };
        logs.swap_remove(place);
    }
    if let Some(missing) = logs.first() {
        return Err(Refusal::ReportCount((*missing).to_owned()));
    }
    let mut newest = 0;
    for entry in &manifest.reports {
        let path = reports.join(&entry.log).join("gap.json");
        match &entry.sha256 {
            Some(hash) => {
                if sha256(&read(&path)?) != *hash {
                    return Err(Refusal::ReportChanged(entry.log.clone()));
                }
                newest = newest.max(modified_unix_s(&path));
            }
            None if path.exists() => return Err(Refusal::ReportChanged(entry.log.clone())),
            None => {}
        }
    }
    Ok(newest)
}

/// The answers of an opened corpus with the reports that the manifest holds.
///
/// A report that does not have its form counts as a failed diagnosis.
///
/// # Errors
/// A report cannot be read.
pub fn judged(answers: Answers, manifest: &Manifest, reports: &Path) -> Result<Vec<crate::score::Judged>, Refusal> {
    let mut all = Vec::with_capacity(answers.answers.len());
    for answer in answers.answers {
        let entry = manifest
            .reports
            .iter()
            .find(|entry| entry.log == answer.log)
            .ok_or_else(|| Refusal::ReportCount(answer.log.clone()))?;
        let report = match entry.sha256 {
            None => None,
            Some(_) => crate::score::report::Report::parse(&read(&reports.join(&entry.log).join("gap.json"))?).ok(),
        };
        all.push(crate::score::judge::judge(answer, report, entry.seconds));
    }
    Ok(all)
}
