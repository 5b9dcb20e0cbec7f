//! `gimbal model`: a model file to start from.

use std::io::Write;
use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use gimbal_log::AtomicFile;
use gimbal_model_file::{Preset, Tolerance, write};
use gimbal_servo::Config;

use crate::exit::Failure;
use crate::report;

/// A model file with every parameter, its unit and its meaning.
#[derive(Debug, Parser)]
pub(crate) struct Args {
    /// The set to start from
    #[arg(value_enum, default_value_t = Set::Consistent)]
    preset: Set,
    /// Write it; otherwise it is printed
    #[arg(long, value_name = "FILE.toml")]
    out: Option<PathBuf>,
}

/// Parameter sets.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Set {
    /// T5 = 0.168 s, which meets the paper's own results
    Consistent,
    /// Every coefficient as printed
    AsPrinted,
}

/// Runs what the command line says.
pub(crate) fn model(args: &Args) -> Result<(), Failure> {
    let (preset, config) = match args.preset {
        Set::Consistent => (Preset::Consistent, Config::consistent()),
        Set::AsPrinted => (Preset::AsPrinted, Config::as_printed()),
    };
    let text = write(preset, &config, &Tolerance::default());
    let Some(out) = &args.out else { return report::print(text.trim_end(), None) };
    let mut file = AtomicFile::create(out).map_err(Failure::write(out))?;
    file.write_all(text.as_bytes()).map_err(Failure::write(out))?;
    file.commit().map_err(Failure::write(out))?;
    report::print(&format!("written: {}", out.display()), None)
}
