//! Project tasks: `cargo xtask test` runs every check there is.
//!
//! Exit status: 0 all passed, 1 a check failed, 2 the call is wrong, 3 something needed is missing and cannot be
//! installed from here.

mod board;
mod elf;
mod host;
mod shell;
mod stages;

use anyhow::Result;
use stages::{Missing, Stages};
use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask <task>

  test [--only TEXT]   every check; with --only, the stages whose name contains TEXT
  list                 names of the stages
  cost [--target BOARD] [--json]
                       instructions, flash, state and stack of the step on an emulated board
  flight [BOARD]       a minute of flight on an emulated board, its log decoded
  header               writes c/include/gimbal_servo.h
  profile [BOARD]      where the instructions of the step go, function by function of the source
  budget               writes the figures of every board to firmware/budget/, which `test` compares with
  blind                forges, diagnoses and scores the small blind corpus and writes docs/blind/check/, which
                       `test` compares with
  fuzz SECONDS         every fuzz target for so long; what reaches new code joins fuzz/corpus/
  deny                 cargo-deny on the whole tree; installs it if absent (minutes)
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["test"] => test(&Stages::all()),
        ["test", "--only", text] => test(&Stages::all().only(text)),
        ["list"] => {
            Stages::all().list();
            ExitCode::SUCCESS
        }
        ["cost", rest @ ..] => cost(rest),
        ["flight"] => task(&|| board::log::print(board::DEFAULT_BOARD)),
        ["flight", board] => task(&|| board::log::print(board)),
        ["header"] => task(&board::c::write_header),
        ["profile"] => task(&|| board::profile::print(board::DEFAULT_BOARD)),
        ["profile", board] => task(&|| board::profile::print(board)),
        ["budget"] => task(&board::budget::write),
        ["blind"] => task(&host::blind::write),
        ["fuzz", seconds] if seconds.parse::<u32>().is_ok() => {
            task(&|| host::fuzz::fuzz(seconds.parse().unwrap_or_default()))
        }
        ["deny"] => task(&host::deny::install_and_check),
        ["help" | "--help" | "-h"] => {
            print!("{USAGE}");
            ExitCode::SUCCESS
        }
        _ => {
            eprint!("unknown task `{}`\n\n{USAGE}", words.join(" "));
            ExitCode::from(2)
        }
    }
}

fn test(stages: &Stages) -> ExitCode {
    if stages.is_empty() {
        eprintln!("no stage of that name; `cargo xtask list` names them");
        return ExitCode::from(2);
    }
    ExitCode::from(stages.run())
}

/// `cost`: for the default board unless another is named.
fn cost(words: &[&str]) -> ExitCode {
    let (mut board, mut json) = (board::DEFAULT_BOARD, false);
    let mut words = words.iter();
    while let Some(&word) = words.next() {
        match (word, words.len()) {
            ("--json", _) => json = true,
            ("--target", 1..) => board = words.next().copied().unwrap_or_default(),
            _ => {
                eprint!("`cost` does not take `{word}`\n\n{USAGE}");
                return ExitCode::from(2);
            }
        }
    }
    task(&|| board::cost::print(board, json))
}

/// One task by itself, with the exit status of its error.
fn task(run: &dyn Fn() -> Result<()>) -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(if error.is::<Missing>() { 3 } else { 1 })
        }
    }
}
