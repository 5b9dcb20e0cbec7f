//! The rows of a sweep on disk: appended in order, found again after an interruption.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use gimbal_log::AtomicFile;

use super::parquet;
use super::plan::Plan;
use crate::exit::Failure;

/// Rows so far, in a file beside the result.
pub(super) struct Record {
    file: File,
    partial: PathBuf,
    out: PathBuf,
    header: String,
    rows: u64,
}

impl Record {
    /// Starts, or goes on with what an interrupted sweep of the same plan has left.
    pub(super) fn open(out: &Path, plan: &Plan) -> Result<Self, Failure> {
        let ends = |end: &str| out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(end));
        let name = out.file_name().filter(|_| ends("csv") || ends("parquet"));
        let name = name
            .ok_or_else(|| Failure::input(format!("{}: give a name that ends in .csv or .parquet", out.display())))?;
        let partial = out.with_file_name(format!("{}.{:016x}.partial", name.to_string_lossy(), plan.fingerprint()));
        let open = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&partial);
        let file = open.map_err(Failure::write(&partial))?;
        let mut record = Self { file, partial, out: out.to_owned(), header: plan.header(), rows: 0 };
        let kept = record.whole_rows(plan)?;
        record.cut(kept)?;
        if kept == 0 {
            record.append(&[format!("{}\n", plan.header())])?;
        }
        Ok(record)
    }

    /// Length of the header and the rows that were written whole; counts them.
    fn whole_rows(&mut self, plan: &Plan) -> Result<u64, Failure> {
        let fail = |error: std::io::Error| Failure::Environment(error.into());
        let mut reader = BufReader::new(&self.file);
        let (mut line, mut length, mut rows) = (String::new(), 0, 0);
        loop {
            line.clear();
            // A torn row, whatever its bytes, is done again.
            let Ok(bytes) = reader.read_line(&mut line) else { break };
            let expected = if length == 0 { plan.header() } else { format!("{rows},") };
            if bytes == 0 || !line.ends_with('\n') || !line.starts_with(&expected) || rows > plan.runs() {
                break;
            }
            rows += u64::from(length > 0);
            length += bytes as u64;
        }
        self.rows = rows;
        self.file.seek(SeekFrom::Start(0)).map_err(fail)?;
        Ok(length)
    }

    fn cut(&mut self, length: u64) -> Result<(), Failure> {
        let fail = |error: std::io::Error| Failure::Environment(error.into());
        self.file.set_len(length).map_err(fail)?;
        self.file.seek(SeekFrom::Start(length)).map(|_| ()).map_err(fail)
    }

    /// Appends rows.
    pub(super) fn append(&mut self, rows: &[String]) -> Result<(), Failure> {
        self.file.write_all(rows.concat().as_bytes()).map_err(Failure::write(&self.partial))
    }

    /// The rows that were there already, from the first.
    pub(super) fn kept(&self) -> Result<impl Iterator<Item = std::io::Result<String>>, Failure> {
        Ok(self.all()?.take(usize::try_from(self.rows).unwrap_or(usize::MAX)))
    }

    fn all(&self) -> Result<impl Iterator<Item = std::io::Result<String>>, Failure> {
        let file = File::open(&self.partial).map_err(Failure::write(&self.partial))?;
        Ok(BufReader::new(file).lines().skip(1))
    }

    /// Gives the file its name; a Parquet file is made of the rows first.
    pub(super) fn commit(self) -> Result<PathBuf, Failure> {
        let fail = || Failure::write(&self.out);
        self.file.sync_all().map_err(fail())?;
        if self.out.extension().is_some_and(|end| end.eq_ignore_ascii_case("parquet")) {
            let mut file = AtomicFile::create(&self.out).map_err(fail())?;
            let wrong = |error: ::parquet::errors::ParquetError| fail()(std::io::Error::other(error));
            parquet::write(&self.header, self.all()?, &mut file).map_err(wrong)?;
            file.commit().map_err(fail())?;
            std::fs::remove_file(&self.partial).map_err(fail())?;
        } else {
            std::fs::rename(&self.partial, &self.out).map_err(fail())?;
        }
        Ok(self.out)
    }
}
