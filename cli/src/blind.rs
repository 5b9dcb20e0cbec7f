//! `gimbal blind`: sealed cases for the diagnosis, its reports under a manifest, and the score.

mod diagnose;
mod forge;
mod freeze;
mod score;

use std::time::{SystemTime, UNIX_EPOCH};

use gimbal_forge::folder::Refusal;

use crate::exit::Failure;

/// Options of `gimbal blind`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, clap::Subcommand)]
enum Command {
    /// Records the program that will diagnose, before the seed of its corpus is drawn.
    Freeze(freeze::Args),
    /// Makes a corpus: logs, nominal models, and answers that only the key opens.
    Forge(forge::Args),
    /// Runs a diagnosis over the logs alone and commits its reports to a manifest.
    Diagnose(diagnose::Args),
    /// Opens the answers and scores the reports.
    Score(score::Args),
}

/// Runs `gimbal blind`.
pub(crate) fn blind(args: &Args) -> Result<(), Failure> {
    match &args.command {
        Command::Freeze(args) => freeze::freeze(args),
        Command::Forge(args) => forge::forge(args),
        Command::Diagnose(args) => diagnose::diagnose(args),
        Command::Score(args) => score::score(args),
    }
}

fn now_unix_s() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |age| age.as_secs())
}

fn refused(refusal: &Refusal) -> Failure {
    Failure::input(refusal.to_string())
}

fn bar(length: u64, what: &'static str) -> indicatif::ProgressBar {
    use std::io::IsTerminal;
    if !std::io::stderr().is_terminal() {
        return indicatif::ProgressBar::hidden();
    }
    let bar = indicatif::ProgressBar::new(length);
    if let Ok(style) = indicatif::ProgressStyle::with_template("{msg} {bar:40} {pos}/{len}  {eta} left") {
        bar.set_style(style);
    }
    bar.with_message(what)
}
