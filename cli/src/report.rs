//! Results: text for people, or one JSON object on standard output and the text on standard error.

use std::io::{self, Write};

use crate::exit::Failure;

/// Prints a result.
pub(crate) fn print(text: &str, json: Option<&serde_json::Value>) -> Result<(), Failure> {
    let printed = match json {
        Some(object) => {
            eprintln!("{text}");
            writeln!(io::stdout(), "{object}")
        }
        None => writeln!(io::stdout(), "{text}"),
    };
    match printed {
        // Whoever reads has read enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(|error| Failure::Environment(error.into())),
    }
}
