//! `gimbal estimate`: what the flight computer makes of a log, against an outside reference or the simulated truth.

mod one;
mod picture;
mod score;
mod three;

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use gimbal_log::{Log, Needs};
use gimbal_model_file::{ModelFile, Tolerance};
use gimbal_servo::estimator::{self, Flags};
use gimbal_servo::{BuildError, Fixed};

use crate::exit::Failure;
use crate::{interrupt, report};
use three::Order;

/// Attitude error, its bound and the INS correction from a log of one axis or of three, against `gimbal_angle_rad` or the
/// simulated truth.
#[derive(Debug, Parser)]
pub(crate) struct Args {
    /// Log with `gyro_angle_rad`, or with `gyro_angle_rad_x`, `_y`, `_z` and the gimbal angles
    log: PathBuf,
    /// Model file; its table of tolerances makes the bound. Three axes are alike
    #[arg(long, value_name = "FILE.toml")]
    model: Option<PathBuf>,
    /// Number system of the estimator
    #[arg(long, value_enum, default_value_t = Number::F32)]
    number: Number,
    /// Axes of the gimbals of a three-axis log, from the outside in
    #[arg(long, value_name = "ORDER", default_value = "xyz", value_parser = Order::parse)]
    gimbals: Order,
    /// Draw the estimate with its bound as a band
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Number {
    F32,
    Fixed,
}

/// phi about one axis: true, estimated, and the estimate's 1 sigma [rad].
struct Axis {
    /// Behind a quantity's name in a picture; empty for one axis.
    suffix: &'static str,
    truth_rad: Vec<f64>,
    angle_rad: Vec<f64>,
    bound_rad: Vec<f64>,
}

/// A log estimated.
struct Course {
    times_s: Vec<f64>,
    period_s: f64,
    axes: Vec<Axis>,
    /// By row, of all axes.
    flags: Vec<Flags>,
    /// Specific force, in the axes of phi [m/s2].
    accels_mps2: Vec<[f64; 3]>,
    /// Whether the truth is the log's own.
    measured: bool,
    velocity_correction_mps: [f64; 3],
}

/// Estimates what the command line says.
pub(crate) fn estimate(args: &Args) -> Result<(), Failure> {
    let model = match &args.model {
        None => ModelFile::default(),
        Some(path) => ModelFile::open(path).map_err(|error| Failure::Input(error.into()))?,
    };
    model.without_effects("`gimbal estimate`").map_err(|error| Failure::Input(error.into()))?;
    if let Some(path) = &args.plot {
        Failure::unless_other_file(&args.log, path)?;
    }
    let course = if three::is_three_axes(&args.log)? { three::course(args, &model)? } else { one_axis(args, &model)? };
    if interrupt::raised() {
        return Err(Failure::Interrupted);
    }
    if let Some(path) = &args.plot {
        picture::draw(path, &course)?;
    }
    let score = score::Score::new(&course);
    report::print(&score.text(&course), args.json.then(|| score.json(&course)).as_ref())
}

fn one_axis(args: &Args, model: &ModelFile) -> Result<Course, Failure> {
    let log = Log::open(&args.log, Needs::Diagnosis)?;
    with_rows(&log, args)?;
    match args.number {
        Number::F32 => one::course::<f32>(&log, model),
        Number::Fixed => one::course::<Fixed>(&log, model),
    }
    .map_err(|error| refused(args, &error))
}

fn with_rows(log: &Log, args: &Args) -> Result<(), Failure> {
    if log.len() < 2 {
        return Err(Failure::input(format!("{}: has no two rows; nothing to estimate", args.log.display())));
    }
    Ok(())
}

fn refused(args: &Args, error: &BuildError) -> Failure {
    Failure::input(format!("{}: {error}", args.log.display()))
}

/// The sensors as the log shows them, the tolerances of the model file.
fn settings(tolerance: &Tolerance, angles: &[f64], motor_torque_measured: bool) -> estimator::Config {
    let mut settings = estimator::Config { tolerance: tolerance.estimator(), ..estimator::Config::default() };
    settings.sensors.motor_torque_measured = motor_torque_measured;
    // A log without noise repeats values for good reasons.
    let equal = angles.windows(2).filter(|pair| pair[0].to_bits() == pair[1].to_bits()).count();
    if 2 * equal > angles.len() {
        settings.sensors.stuck_rows = 0;
    }
    settings
}

/// The samples of a column; a missing one is the last one again.
fn kept(values: &[f64]) -> Vec<f64> {
    let mut last = 0.0;
    let keep = |value: &f64| {
        if value.is_finite() {
            last = *value;
        }
        last
    };
    values.iter().map(keep).collect()
}
