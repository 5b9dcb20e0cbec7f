//! What can be wrong with a log: one line, with the place and what would be right.

use std::fmt;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::Column;

/// Why a log cannot be read.
#[derive(Debug, Error)]
pub struct LogError {
    /// File as it was named by the caller.
    pub file: PathBuf,
    /// Line in the file, the header being line 1.
    pub line: Option<u64>,
    /// Number, counted from 1, and name of the column.
    pub column: Option<(usize, String)>,
    /// What is wrong there.
    #[source]
    pub problem: Box<Problem>,
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.file.display())?;
        match (self.line, &self.column) {
            (Some(line), Some((number, name))) => write!(f, "line {line}, column {number} ({name}): ")?,
            (Some(line), None) => write!(f, "line {line}: ")?,
            (None, Some((number, name))) => write!(f, "column {number} ({name}): ")?,
            (None, None) => {}
        }
        self.problem.fmt(f)
    }
}

impl LogError {
    /// A problem of the file as a whole.
    pub(crate) fn file(file: &Path, problem: Problem) -> Self {
        Self { file: file.to_owned(), line: None, column: None, problem: Box::new(problem) }
    }

    /// A problem of one line.
    pub(crate) fn line(file: &Path, line: u64, problem: Problem) -> Self {
        Self { file: file.to_owned(), line: Some(line), column: None, problem: Box::new(problem) }
    }

    /// A problem of one cell.
    pub(crate) fn cell(file: &Path, line: u64, index: usize, name: &str, problem: Problem) -> Self {
        let column = Some((index + 1, clip(name.as_bytes())));
        Self { file: file.to_owned(), line: Some(line), column, problem: Box::new(problem) }
    }

    /// A file that cannot be opened.
    #[must_use]
    pub fn unreadable(file: &Path, error: std::io::Error) -> Self {
        Self::file(file, Problem::Io(error))
    }

    /// A driving column whose first sample is missing.
    #[must_use]
    pub fn starts_missing(file: &Path, line: u64, column: Column) -> Self {
        Self::line(file, line, Problem::StartsMissing { name: column.name() })
    }

    /// A gap that is too long to be crossed.
    #[must_use]
    pub fn gap(file: &Path, line: u64, from_s: f64, to_s: f64) -> Self {
        Self::line(file, line, Problem::Gap { from_s, to_s })
    }

    /// Whether the file system failed, rather than the contents being wrong.
    #[must_use]
    pub fn is_environment(&self) -> bool {
        matches!(&*self.problem, Problem::Io(error) if !matches!(error.kind(),
            std::io::ErrorKind::NotFound | std::io::ErrorKind::PermissionDenied | std::io::ErrorKind::IsADirectory))
    }
}

/// What is wrong.
#[derive(Debug, Error)]
pub enum Problem {
    /// The file cannot be opened or read.
    #[error("cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// No header.
    #[error("the file is empty; a log begins with a header such as `time_s,accel_x_mps2,...`")]
    Empty,
    /// Nothing after the header.
    #[error("there is a header but no row of samples below it")]
    HeaderOnly,
    /// Bytes that are not UTF-8.
    #[error("byte {offset} of the line is not UTF-8; save the file as UTF-8")]
    NotUtf8 {
        /// Offset from the start of the line, counted from 1.
        offset: usize,
    },
    /// UTF-16.
    #[error("the file is UTF-16; save it as UTF-8")]
    Utf16,
    /// Another separator.
    #[error("the header has no comma but has `{found}`; separate the cells by commas")]
    Separator {
        /// The separator found.
        found: char,
    },
    /// A header twice.
    #[error("the name stands twice in the header, first as column {first}; rename one")]
    Duplicate {
        /// Number of the first column of this name, counted from 1.
        first: usize,
    },
    /// A needed column is not there.
    #[error("there is no column `{name}` [{unit}], needed {purpose}; {hint}")]
    MissingColumn {
        /// Its name.
        name: String,
        /// Its unit.
        unit: String,
        /// What it is needed for.
        purpose: &'static str,
        /// What would help.
        hint: String,
    },
    /// The quantity is there in another unit.
    #[error("`{name}` [{unit}] is needed {purpose}, and this column has another unit; convert it: {command}")]
    OtherUnit {
        /// Name of the column that is needed.
        name: String,
        /// Its unit.
        unit: String,
        /// What it is needed for.
        purpose: &'static str,
        /// The command that converts it.
        command: String,
    },
    /// A row of another length than the header.
    #[error("the row has {found} cells and the header {expected}; every row needs one cell for each column")]
    Ragged {
        /// Cells found.
        found: usize,
        /// Columns of the header.
        expected: usize,
    },
    /// An empty line before the last row.
    #[error("the line is empty; remove it, or write the missing row")]
    EmptyLine,
    /// A quote that is not closed.
    #[error("a quoted cell that begins here is not closed; close it with `\"`")]
    OpenQuote,
    /// Text in a cell for a number.
    #[error("`{text}` is not a number; write a number in {unit}{}", or_nothing(unit))]
    NotANumber {
        /// The text.
        text: String,
        /// Unit of the column.
        unit: String,
    },
    /// Infinite, or too large for a double.
    #[error("`{text}` is not finite; write a number in {unit}{}", or_nothing(unit))]
    NotFinite {
        /// The text.
        text: String,
        /// Unit of the column.
        unit: String,
    },
    /// A missing time.
    #[error("the time is missing; every row needs one")]
    NoTime,
    /// Time goes back.
    #[error("time runs backwards, from {from_s} s to {to_s} s; sort the rows by time")]
    Backwards {
        /// Time of the row before.
        from_s: f64,
        /// Time of this row.
        to_s: f64,
    },
    /// No sample to begin with.
    #[error("`{name}` has no sample in the first row; begin the log where it has one")]
    StartsMissing {
        /// The column.
        name: &'static str,
    },
    /// A long gap.
    #[error(
        "no row between {from_s} s and {to_s} s; cut the log there, or cross the gap knowingly with `gimbal convert`"
    )]
    Gap {
        /// Last row before it [s].
        from_s: f64,
        /// First row behind it [s].
        to_s: f64,
    },
    /// A column map that names a column that is not there.
    #[error("there is no column `{name}`; {hint}")]
    NoSource {
        /// Its name.
        name: String,
        /// What would help.
        hint: String,
    },
    /// A column map that cannot be followed.
    #[error("{0}")]
    Map(String),
}

/// Text of a file, safe to print on one line.
pub(crate) fn clip(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let mut clipped: String = text.chars().take(40).flat_map(char::escape_debug).collect();
    if text.chars().nth(40).is_some() {
        clipped.push_str("...");
    }
    clipped
}

/// A sample may be missing, its time may not.
fn or_nothing(unit: &str) -> &'static str {
    if unit == "s" { "" } else { ", or leave the cell empty for a missing sample" }
}
