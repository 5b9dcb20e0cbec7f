//! A log in memory, column by column.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use crate::batch::{Batch, Texts};
use crate::{Column, LogError, Needs, Reader, Row, TableWriter, TimeReport};

/// A whole log.
#[derive(Debug, Clone, Default)]
pub struct Log {
    columns: [Option<Vec<f64>>; Column::COUNT],
    extras: Vec<Extra>,
    /// What the time stamps are like.
    pub time: TimeReport,
    /// What the header gave cause to remark.
    pub remarks: Vec<String>,
}

/// A column that no contract claims, as text.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Extra {
    /// Name in the header.
    pub name: String,
    pub(crate) cells: Texts,
}

impl Extra {
    /// The cell of a row.
    #[must_use]
    pub fn cell(&self, row: usize) -> &str {
        self.cells.get(row)
    }

    /// The cells as numbers, NaN where a cell is empty; none where some cell is text, or all are empty.
    #[must_use]
    pub fn all_numbers(&self) -> Option<Vec<f64>> {
        let numbers = self.numbers();
        let text = |row: usize| numbers[row].is_nan() && !self.cell(row).trim().is_empty();
        let there = numbers.iter().any(|number| !number.is_nan());
        (there && !(0..numbers.len()).any(text)).then_some(numbers)
    }

    /// The cells as numbers; NaN where they are none.
    #[must_use]
    pub fn numbers(&self) -> Vec<f64> {
        (0..self.cells.len())
            .map(|row| match crate::cell::whole(self.cells.get(row).as_bytes()) {
                crate::cell::Cell::Number(value) => value,
                _ => f64::NAN,
            })
            .collect()
    }
}

impl Log {
    /// Reads a log.
    ///
    /// # Errors
    /// As [`Reader::open`] and [`Reader::next_row`].
    pub fn open(path: &Path, needs: Needs) -> Result<Self, LogError> {
        Self::read(Reader::<File>::open(path, needs)?)
    }

    /// Reads a log from memory or any other source; `file` is its name in messages.
    ///
    /// # Errors
    /// As [`Reader::new`] and [`Reader::next_row`].
    pub fn from_source(source: impl Read, file: impl Into<PathBuf>, needs: Needs) -> Result<Self, LogError> {
        Self::read(Reader::new(source, file, needs)?)
    }

    /// Reads what is left of a reader.
    ///
    /// # Errors
    /// As [`Reader::next_row`].
    pub fn read<R: Read>(mut reader: Reader<R>) -> Result<Self, LogError> {
        let mut log = Self { remarks: reader.remarks().to_vec(), ..Self::default() };
        for column in reader.layout().roles().iter().flatten() {
            log.columns[column.index()] = Some(Vec::new());
        }
        log.extras =
            reader.layout().extra_names().map(|name| Extra { name: name.to_owned(), ..Extra::default() }).collect();
        let mut batch = Batch::new(1024, true);
        loop {
            reader.next_batch(&mut batch)?;
            if batch.rows().is_empty() {
                break;
            }
            for (index, row) in batch.rows().iter().enumerate() {
                for column in Column::ALL {
                    if let Some(values) = &mut log.columns[column.index()] {
                        values.push(row[column]);
                    }
                }
                for (extra, cell) in log.extras.iter_mut().zip(batch.extras(index)) {
                    extra.cells.push(cell.as_bytes());
                }
            }
        }
        log.time = reader.time();
        Ok(log)
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.iter().flatten().map(Vec::len).next().unwrap_or(0)
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A column, if the log has it; missing samples are NaN.
    #[must_use]
    pub fn column(&self, column: Column) -> Option<&[f64]> {
        self.columns[column.index()].as_deref()
    }

    /// Sets a column; all must have one length.
    pub fn set(&mut self, column: Column, values: Vec<f64>) {
        self.columns[column.index()] = Some(values);
    }

    /// The columns without a meaning.
    #[must_use]
    pub fn extras(&self) -> &[Extra] {
        &self.extras
    }

    /// Adds a column without a meaning; NaN is an empty cell.
    pub(crate) fn push_extra(&mut self, name: &str, values: &[f64]) {
        let mut extra = Extra { name: name.to_owned(), ..Extra::default() };
        for value in values {
            let cell = if value.is_nan() { String::new() } else { value.to_string() };
            extra.cells.push(cell.as_bytes());
        }
        self.extras.push(extra);
    }

    /// One row.
    #[must_use]
    pub fn row(&self, index: usize) -> Row {
        let mut row = Row::MISSING;
        for column in Column::ALL {
            if let Some(values) = self.column(column) {
                row[column] = values[index];
            }
        }
        row
    }

    /// Writes the log as CSV.
    ///
    /// # Errors
    /// The sink does not take it.
    pub fn write(&self, sink: impl Write) -> io::Result<()> {
        let mut names: Vec<&str> = self.extras.iter().map(|extra| extra.name.as_str()).collect();
        let there = Column::ALL.into_iter().filter(|column| self.column(*column).is_some());
        names.splice(0..0, there.map(|column| -> &str { column.name() }));
        let mut writer = TableWriter::new(sink, names)?;
        for index in 0..self.len() {
            for values in self.columns.iter().flatten() {
                writer.number(values[index]);
            }
            for extra in &self.extras {
                writer.text(extra.cell(index));
            }
            writer.end_row()?;
        }
        writer.finish().map(|_| ())
    }
}
