//! Why answers are not opened.

use std::path::{Path, PathBuf};

use crate::seal;

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
    /// A file that cannot be read or written.
    #[must_use]
    pub fn file(path: &Path, why: impl std::fmt::Display) -> Self {
        Self::File { path: path.to_owned(), why: why.to_string() }
    }
}
