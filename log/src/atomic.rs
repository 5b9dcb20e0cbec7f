//! Files that are either complete or not there.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Writes beside the target and renames when complete; dropped before that, it leaves nothing.
///
/// A target that exists and is no regular file (`/dev/stdout`, a pipe) is written directly.
#[derive(Debug)]
pub struct AtomicFile {
    target: PathBuf,
    output: Output,
}

#[derive(Debug)]
enum Output {
    Beside(BufWriter<NamedTempFile>),
    Direct(BufWriter<File>),
}

impl AtomicFile {
    /// Starts a file that will appear at `target`.
    ///
    /// # Errors
    /// The folder is not there or cannot be written.
    pub fn create(target: &Path) -> io::Result<Self> {
        // Through a symbolic link, as a plain write would go.
        let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_owned());
        if fs::metadata(&target).is_ok_and(|metadata| !metadata.is_file()) {
            let direct = BufWriter::new(File::options().write(true).open(&target)?);
            return Ok(Self { target, output: Output::Direct(direct) });
        }
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".gimbal-");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file: the umask takes away what it takes away.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        let beside = builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))?; // without a name that nobody gave
        Ok(Self { target, output: Output::Beside(BufWriter::with_capacity(1 << 16, beside)) })
    }

    /// Lets the file appear.
    ///
    /// # Errors
    /// The last bytes cannot be written, or the file cannot be renamed.
    pub fn commit(self) -> io::Result<()> {
        match self.output {
            Output::Direct(mut direct) => direct.flush(),
            Output::Beside(beside) => {
                let file = beside.into_inner().map_err(io::IntoInnerError::into_error)?;
                file.persist(&self.target).map(|_| ()).map_err(|error| error.error)
            }
        }
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.output {
            Output::Beside(beside) => beside.write(bytes),
            Output::Direct(direct) => direct.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.output {
            Output::Beside(beside) => beside.flush(),
            Output::Direct(direct) => direct.flush(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::AtomicFile;

    #[test]
    fn contract_a_file_appears_when_complete_and_not_before() {
        let folder = tempfile::tempdir().expect("a folder");
        let target = folder.path().join("out.csv");
        let mut file = AtomicFile::create(&target).expect("created");
        file.write_all(b"half").expect("written");
        assert!(!target.exists());
        drop(file);
        assert_eq!(std::fs::read_dir(folder.path()).expect("listed").count(), 0);
        let mut file = AtomicFile::create(&target).expect("created");
        file.write_all(b"whole").expect("written");
        file.commit().expect("renamed");
        assert_eq!(std::fs::read(&target).expect("read"), b"whole");
    }

    #[cfg(unix)]
    #[test]
    fn contract_a_device_stays_a_device() {
        let null = std::path::Path::new("/dev/null");
        let mut file = AtomicFile::create(null).expect("opened");
        file.write_all(b"gone").expect("written");
        file.commit().expect("flushed");
        assert!(!std::fs::metadata(null).expect("there").is_file());
    }
}
