//! Stage `lints`: clippy says nothing, on every target of every package, and on the library with each feature alone.

use crate::shell::{cargo, run};
use crate::stages::Note;
use anyhow::Result;

pub(crate) fn check() -> Result<Note> {
    run(&mut cargo("clippy --quiet --workspace --all-targets -- -D warnings"))?;
    // In the workspace another package may switch a feature on; the library must also stand without it.
    run(&mut cargo("clippy --quiet --package gimbal-servo --no-default-features -- -D warnings"))?;
    run(&mut cargo("clippy --quiet --package gimbal-servo --all-features -- -D warnings"))?;
    Ok(Note::new())
}
