//! QEMU: installed when absent, and run so that every instruction takes the same virtual time.

use super::boards::Board;
use super::packages;
use crate::shell::{program, version_of};
use anyhow::{Context, Result, bail};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// No program of ours runs longer on the host; one that does hangs.
const PATIENCE: Duration = Duration::from_mins(5);

/// Version of the emulator, which is installed if need be.
pub(crate) fn ready(emulator: &str) -> Result<String> {
    if let Some(version) = version_of(emulator) {
        return Ok(version);
    }
    let package = if emulator == "qemu-system-arm" { emulator } else { "qemu-system-misc" };
    packages::install(&[package], emulator)?;
    version_of(emulator).with_context(|| format!("{package} is installed, but {emulator} does not start"))
}

/// Runs `image` on the emulated board to its end and returns what it printed; an exit status other than 0 is an error.
pub(crate) fn run(board: &Board, image: &Path) -> Result<String> {
    // 2^10 ns an instruction: slow, but then every timer tells single instructions apart.
    let (output, success) = run_to_end(board, image, 10)?;
    let name = image.file_name().unwrap_or_default().to_string_lossy();
    if success { Ok(output) } else { bail!("{name} on {} failed:\n{output}", board.name) }
}

/// Runs `image` with an instruction every `2^shift` ns: what it printed, and whether it ended well.
pub(crate) fn run_to_end(board: &Board, image: &Path, shift: u8) -> Result<(String, bool)> {
    let (output, errors, success) = run_to_end_raw(board, image, shift)?;
    Ok((String::from_utf8_lossy(&output).into_owned() + &errors, success))
}

/// The same, what it printed as it came, and what the emulator had to say.
pub(crate) fn run_to_end_raw(board: &Board, image: &Path, shift: u8) -> Result<(Vec<u8>, String, bool)> {
    ready(&board.emulator.program)?;
    let mut command = program(&board.emulator.program);
    command
        .args(["-machine", &board.emulator.machine])
        .args(&board.emulator.options)
        .args(["-nographic", "-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", "enable=on,target=native"])
        // Time that the core sleeps through is skipped, not waited for.
        .args(["-icount", &format!("shift={shift},sleep=off")])
        .arg("-kernel")
        .arg(image);
    run_within(&mut command, PATIENCE)
}

/// Output, standard error, and whether it went well; it is killed when it takes too long.
fn run_within(command: &mut Command, patience: Duration) -> Result<(Vec<u8>, String, bool)> {
    let name = command.get_program().to_string_lossy().into_owned();
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .with_context(|| format!("cannot start {name}"))?;
    let mut stdout = child.stdout.take().context("no output")?;
    let mut stderr = child.stderr.take().context("no output")?;
    // Both pipes are drained while it runs, or it would stop when one is full.
    let output = thread::spawn(move || {
        let mut bytes = Vec::new();
        stdout.read_to_end(&mut bytes).map(|_| bytes)
    });
    let errors = thread::spawn(move || {
        let mut text = String::new();
        stderr.read_to_string(&mut text).map(|_| text)
    });
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if start.elapsed() > patience {
            child.kill()?;
            child.wait()?;
            break None;
        }
        thread::sleep(Duration::from_millis(5));
    };
    let output = output.join().expect("reading does not panic")?;
    let errors = errors.join().expect("reading does not panic")?;
    let Some(status) = status else {
        let text = String::from_utf8_lossy(&output);
        bail!("{name} did not end within {} s; so far:\n{text}{errors}", patience.as_secs())
    };
    Ok((output, errors, status.success()))
}
