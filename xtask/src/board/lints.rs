//! Stage `target-lints`: clippy on the firmware as the boards see it; on the host most of it is compiled out.

use super::{boards, toolchain::Toolchain};
use crate::shell::run;
use crate::stages::Note;
use anyhow::Result;
use std::collections::BTreeSet;

pub(crate) fn check() -> Result<Note> {
    let boards = boards::all()?;
    let targets: BTreeSet<&str> = boards.iter().map(|board| board.target.as_str()).collect();
    for target in targets {
        let toolchain = Toolchain::ready(target)?;
        if toolchain == Toolchain::Debian {
            return Ok("skipped: clippy comes with rustup's toolchain only".into());
        }
        run(toolchain
            .cargo("clippy --quiet --release --package gimbal-firmware", target)
            .args(["--", "-D", "warnings"]))?;
        if target.starts_with("thumbv7em") {
            let words = "clippy --quiet --release --package gimbal-firmware --bins --examples";
            for features in ["defmt", "rtic", "embassy"] {
                run(toolchain.cargo(words, target).args(["--features", features, "--", "-D", "warnings"]))?;
            }
        }
    }
    Ok(Note::new())
}
