//! `gimbal convert`: a foreign CSV file into a log.

mod map;
mod told;

use std::path::{Path, PathBuf};

use clap::{Parser, ValueEnum};
use gimbal_log::import::{self, ColumnMap, GimbalAxis, Resampled};
use gimbal_log::{AtomicFile, Column, Log, LogError, Needs};

use crate::exit::Failure;
use crate::progress::Watched;
use crate::{interrupt, report};

/// What to convert, and how.
#[derive(Debug, Parser)]
#[command(after_help = "Units: s ms us ns min | mps2 g mg ftps2 | radps mradps dps mdps rpm | rad mrad deg arcmin \
                        arcsec | nm mnm dyne_cm lbf_in | c k f")]
pub(crate) struct Args {
    /// CSV file with a header
    file: PathBuf,
    /// Log to write
    #[arg(long, value_name = "FILE.csv")]
    out: PathBuf,
    /// What the columns are: found out from the header, an `AltOS` export, or any CSV
    #[arg(long, value_enum, default_value_t = Format::Auto)]
    format: Format,
    /// Column of the log = column of the file, with its unit and the direction of its axis; can be repeated
    #[arg(long, value_name = "COLUMN=NAME[,unit=U][,sign=-1]", value_parser = map::entry)]
    map: Vec<map::Entry>,
    /// The same in a TOML file: `[accel_x_mps2]` with `column`, `unit`, `sign`
    #[arg(long, value_name = "FILE.toml")]
    map_file: Option<PathBuf>,
    /// Vehicle axis along which the gimbal axis z lies (`AltOS`)
    #[arg(long, value_enum, default_value_t = Axis::Pitch)]
    gimbal_axis: Axis,
    /// Axes in which the accelerations were measured; the vehicle's are turned into the stable member's by the
    /// integral of the rate [default: vehicle for `AltOS`, stable-member for others]
    #[arg(long, value_enum)]
    accel_frame: Option<Frame>,
    /// Let the gimbal axis roll with the vehicle, instead of putting a roll gimbal outside of it (`AltOS`, axes across
    /// the rocket)
    #[arg(long)]
    keep_spin: bool,
    /// Rate of the log [Hz]
    #[arg(long, default_value_t = 1000.0)]
    rate_hz: f64,
    /// Start of the span that is taken over [s]
    #[arg(long, default_value_t = f64::NEG_INFINITY, hide_default_value = true, allow_negative_numbers = true)]
    from_s: f64,
    /// End of the span that is taken over [s]
    #[arg(long, default_value_t = f64::INFINITY, hide_default_value = true, allow_negative_numbers = true)]
    to_s: f64,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Auto,
    Altos,
    Csv,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Axis {
    Roll,
    Pitch,
    Yaw,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Frame {
    Vehicle,
    StableMember,
}

/// Converts.
pub(crate) fn convert(args: &Args) -> Result<(), Failure> {
    Failure::unless_other_file(&args.file, &args.out)?;
    let unreadable = |error| LogError::unreadable(&args.file, error);
    let names = import::header_names(Watched::open(&args.file).map_err(unreadable)?, &args.file)?;
    let altos = args.format == Format::Altos || (args.format == Format::Auto && import::is_altos(&names));
    let map = column_map(args, altos, &names)?;
    let mut source = import::read(Watched::open(&args.file).map_err(unreadable)?, &args.file, &map)?;
    needed(&source, &args.file, &names)?;
    interrupt::check()?;
    let despun = altos && args.gimbal_axis != Axis::Roll && !args.keep_spin;
    if despun && let Some(roll_rate_radps) = import::roll_rate_radps(&source) {
        import::take_out_roll(&mut source, &roll_rate_radps);
    }

    let mut resampled =
        take_span(&source, args).map_err(|wrong| Failure::input(format!("{}: {wrong}", args.file.display())))?;
    let frame = args.accel_frame.unwrap_or(if altos { Frame::Vehicle } else { Frame::StableMember });
    if frame == Frame::Vehicle {
        import::turn_into_stable_member(&mut resampled.log);
    }
    interrupt::check()?;

    let fail = || Failure::write(&args.out);
    let mut file = AtomicFile::create(&args.out).map_err(fail())?;
    resampled.log.write(&mut file).map_err(fail())?;
    interrupt::check()?;
    file.commit().map_err(fail())?;
    let told = told::Told { args, resampled: &resampled, altos, despun, turned: frame == Frame::Vehicle };
    report::print(&told.text(), args.json.then(|| told.json()).as_ref())
}

/// The map of the format, with what the command line and the map file say on top.
fn column_map(args: &Args, altos: bool, names: &[String]) -> Result<ColumnMap, Failure> {
    let axis = match args.gimbal_axis {
        Axis::Roll => GimbalAxis::Roll,
        Axis::Pitch => GimbalAxis::Pitch,
        Axis::Yaw => GimbalAxis::Yaw,
    };
    let mut map = if altos { axis.column_map().without_absent_temperature(names) } else { ColumnMap::default() };
    let mut entries = match &args.map_file {
        Some(path) => map::file(path)?,
        None => Vec::new(),
    };
    entries.extend(args.map.iter().cloned());
    for map::Entry { column, source } in entries {
        map.0.retain(|(known, _)| *known != column);
        map.0.push((column, source));
    }
    map.check().map_err(Failure::input)?;
    Ok(map)
}

/// What a log cannot do without must come from somewhere.
fn needed(source: &Log, file: &Path, names: &[String]) -> Result<(), Failure> {
    match Needs::Run.columns().iter().find(|column| source.column(**column).is_none()) {
        None => Ok(()),
        Some(column) => Err(Failure::input(format!(
            "{}: nothing gives `{}` [{}]; name its column with `--map {}=NAME,unit=U`, one of {}",
            file.display(),
            column.name(),
            column.unit(),
            column.name(),
            names.join(", ")
        ))),
    }
}

/// The span asked for at the rate asked for; rows that are so already stay as they are, extra columns with them.
fn take_span(source: &Log, args: &Args) -> Result<Resampled, String> {
    let whole = args.from_s == f64::NEG_INFINITY && args.to_s == f64::INFINITY;
    let at_rate = source.time.is_regular() && (source.time.rate_hz() / args.rate_hz - 1.0).abs() < 1e-6;
    let missing = Column::ALL.iter().any(|column| source.column(*column).is_some_and(|v| v.iter().any(|x| x.is_nan())));
    if whole && at_rate && !missing {
        return Ok(Resampled::untouched(source));
    }
    import::resample(source, args.rate_hz, args.from_s, args.to_s)
}
