//! How the program ends: one line on standard error, and the exit status that belongs to it.

use std::process::ExitCode;

use gimbal_log::LogError;

use crate::interrupt;

/// Why the program cannot do what was asked.
#[derive(Debug)]
pub(crate) enum Failure {
    /// It ran, and the answer is "fails": status 1.
    Fails(String),
    /// The input or the call is wrong: status 2.
    Input(anyhow::Error),
    /// The environment failed: status 3.
    Environment(anyhow::Error),
    /// Interrupted from the keyboard: status 130.
    Interrupted,
}

impl From<LogError> for Failure {
    fn from(error: LogError) -> Self {
        if interrupt::raised() {
            Self::Interrupted
        } else if error.is_environment() {
            Self::Environment(error.into())
        } else {
            Self::Input(error.into())
        }
    }
}

impl Failure {
    /// The input or the call is wrong.
    pub(crate) fn input(message: impl Into<String>) -> Self {
        Self::Input(anyhow::Error::msg(message.into()))
    }

    /// A file to be written is the one that is read.
    pub(crate) fn unless_other_file(read: &std::path::Path, written: &std::path::Path) -> Result<(), Self> {
        let same = match (read.canonicalize(), written.canonicalize()) {
            (Ok(read), Ok(written)) => read == written && read.is_file(),
            _ => false,
        };
        if same {
            let name = written.display();
            return Err(Self::input(format!("{name}: is the file that is read; write to another one")));
        }
        Ok(())
    }

    /// A file cannot be written.
    pub(crate) fn write(path: &std::path::Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |error| {
            let message = anyhow::anyhow!("{}: cannot be written: {error}", path.display());
            match error.kind() {
                _ if interrupt::raised() => Self::Interrupted,
                std::io::ErrorKind::NotFound
                | std::io::ErrorKind::PermissionDenied
                | std::io::ErrorKind::NotADirectory
                | std::io::ErrorKind::IsADirectory => Self::Input(message),
                _ => Self::Environment(message),
            }
        }
    }
}

/// Ends a call that is none: help and version as they are, a mistake on one line.
pub(crate) fn usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    let text = error.to_string();
    let told = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let told: Vec<&str> = told.filter(|line| !line.is_empty() && !line.starts_with("For more")).collect();
    eprintln!("{}", told.join("; ").replace(":; ", ": "));
    ExitCode::from(2)
}

/// Tells the failure and gives the exit status.
pub(crate) fn code(result: Result<(), Failure>) -> ExitCode {
    let (message, status) = match result {
        Ok(()) => return ExitCode::SUCCESS,
        Err(Failure::Fails(message)) => (message, 1),
        Err(Failure::Input(error)) => (error.to_string(), 2),
        Err(Failure::Environment(error)) => (error.to_string(), 3),
        Err(Failure::Interrupted) => ("interrupted; no file is half-written".to_owned(), 130),
    };
    eprintln!("error: {}", message.lines().collect::<Vec<_>>().join("; "));
    ExitCode::from(status)
}
