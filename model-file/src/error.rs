//! What can be wrong with a model file: one line, with the place and what would be right.

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

/// Why a model file cannot be used.
#[derive(Debug, Error)]
pub struct ModelFileError {
    /// File as it was named by the caller.
    pub file: PathBuf,
    /// Line and column, counted from 1, where there is a place.
    pub place: Option<(usize, usize)>,
    /// What is wrong there.
    #[source]
    pub problem: Box<Problem>,
}

impl fmt::Display for ModelFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.file.display())?;
        if let Some((line, column)) = self.place {
            write!(f, "line {line}, column {column}: ")?;
        }
        self.problem.fmt(f)
    }
}

/// What is wrong.
#[derive(Debug, Error)]
pub enum Problem {
    /// The file cannot be opened or read.
    #[error("cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// Bytes that are not UTF-8.
    #[error("not UTF-8; save the file as UTF-8")]
    NotUtf8,
    /// Not TOML.
    #[error("not TOML: {0}")]
    Syntax(String),
    /// A preset that does not exist.
    #[error("`{0}` is not a preset; write \"consistent\" or \"as-printed\"")]
    Preset(String),
    /// A table that does not exist.
    #[error("[{name}] is not a table of a model file; the nearest known one is [{nearest}]")]
    UnknownTable {
        /// Its name.
        name: String,
        /// The known name that is nearest.
        nearest: String,
    },
    /// The model of a plain axis where that of a platform is needed.
    #[error(
        "[axis] makes this the model of a plain axis, which `gimbal gap` alone reads; give the model of a platform here"
    )]
    PlainAxis,
    /// A key outside of every table.
    #[error("`{name}` stands outside of every table; {hint}")]
    Homeless {
        /// Its name.
        name: String,
        /// Where it belongs.
        hint: String,
    },
    /// A key that does not exist.
    #[error("`{name}` is not a key of [{table}]; the nearest known one is `{nearest}`")]
    UnknownKey {
        /// The table.
        table: String,
        /// Its name.
        name: String,
        /// The known name that is nearest.
        nearest: String,
    },
    /// A value of another type.
    #[error("`{name}` is {found}; write {expected}")]
    WrongType {
        /// Table and key.
        name: String,
        /// What stands there.
        found: String,
        /// What would be right.
        expected: String,
    },
    /// A value that the law cannot be built from.
    #[error("{0}")]
    Impossible(String),
}
