//! Running other programs: echoed, from the root of the workspace, with an error that names the command.

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// Root of the workspace: of the one that cargo runs this program for, which need not be where it was compiled.
pub(crate) fn root() -> &'static Path {
    static ROOT: LazyLock<PathBuf> = LazyLock::new(|| {
        let package = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_else(|_| env!("CARGO_MANIFEST_DIR").into());
        Path::new(&package).parent().expect("xtask/ lies in the workspace").to_owned()
    });
    &ROOT
}

/// Where cargo puts what it builds.
pub(crate) fn target_dir() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// Space left on the disk that cargo builds on, in gigabytes; none where `df` does not tell.
pub(crate) fn free_disk_gb() -> Option<f64> {
    let existing = target_dir().ancestors().find(|folder| folder.exists())?.to_owned();
    let output = program("df").args(["-P", "-k"]).arg(existing).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let kilobytes: f64 = text.lines().nth(1)?.split_whitespace().nth(3)?.parse().ok()?;
    Some(kilobytes * 1024.0 / 1e9)
}

/// The cargo that started this program, without its incremental cache: a check builds once, and the cache fills disks.
pub(crate) fn cargo(words: &str) -> Command {
    let mut command = program(&std::env::var("CARGO").unwrap_or_else(|_| "cargo".into()));
    command.args(words.split_whitespace()).env("CARGO_INCREMENTAL", "0");
    command
}

/// A program, to be run in the root of the workspace.
pub(crate) fn program(name: &str) -> Command {
    let mut command = Command::new(name);
    command.current_dir(root());
    command
}

/// The program's version line, if it can be started at all.
pub(crate) fn version_of(name: &str) -> Option<String> {
    let output = program(name).arg("--version").output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    output.status.success().then(|| text.lines().next().unwrap_or_default().to_owned())
}

/// Runs it with its output on ours.
pub(crate) fn run(command: &mut Command) -> Result<()> {
    let line = echo(command);
    let status = command.status().with_context(|| format!("cannot start `{line}`"))?;
    if status.success() { Ok(()) } else { bail!("`{line}` failed ({status})") }
}

/// Runs it and returns its standard output; what it says on standard error appears only when it fails.
pub(crate) fn capture(command: &mut Command) -> Result<String> {
    let line = echo(command);
    let output = command.output().with_context(|| format!("cannot start `{line}`"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(text);
    }
    bail!("`{line}` failed ({})\n{text}{}", output.status, String::from_utf8_lossy(&output.stderr))
}

fn echo(command: &Command) -> String {
    let words: Vec<_> = std::iter::once(command.get_program())
        .chain(command.get_args())
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    let line = words.join(" ");
    let short = Path::new(&words[0]).file_name().map_or(words[0].clone(), |name| name.to_string_lossy().into_owned());
    eprintln!("$ {short}{}", &line[words[0].len()..]);
    line
}
