//! Rows in portions, so that reading and stepping can go on in different threads.

use crate::Row;

/// Some consecutive rows, with the cells that no column of the contract claims.
#[derive(Debug, Clone)]
pub struct Batch {
    pub(crate) rows: Vec<Row>,
    pub(crate) lines: Vec<u64>,
    pub(crate) extras: Texts,
    pub(crate) most_rows: usize,
    pub(crate) keeps_extras: bool,
}

impl Batch {
    /// An empty batch of at most `most_rows`; extra cells are kept on demand.
    #[must_use]
    pub fn new(most_rows: usize, keeps_extras: bool) -> Self {
        Self {
            rows: Vec::with_capacity(most_rows),
            lines: Vec::with_capacity(most_rows),
            extras: Texts::default(),
            most_rows,
            keeps_extras,
        }
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Line of each row in the file.
    #[must_use]
    pub fn lines(&self) -> &[u64] {
        &self.lines
    }

    /// The extra cells of a row in the order of the header; none when they are not kept.
    pub fn extras(&self, row: usize) -> impl Iterator<Item = &str> {
        let each = self.extras.len().checked_div(self.rows.len()).unwrap_or(0);
        (row * each..(row + 1) * each).map(|index| self.extras.get(index))
    }

    pub(crate) fn clear(&mut self) {
        self.rows.clear();
        self.lines.clear();
        self.extras.clear();
    }
}

/// Texts one behind the other in one piece of memory.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Texts {
    bytes: Vec<u8>,
    ends: Vec<usize>,
}

impl Texts {
    /// Adds a text; the reader has checked that it is UTF-8.
    pub(crate) fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
        self.ends.push(self.bytes.len());
    }

    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(crate) fn get(&self, index: usize) -> &str {
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        std::str::from_utf8(&self.bytes[start..self.ends[index]]).unwrap_or_default()
    }

    fn clear(&mut self) {
        self.bytes.clear();
        self.ends.clear();
    }
}
