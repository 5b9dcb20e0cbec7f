//! `gimbal`: the model of a gimballed platform's servo, on the command line.
//!
//! Exit status: 0 done, 1 it ran and the answer is "fails", 2 the input or the call is wrong, 3 the environment
//! failed, 130 interrupted. Without a subcommand it runs the main job, `run`.

#![deny(unsafe_code)]

mod blind;
mod convert;
mod doctor;
mod estimate;
mod exit;
mod figures;
mod gap;
mod hil;
mod interrupt;
mod model;
mod plot;
mod progress;
mod report;
mod run;
mod sweep;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Model of a gimballed inertial platform's servo: attitude, velocity and position error under acceleration and rate.
#[derive(Debug, Parser)]
#[command(name = "gimbal", version, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: run::Options,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Blind cases for the diagnosis: makes them sealed, diagnoses, scores.
    Blind(blind::Args),
    /// Turns a foreign CSV file into a log: names, units, axes, one constant rate.
    Convert(convert::Args),
    /// Looks for what hardware in the loop needs, and says how to mend what is missing.
    Doctor(doctor::Args),
    /// Attitude error with its bound and the INS correction, as the flight computer has them, from a log.
    Estimate(estimate::Args),
    /// Redraws the paper's figures and checks its numbers.
    Figures(figures::Args),
    /// Diagnoses the gap between a model and logs: where, which effect, how far it shrinks.
    Gap(gap::Args),
    /// Flies a flight computer in the loop with the simulated platform.
    Hil(hil::Args),
    /// Prints a model file with every parameter, to start from.
    Model(model::Args),
    /// Runs a log through the model; without one, the paper's two 20 g cases.
    Run(run::Args),
    /// Runs parameters over ranges and tolerances.
    Sweep(sweep::Args),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return exit::usage(&error),
    };
    interrupt::watch();
    let result = match &cli.command {
        Some(Command::Blind(args)) => blind::blind(args),
        Some(Command::Convert(args)) => convert::convert(args),
        Some(Command::Doctor(args)) => doctor::doctor(args),
        Some(Command::Estimate(args)) => estimate::estimate(args),
        Some(Command::Figures(args)) => figures::figures(args),
        Some(Command::Gap(args)) => gap::gap(args),
        Some(Command::Hil(args)) => hil::hil(args),
        Some(Command::Model(args)) => model::model(args),
        Some(Command::Run(args)) => run::run(args),
        Some(Command::Sweep(args)) => sweep::sweep(args),
        None => run::run_default(&cli.run),
    };
    exit::code(result)
}
