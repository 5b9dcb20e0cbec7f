//! Stage `target-examples`: the 1 kHz call on cortex-m-rt alone, in RTIC and in Embassy; each flies ten seconds on the
//! default board, and its outputs are the host's.

use super::{boards, emulator, image};
use crate::shell::{capture, cargo};
use crate::stages::Note;
use anyhow::{Context, Result, ensure};

/// The examples, and the feature that each needs.
const EXAMPLES: [(&str, Option<&str>); 3] =
    [("tick_bare", None), ("tick_rtic", Some("rtic")), ("tick_embassy", Some("embassy"))];

pub(crate) fn check() -> Result<Note> {
    let expected = capture(&mut cargo("run --quiet --release --package gimbal-firmware --example tick_bare"))?;
    let expected = expected.split_inclusive('\n').next().context("the host prints nothing")?;
    let board = boards::by_name(boards::DEFAULT)?;
    let shift = board.emulator.flight_shift.context("the default board flies")?;
    for (example, feature) in EXAMPLES {
        let (output, success) = emulator::run_to_end(&board, &image::example(&board, example, feature)?, shift)?;
        ensure!(success && output == expected, "{example}:\n{output}host:\n{expected}");
        print!("{example:<14} {output}");
    }
    Ok(format!("{} examples", EXAMPLES.len()))
}
