//! Making a corpus on disk: logs side by side, answers sealed, everything in place at once.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;

use rayon::prelude::*;

use crate::corpus::{self, Answer, Recipe};
use crate::folder::{Answers, CORPUS_SCHEMA, Published, Refusal, write_json};
use crate::seal::{self, sha256};

/// Who watches the work.
pub struct Watch<'a> {
    /// Called after each log.
    pub done: &'a (dyn Fn() + Sync),
    /// Whether the work shall end.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// Why there is no corpus.
#[derive(Debug, thiserror::Error)]
pub enum ForgeError {
    /// The work was ended.
    #[error("interrupted")]
    Interrupted,
    /// Files or sealing.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// Who may read the answers.
#[derive(Debug, Clone)]
pub enum Access {
    /// Whoever has the key, after the diagnosis; made after the record of the diagnosis with this SHA-256, if any.
    Sealed {
        /// SHA-256 of the record.
        freeze_sha256: Option<String>,
        /// What was mixed with it to give the seed, in hexadecimal digits.
        nonce: Option<String>,
    },
    /// Everybody, for development: answers lie beside the logs, and nothing that is scored here counts.
    Open,
}

/// Makes a corpus in the empty folder `into` and gives what was published and, if it is sealed, the key's text.
///
/// Logs, models and answers before sealing are the same bytes for the same recipe; the seal is not.
///
/// # Errors
/// The work was ended, or a file cannot be written.
pub fn write(
    recipe: &Recipe,
    rocket_sha256: Option<String>,
    access: &Access,
    into: &Path,
    now_unix_s: u64,
    watch: &Watch<'_>,
) -> Result<(Published, Option<String>), ForgeError> {
    let logs = into.join("logs");
    std::fs::create_dir_all(&logs).map_err(|why| Refusal::file(&logs, why))?;
    let kinds = corpus::kinds(recipe);
    let files = Mutex::new(BTreeMap::new());
    let answers: Vec<Answer> = (0..recipe.logs)
        .into_par_iter()
        .map(|index| {
            if (watch.stop)() {
                return Err(ForgeError::Interrupted);
            }
            let case = corpus::make(recipe, kinds[index], index);
            for (ending, text) in [("csv", &case.csv), ("toml", &case.model)] {
                let name = format!("{}.{ending}", case.answer.log);
                let path = logs.join(&name);
                std::fs::write(&path, text).map_err(|why| Refusal::file(&path, why))?;
                if let Ok(mut files) = files.lock() {
                    files.insert(name, sha256(text.as_bytes()));
                }
            }
            if matches!(access, Access::Open) {
                write_json(&logs.join(format!("{}.answer.json", case.answer.log)), &case.answer)?;
            }
            (watch.done)();
            Ok(case.answer)
        })
        .collect::<Result<_, ForgeError>>()?;
    let (freeze_sha256, nonce) = match access {
        Access::Sealed { freeze_sha256, nonce } => (freeze_sha256.clone(), nonce.clone()),
        Access::Open => (None, None),
    };
    let answers = Answers {
        seed: seal::hexadecimal(&recipe.seed),
        nonce,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        rocket_sha256,
        length_s: recipe.length_s,
        shares: recipe.shares,
        multiples: recipe.multiples,
        answers,
    };
    let plain = serde_json::to_vec(&answers).map_err(|why| Refusal::file(into, why))?;
    let mut published = Published {
        schema: CORPUS_SCHEMA.to_owned(),
        made_unix_s: now_unix_s,
        open: matches!(access, Access::Open),
        freeze_sha256,
        answers_sha256: sha256(&plain),
        sealed_sha256: String::new(),
        recipient: String::new(),
        files: files.into_inner().unwrap_or_default(),
    };
    let key = if published.open {
        let path = into.join("answers.json");
        std::fs::write(&path, &plain).map_err(|why| Refusal::file(&path, why))?;
        None
    } else {
        let path = into.join("answers.age");
        let (key, recipient) = seal::fresh_key();
        let sealed = seal::seal(&plain, &recipient).map_err(Refusal::from)?;
        std::fs::write(&path, &sealed).map_err(|why| Refusal::file(&path, why))?;
        published.sealed_sha256 = sha256(&sealed);
        published.recipient = recipient;
        Some(key)
    };
    write_json(&into.join("corpus.json"), &published)?;
    Ok((published, key))
}
