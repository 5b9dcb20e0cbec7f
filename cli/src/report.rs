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

/// A number and what is counted, one or several.
pub(crate) fn counted(count: u64, name: &str) -> String {
    if count == 1 { format!("1 {name}") } else { format!("{count} {name}s") }
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn contract_one_is_no_plural() {
        assert_eq!(counted(1, "run"), "1 run");
        assert_eq!(counted(0, "run"), "0 runs");
    }
}
