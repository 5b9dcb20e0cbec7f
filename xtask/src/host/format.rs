//! Stage `format`: rustfmt changes nothing.

use crate::shell::{cargo, run};
use crate::stages::Note;
use anyhow::Result;

pub(crate) fn check() -> Result<Note> {
    run(&mut cargo("fmt --all --check"))?;
    Ok(Note::new())
}
