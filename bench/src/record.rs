//! Records of a run: everything both ways and the truth beside it, in a file that is valid wherever it ends.
//!
//! ```text
//! GIMBALREC1\n  then entries:  kind 1, tick 4, length 4, content, CRC-32 of all that 4      (little-endian)
//! ```
//!
//! | kind | content |
//! |---|---|
//! | `H` | JSON: scenario, its text, versions, digests |
//! | `D` | bytes as they left for the computer |
//! | `U` | bytes as they came from it |
//! | `T` | nine doubles: specific force x, y, z, rate, phi, theta, motor torque, velocity error x, y |
//! | `E` | JSON: the verdict; the record is complete |

use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use crc::{CRC_32_ISO_HDLC, Crc};

const MAGIC: &[u8; 11] = b"GIMBALREC1\n";
const CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
/// Longest entry that is read: a damaged length must not ask for all memory.
const LONGEST: u32 = 1 << 24;

/// A record under way: it grows as `FILE.part` and becomes `FILE` when it is closed, complete or not.
#[derive(Debug)]
pub struct Recorder {
    target: PathBuf,
    part: PathBuf,
    file: Option<BufWriter<File>>,
}

/// One entry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// `H`, `D`, `U`, `T` or `E`.
    pub kind: u8,
    /// Tick.
    pub tick: u32,
    /// Content.
    pub content: Vec<u8>,
}

/// A record that has been read.
#[derive(Debug, Clone)]
pub struct Record {
    /// Its entries, in order.
    pub entries: Vec<Entry>,
    /// Why it ends before its end, if it does.
    pub cut: Option<String>,
}

impl Recorder {
    /// Begins a record.
    ///
    /// # Errors
    /// The file cannot be made.
    pub fn create(target: &Path) -> io::Result<Self> {
        let device = fs::metadata(target).is_ok_and(|data| !data.is_file());
        let mut name = target.as_os_str().to_owned();
        name.push(".part");
        let part = if device { target.to_owned() } else { PathBuf::from(name) };
        let file = if device { File::options().write(true).open(&part)? } else { File::create(&part)? };
        let mut recorder =
            Self { target: target.to_owned(), part, file: Some(BufWriter::with_capacity(1 << 16, file)) };
        if let Some(file) = &mut recorder.file {
            file.write_all(MAGIC)?;
        }
        Ok(recorder)
    }

    /// Adds an entry.
    ///
    /// # Errors
    /// The disk is full, or gone.
    pub fn add(&mut self, kind: u8, tick: u32, content: &[u8]) -> io::Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let length = u32::try_from(content.len()).map_err(io::Error::other)?;
        let mut head = [kind, 0, 0, 0, 0, 0, 0, 0, 0];
        head[1..5].copy_from_slice(&tick.to_le_bytes());
        head[5..9].copy_from_slice(&length.to_le_bytes());
        let mut digest = CHECKSUM.digest();
        digest.update(&head);
        digest.update(content);
        file.write_all(&head)?;
        file.write_all(content)?;
        file.write_all(&digest.finalize().to_le_bytes())
    }

    /// Lets the file appear under its name.
    ///
    /// # Errors
    /// The last bytes cannot be written; what is there of it appears all the same.
    pub fn close(mut self) -> io::Result<()> {
        self.finish()
    }

    fn finish(&mut self) -> io::Result<()> {
        let Some(mut file) = self.file.take() else { return Ok(()) };
        let flushed = file.flush();
        // What cannot be written is let go: a second flush would fail again.
        drop(file.into_parts());
        if self.part != self.target {
            fs::rename(&self.part, &self.target)?;
        }
        flushed
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        // An error has been told where it happened; what is there of the record appears.
        let _ = self.finish();
    }
}

impl Record {
    /// Reads a record, or as much of it as is whole.
    ///
    /// # Errors
    /// The file cannot be read, or is no record.
    pub fn open(path: &Path) -> Result<Self, String> {
        let mut bytes = Vec::new();
        let read = File::open(path).and_then(|mut file| file.read_to_end(&mut bytes));
        read.map_err(|error| format!("{}: cannot be read: {error}", path.display()))?;
        Self::read(&bytes, &path.display().to_string())
    }

    /// Reads the bytes of a record, or as much of them as is whole.
    ///
    /// # Errors
    /// They are no record.
    pub fn read(bytes: &[u8], name: &str) -> Result<Self, String> {
        let Some(mut rest) = bytes.strip_prefix(MAGIC.as_slice()) else {
            return Err(format!("{name}: is no record; `gimbal hil --record FILE` writes one"));
        };
        let mut entries = Vec::new();
        let mut cut = None;
        while !rest.is_empty() {
            let Some((entry, after)) = entry(rest) else {
                let at = bytes.len() - rest.len();
                cut = Some(format!("{name}: ends within an entry at byte {at}; what comes before is used"));
                break;
            };
            entries.push(entry);
            rest = after;
        }
        if cut.is_none() && entries.last().is_none_or(|entry: &Entry| entry.kind != b'E') {
            cut = Some(format!("{name}: the run ended before its time"));
        }
        Ok(Self { entries, cut })
    }

    /// What stands in the header, as JSON.
    #[must_use]
    pub fn header(&self) -> Option<serde_json::Value> {
        let entry = self.entries.iter().find(|entry| entry.kind == b'H')?;
        serde_json::from_slice(&entry.content).ok()
    }
}

/// The first entry, and what follows it.
fn entry(bytes: &[u8]) -> Option<(Entry, &[u8])> {
    let (head, rest) = bytes.split_first_chunk::<9>()?;
    let [kind, t0, t1, t2, t3, l0, l1, l2, l3] = *head;
    let length = u32::from_le_bytes([l0, l1, l2, l3]);
    if length > LONGEST {
        return None;
    }
    let (content, rest) = rest.split_at_checked(length as usize)?;
    let (checksum, rest) = rest.split_first_chunk::<4>()?;
    let mut digest = CHECKSUM.digest();
    digest.update(head);
    digest.update(content);
    let whole = digest.finalize().to_le_bytes() == *checksum;
    whole.then(|| (Entry { kind, tick: u32::from_le_bytes([t0, t1, t2, t3]), content: content.to_vec() }, rest))
}

#[cfg(test)]
mod tests {
    use super::{Record, Recorder};

    #[test]
    fn contract_a_record_is_valid_wherever_it_ends() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("run.rec");
        let mut recorder = Recorder::create(&path).expect("made");
        for tick in 0..20 {
            recorder.add(b'D', tick, &[7; 30]).expect("written");
        }
        recorder.add(b'E', 20, b"{}").expect("written");
        assert!(!path.exists());
        recorder.close().expect("closed");
        let whole = Record::open(&path).expect("read");
        assert_eq!((whole.entries.len(), whole.cut), (21, None));
        let bytes = std::fs::read(&path).expect("read");
        for end in 11..bytes.len() {
            std::fs::write(&path, &bytes[..end]).expect("written");
            let part = Record::open(&path).expect("read");
            assert_eq!(part.entries, whole.entries[..part.entries.len()]);
            assert_eq!(part.entries.len(), (end - 11) / 43);
            assert!(part.cut.is_some());
        }
        let mut spoilt = bytes.clone();
        spoilt[200] ^= 1;
        std::fs::write(&path, spoilt).expect("written");
        assert_eq!(Record::open(&path).expect("read").entries.len(), (200 - 11) / 43);
        std::fs::write(&path, b"time_s,").expect("written");
        assert!(Record::open(&path).expect_err("no record").contains("is no record"));
    }
}
