//! The record of a diagnosis from before the seed of its corpus: which program, from which commit, with which
//! calibration.
//!
//! ```text
//! seed = SHA-256("gimbal blind seed", SHA-256 of the record, nonce)
//! ```
//!
//! The nonce is drawn when the corpus is made and sealed with the answers. Whoever opens them can check that the
//! seed did not exist before the record did.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::draw::Seed;
use crate::folder::{Answers, Manifest, Published, Refusal, read, read_json};
use crate::seal::{hexadecimal, sha256, sha256_bytes};

/// Name of the form.
pub const FREEZE_SCHEMA: &str = "gimbal-blind-freeze/1";

/// What will diagnose.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Freeze {
    /// [`FREEZE_SCHEMA`].
    pub schema: String,
    /// SHA-256 of the program.
    pub program_sha256: String,
    /// Commit that it was built from.
    pub commit: String,
    /// SHA-256 of each file of calibration that is not part of the program, by path.
    #[serde(default)]
    pub calibration: BTreeMap<String, String>,
    /// When it was recorded [s since 1970].
    pub frozen_unix_s: u64,
}

/// The seed that belongs to a record and a nonce.
#[must_use]
pub fn seed(freeze_sha256: &str, nonce: &str) -> Seed {
    sha256_bytes(format!("gimbal blind seed\n{freeze_sha256}\n{nonce}\n").as_bytes())
}

/// The record that lies in a corpus, if it was made after one.
///
/// # Errors
/// The record is not the one that was published.
pub fn of_corpus(corpus: &Path, published: &Published) -> Result<Option<Freeze>, Refusal> {
    let Some(expected) = &published.freeze_sha256 else { return Ok(None) };
    let path = corpus.join("freeze.json");
    if sha256(&read(&path)?) != *expected {
        return Err(Refusal::Corpus("freeze.json".to_owned()));
    }
    read_json(&path).map(Some)
}

impl Freeze {
    /// Holds program and calibration against the record.
    ///
    /// # Errors
    /// One of them is another one.
    pub fn check_program(&self, program_sha256: &str) -> Result<(), Refusal> {
        if self.program_sha256 != program_sha256 {
            return Err(Refusal::OtherProgram {
                recorded: self.program_sha256.clone(),
                found: program_sha256.to_owned(),
            });
        }
        for (path, expected) in &self.calibration {
            let found = sha256(&read(Path::new(path))?);
            if found != *expected {
                return Err(Refusal::OtherProgram { recorded: format!("{path} {expected}"), found });
            }
        }
        Ok(())
    }

    /// Holds the order of acts: record, corpus, diagnosis.
    ///
    /// # Errors
    /// The first act out of order.
    pub fn check_order(&self, published: &Published, manifest: &Manifest) -> Result<(), Refusal> {
        if manifest.program_sha256 != self.program_sha256 {
            return Err(Refusal::OtherProgram {
                recorded: self.program_sha256.clone(),
                found: manifest.program_sha256.clone(),
            });
        }
        let order = [
            ("the record of the diagnosis", self.frozen_unix_s),
            ("the corpus", published.made_unix_s),
            ("the first report", manifest.span_unix_s.0),
        ];
        match order.windows(2).find(|pair| pair[0].1 > pair[1].1) {
            Some(pair) => Err(Refusal::Order { later: pair[0].0, earlier: pair[1].0 }),
            None => Ok(()),
        }
    }

    /// Whether the seed was drawn after this record.
    ///
    /// # Errors
    /// It was not.
    pub fn check_seed(&self, freeze_sha256: &str, answers: &Answers) -> Result<(), Refusal> {
        let nonce = answers.nonce.as_deref().unwrap_or_default();
        if nonce.is_empty() || hexadecimal(&seed(freeze_sha256, nonce)) != answers.seed {
            return Err(Refusal::Seed);
        }
        Ok(())
    }
}
