//! Stage `tests`: every test on the host.
//!
//! Once, with the profile `checked`: optimised, because the tests step through hours of flight, and with overflow
//! checks and debug assertions on, because they find what a release build hides. That the profile changes no bit of
//! the output is the business of the stage `digests`.

use crate::shell;
use crate::stages::Note;
use anyhow::Result;

pub(crate) fn run() -> Result<Note> {
    shell::run(&mut shell::cargo("test --workspace --profile checked --no-fail-fast"))?;
    Ok(Note::new())
}
