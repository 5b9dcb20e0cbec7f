//! Lines of a file as records of cells, in constant memory.
//!
//! A record without quotes is handed out as the slice of the read buffer that it is. One with quotes goes through
//! the `csv` crate, which knows the rules.

use std::io::{self, Read};

/// Read at once.
const BLOCK_BYTES: usize = 1 << 18;

/// One record.
#[derive(Debug)]
pub(crate) enum Record<'a> {
    /// Cells between commas, no quotes anywhere.
    Plain(&'a [u8]),
    /// Cells that were taken out of their quotes.
    Quoted(&'a csv::ByteRecord),
    /// Nothing on the line.
    Blank,
    /// A quote is open at the end of the file.
    Open,
}

/// Splits what is read into records.
#[derive(Debug)]
pub(crate) struct Records<R> {
    source: R,
    buffer: Vec<u8>,
    /// Bytes handed out so far, and bytes read, within the buffer.
    begin: usize,
    end: usize,
    /// Line on which the next record begins, counted from 1.
    next_line: u64,
    quoted: csv::ByteRecord,
    at_end: bool,
}

impl<R: Read> Records<R> {
    pub(crate) fn new(source: R) -> Self {
        Self {
            source,
            buffer: vec![0; BLOCK_BYTES],
            begin: 0,
            end: 0,
            next_line: 1,
            quoted: csv::ByteRecord::new(),
            at_end: false,
        }
    }

    /// The next record with the line on which it begins, counted from 1, or `None` at the end.
    pub(crate) fn next_record(&mut self) -> io::Result<Option<(u64, Record<'_>)>> {
        let line = self.next_line;
        let mut looked = 0;
        let mut quotes = 0_usize;
        let (length, ended) = loop {
            let unread = &self.buffer[self.begin + looked..self.end];
            let Some(offset) = memchr::memchr2(b'\n', b'"', unread) else {
                looked = self.end - self.begin;
                if self.at_end {
                    break (looked, false);
                }
                self.fill()?;
                continue;
            };
            let quote = unread[offset] == b'"';
            looked += offset + 1;
            if quote {
                quotes += 1;
            } else {
                self.next_line += 1;
                // Within quotes a line end belongs to the cell.
                if quotes.is_multiple_of(2) {
                    break (looked - 1, true);
                }
            }
        };
        let start = self.begin;
        self.begin += length + usize::from(ended);
        if length == 0 && !ended {
            return Ok(None);
        }
        let record = &self.buffer[start..start + length];
        let record = record.strip_suffix(b"\r").unwrap_or(record);
        if quotes == 0 {
            return Ok(Some((line, if record.is_empty() { Record::Blank } else { Record::Plain(record) })));
        }
        if !quotes.is_multiple_of(2) {
            return Ok(Some((line, Record::Open)));
        }
        let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(record);
        reader.read_byte_record(&mut self.quoted).map_err(io::Error::other)?;
        Ok(Some((line, Record::Quoted(&self.quoted))))
    }

    /// Reads another block behind the bytes not yet handed out.
    fn fill(&mut self) -> io::Result<()> {
        self.buffer.copy_within(self.begin..self.end, 0);
        self.end -= self.begin;
        self.begin = 0;
        if self.end == self.buffer.len() {
            // One record longer than the buffer.
            self.buffer.resize(2 * self.buffer.len(), 0);
        }
        let read = loop {
            match self.source.read(&mut self.buffer[self.end..]) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                result => break result?,
            }
        };
        self.at_end = read == 0;
        self.end += read;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::{Record, Records};

    /// Gives one byte at a time.
    struct Trickle<'a>(&'a [u8]);

    impl Read for Trickle<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let Some((first, rest)) = self.0.split_first() else { return Ok(0) };
            buffer[0] = *first;
            self.0 = rest;
            Ok(1)
        }
    }

    fn cells(text: &str) -> Vec<(u64, Vec<String>)> {
        let mut records = Records::new(Trickle(text.as_bytes()));
        let mut all = Vec::new();
        loop {
            let Some((line, record)) = records.next_record().expect("memory reads") else { return all };
            let row = match record {
                Record::Plain(bytes) => {
                    bytes.split(|&b| b == b',').map(|cell| String::from_utf8_lossy(cell).into_owned()).collect()
                }
                Record::Quoted(record) => {
                    record.iter().map(|cell| String::from_utf8_lossy(cell).into_owned()).collect()
                }
                Record::Blank => vec!["(blank)".to_owned()],
                Record::Open => vec!["(open)".to_owned()],
            };
            all.push((line, row));
        }
    }

    #[test]
    fn cross_records_are_those_of_the_csv_crate() {
        let text = "a,b,c\r\n1,2,3\n\"x,\ny\",\"say \"\"so\"\"\",\n4,5,6";
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
        let expected: Vec<Vec<String>> =
            reader.records().map(|record| record.expect("csv").iter().map(str::to_owned).collect()).collect();
        let found = cells(text);
        assert_eq!(found.iter().map(|(_, row)| row.clone()).collect::<Vec<_>>(), expected);
        assert_eq!(found.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [1, 2, 3, 5]);
    }

    #[test]
    fn contract_blank_lines_and_open_quotes_are_told() {
        assert_eq!(cells("a\n\nb\n")[1], (2, vec!["(blank)".to_owned()]));
        assert_eq!(cells("a\n\"b\nc\n")[1], (2, vec!["(open)".to_owned()]));
        assert_eq!(cells(""), []);
    }
}
