//! CSV out: the shortest numbers that read back to the same bits, empty cells for missing samples.

use std::io::{self, Write};

/// Bytes gathered before they are handed on.
const BLOCK_BYTES: usize = 1 << 16;

/// Writes a header and rows, cell by cell.
#[derive(Debug)]
pub struct TableWriter<W: Write> {
    sink: W,
    line: Vec<u8>,
    at_start: bool,
}

impl<W: Write> TableWriter<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// The sink does not take it.
    pub fn new<'a>(sink: W, names: impl IntoIterator<Item = &'a str>) -> io::Result<Self> {
        let mut writer = Self { sink, line: Vec::with_capacity(BLOCK_BYTES + 1024), at_start: true };
        for name in names {
            writer.text(name);
        }
        writer.end_row()?;
        Ok(writer)
    }

    /// A number; NaN is an empty cell. Infinities are written as text, for a reader to refuse.
    pub fn number(&mut self, value: f64) {
        self.separate();
        if value.is_nan() {
            return;
        }
        let mut buffer = ryu::Buffer::new();
        let text = buffer.format(value);
        self.line.extend_from_slice(text.strip_suffix(".0").unwrap_or(text).as_bytes());
    }

    /// A text, quoted where it must be.
    pub fn text(&mut self, text: &str) {
        self.separate();
        if text.contains(['"', ',', '\n', '\r']) {
            self.line.push(b'"');
            self.line.extend_from_slice(text.replace('"', "\"\"").as_bytes());
            self.line.push(b'"');
        } else {
            self.line.extend_from_slice(text.as_bytes());
        }
    }

    /// Ends the row.
    ///
    /// # Errors
    /// The sink does not take it.
    pub fn end_row(&mut self) -> io::Result<()> {
        self.line.push(b'\n');
        self.at_start = true;
        if self.line.len() >= BLOCK_BYTES { self.hand_on() } else { Ok(()) }
    }

    /// Hands on what is gathered and gives the sink back.
    ///
    /// # Errors
    /// The sink does not take it.
    pub fn finish(mut self) -> io::Result<W> {
        self.hand_on()?;
        self.sink.flush()?;
        Ok(self.sink)
    }

    fn hand_on(&mut self) -> io::Result<()> {
        self.sink.write_all(&self.line)?;
        self.line.clear();
        Ok(())
    }

    fn separate(&mut self) {
        if !self.at_start {
            self.line.push(b',');
        }
        self.at_start = false;
    }
}

#[cfg(test)]
mod tests {
    use super::TableWriter;

    #[test]
    fn closed_form_numbers_read_back_to_the_same_bits() {
        let mut writer = TableWriter::new(Vec::new(), ["a", "b,c"]).expect("memory");
        let values = [0.1, -0.0, 1e-300, 1.0 / 3.0, 123_456_789.0, f64::MAX, f64::MIN_POSITIVE / 3.0];
        for value in values {
            writer.number(value);
            writer.text("say \"so\"");
            writer.end_row().expect("memory");
        }
        writer.number(f64::NAN);
        writer.number(1.0);
        writer.end_row().expect("memory");
        let text = String::from_utf8(writer.finish().expect("memory")).expect("UTF-8");
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("a,\"b,c\""));
        for (value, line) in values.into_iter().zip(lines.by_ref()) {
            let (number, rest) = line.split_once(',').expect("two cells");
            assert_eq!(number.parse::<f64>().expect("a number").to_bits(), value.to_bits());
            assert_eq!(rest, "\"say \"\"so\"\"\"");
        }
        assert!(text.ends_with("\n,1\n"));
    }
}
