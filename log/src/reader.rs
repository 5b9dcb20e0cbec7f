//! Row by row through a log, in constant memory and without allocating for a row.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::batch::{Batch, Texts};
use crate::error::{LogError, Problem};
use crate::records::{Record, Records};
use crate::time::TimeWatch;
use crate::{Column, Layout, Needs, Row, TimeReport, header, row};

/// Reads a log from its header to its last row.
#[derive(Debug)]
pub struct Reader<R> {
    file: PathBuf,
    records: Records<R>,
    layout: Layout,
    remarks: Vec<String>,
    row: Row,
    time: TimeWatch,
    missing: [u64; Column::COUNT],
    blank_line: Option<u64>,
}

impl Reader<File> {
    /// Opens a log and reads its header.
    ///
    /// # Errors
    /// The file cannot be read, or the header lacks what is needed.
    pub fn open(path: &Path, needs: Needs) -> Result<Self, LogError> {
        let file = File::open(path).map_err(|error| LogError::file(path, error.into()))?;
        Self::new(file, path, needs)
    }
}

impl<R: Read> Reader<R> {
    /// Reads the header of a log; `file` is its name in messages.
    ///
    /// # Errors
    /// The source cannot be read, or the header lacks what is needed.
    pub fn new(source: R, file: impl Into<PathBuf>, needs: Needs) -> Result<Self, LogError> {
        let mut remarks = Vec::new();
        let mut reader = Self::with_layout(source, file, |file, names| {
            let (layout, found) = header::contract(file, names, needs)?;
            remarks = found;
            Ok(layout)
        })?;
        reader.remarks = remarks;
        Ok(reader)
    }

    /// Reads the header of any CSV file, and lets `layout` say what its columns are.
    ///
    /// # Errors
    /// The source cannot be read, the header is not one, or what `layout` says.
    pub fn with_layout(
        source: R,
        file: impl Into<PathBuf>,
        layout: impl FnOnce(&Path, Vec<String>) -> Result<Layout, LogError>,
    ) -> Result<Self, LogError> {
        let file = file.into();
        let mut records = Records::new(source);
        let first = records.next_record().map_err(|error| LogError::file(&file, error.into()))?;
        let Some((_, record)) = first else { return Err(LogError::file(&file, Problem::Empty)) };
        let layout = layout(&file, header::names(&file, &record)?)?;
        let row = Row::MISSING;
        let (time, missing) = (TimeWatch::new(), [0; Column::COUNT]);
        Ok(Self { file, records, layout, remarks: Vec::new(), row, time, missing, blank_line: None })
    }

    /// Which column of the file is which.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// What the header gave cause to remark.
    #[must_use]
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// The file as it is named in messages.
    #[must_use]
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// What the time stamps read so far are like.
    #[must_use]
    pub fn time(&self) -> TimeReport {
        self.time.report()
    }

    /// Missing samples so far, of a column that is there.
    #[must_use]
    pub fn missing(&self, column: Column) -> u64 {
        self.missing[column.index()]
    }

    /// The next row, or `None` after the last.
    ///
    /// # Errors
    /// A row that cannot be read, with its line and column; a file without rows.
    pub fn next_row(&mut self) -> Result<Option<Row>, LogError> {
        self.advance(None).map(|line| line.map(|_| self.row))
    }

    /// Fills the batch from the rows that follow; it is empty after the last.
    ///
    /// # Errors
    /// As [`Self::next_row`].
    pub fn next_batch(&mut self, batch: &mut Batch) -> Result<(), LogError> {
        batch.clear();
        while batch.rows.len() < batch.most_rows {
            let texts = batch.keeps_extras.then_some(&mut batch.extras);
            let Some(line) = self.advance(texts)? else { break };
            batch.rows.push(self.row);
            batch.lines.push(line);
        }
        Ok(())
    }

    /// Reads a row into `self.row`, and returns its line.
    fn advance(&mut self, extras: Option<&mut Texts>) -> Result<Option<u64>, LogError> {
        loop {
            let next = self.records.next_record().map_err(|error| LogError::file(&self.file, error.into()))?;
            let Some((line, record)) = next else {
                if self.time.rows() == 0 {
                    return Err(LogError::file(&self.file, Problem::HeaderOnly));
                }
                return Ok(None);
            };
            if let (Some(blank), false) = (self.blank_line, matches!(record, Record::Blank)) {
                return Err(LogError::line(&self.file, blank, Problem::EmptyLine));
            }
            let read = match record {
                Record::Blank => {
                    // Nothing wrong with it behind the last row.
                    self.blank_line = self.blank_line.or(Some(line));
                    continue;
                }
                Record::Open => return Err(LogError::line(&self.file, line, Problem::OpenQuote)),
                Record::Plain(bytes) => row::plain(bytes, &self.layout, &mut self.row, &mut self.missing, extras),
                Record::Quoted(cells) => row::quoted(cells, &self.layout, &mut self.row, &mut self.missing, extras),
            };
            let time_s = self.row[Column::Time];
            let timed = read
                .and_then(|()| self.time.push(time_s).map_err(|problem| (self.layout.position(Column::Time), problem)));
            return match timed {
                Ok(()) => Ok(Some(line)),
                Err((None, problem)) => Err(LogError::line(&self.file, line, problem)),
                Err((Some(index), problem)) => {
                    Err(LogError::cell(&self.file, line, index, &self.layout.names()[index], problem))
                }
            };
        }
    }
}
