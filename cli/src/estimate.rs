//! `gimbal estimate`: what the flight computer makes of a log, against an outside reference or the simulated truth.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Parser, ValueEnum};
use gimbal_log::{AtomicFile, Column, Log, Needs};
use gimbal_model_file::{ModelFile, Tolerance};
use gimbal_plant::{Plant, Row};
use gimbal_servo::estimator::{self, Flags};
use gimbal_servo::{BuildError, Config, Fixed, Input, Number as System};
use serde_json::json;

use crate::exit::Failure;
use crate::plot::{Envelope, Figure, Line, Panel};
use crate::{interrupt, plot, report};

/// Attitude error, its bound and the INS correction from a log, against `gimbal_angle_rad` or the simulated truth.
#[derive(Debug, Parser)]
pub(crate) struct Args {
    /// Log with `gyro_angle_rad`
    log: PathBuf,
    /// Model file; its table of tolerances makes the bound
    #[arg(long, value_name = "FILE.toml")]
    model: Option<PathBuf>,
    /// Number system of the estimator
    #[arg(long, value_enum, default_value_t = Number::F32)]
    number: Number,
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

/// One row of the estimate.
struct Point {
    angle_rad: f64,
    bound_rad: f64,
    flags: Flags,
}

/// What came out.
struct Estimated {
    points: Vec<Point>,
    velocity_correction_mps: [f64; 2],
}

/// phi and where it is from.
struct Truth {
    angles_rad: Vec<f64>,
    measured: bool,
}

/// Estimates what the command line says.
pub(crate) fn estimate(args: &Args) -> Result<(), Failure> {
    let model = match &args.model {
        None => ModelFile::default(),
        Some(path) => ModelFile::open(path).map_err(|error| Failure::Input(error.into()))?,
    };
    if let Some(path) = &args.plot {
        Failure::unless_other_file(&args.log, path)?;
    }
    let log = Log::open(&args.log, Needs::Diagnosis)?;
    if log.len() < 2 {
        return Err(Failure::input(format!("{}: has no two rows; nothing to estimate", args.log.display())));
    }
    let config = Config { period_s: log.time.period_s, ..model.config };
    let rows = rows(&log);
    let truth = truth(&log, &config, &rows)?;
    let settings = settings(&log, &model.tolerance);
    let wrong = |error: BuildError| Failure::input(format!("{}: {error}", args.log.display()));
    let estimated = match args.number {
        Number::F32 => run::<f32>(&config, &settings, &log, &rows).map_err(wrong)?,
        Number::Fixed => run::<Fixed>(&config, &settings, &log, &rows).map_err(wrong)?,
    };
    if interrupt::raised() {
        return Err(Failure::Interrupted);
    }
    if let Some(path) = &args.plot {
        draw(path, &log, &truth, &estimated)?;
    }
    let summary = Summary::new(&config, &rows, &truth, &estimated);
    report::print(&summary.text(&truth), args.json.then(|| summary.json()).as_ref())
}

/// Inputs of each row; a missing sample is the last one again.
fn rows(log: &Log) -> Vec<Row> {
    let mut last = Row::default();
    let keep = |value: f64, last: &mut f64| {
        if value.is_finite() {
            *last = value;
        }
    };
    (0..log.len())
        .map(|index| {
            let row = log.row(index);
            keep(row[Column::AccelX], &mut last.accel_x_mps2);
            keep(row[Column::AccelY], &mut last.accel_y_mps2);
            keep(row[Column::AccelZ], &mut last.accel_z_mps2);
            keep(row[Column::VehicleRate], &mut last.vehicle_rate_radps);
            last
        })
        .collect()
}

fn truth(log: &Log, config: &Config, rows: &[Row]) -> Result<Truth, Failure> {
    if let Some(angles) = log.column(Column::GimbalAngle) {
        return Ok(Truth { angles_rad: angles.to_vec(), measured: true });
    }
    let plant = Plant::new(config).map_err(|error| Failure::input(error.to_string()))?.with_tolerance(1e-8);
    let angles_rad = plant.run(rows.iter().copied()).map(|sample| sample.gimbal_angle_rad).collect();
    Ok(Truth { angles_rad, measured: false })
}

/// The sensors as the log shows them, the tolerances of the model file.
fn settings(log: &Log, tolerance: &Tolerance) -> estimator::Config {
    let mut settings = estimator::Config {
        tolerance: estimator::Tolerance {
            damping: tolerance.gyro_damping,
            float_inertia: tolerance.default_relative,
            angular_momentum: tolerance.angular_momentum,
            gimbal_inertia: tolerance.gimbal_inertia,
            stop_angle: tolerance.stop_angle,
            friction_level: tolerance.friction_level,
        },
        ..estimator::Config::default()
    };
    settings.sensors.motor_torque_measured = log.column(Column::MotorTorque).is_some();
    // A log without noise repeats values for good reasons.
    let angles = log.column(Column::GyroAngle).unwrap_or_default();
    let equal = angles.windows(2).filter(|pair| pair[0].to_bits() == pair[1].to_bits()).count();
    if 2 * equal > angles.len() {
        settings.sensors.stuck_rows = 0;
    }
    settings
}

fn run<N: System>(
    config: &Config,
    settings: &estimator::Config,
    log: &Log,
    rows: &[Row],
) -> Result<Estimated, BuildError> {
    let (axis, law) = (config.build::<N>()?, settings.build::<N>(config)?);
    let (mut model, mut state) = (axis.start(), law.start());
    let mut points = Vec::with_capacity(rows.len());
    let cell = |column: Column, index: usize| log.column(column).map(|values| values[index]);
    for (index, row) in rows.iter().enumerate() {
        let input = Input {
            accel_x_mps2: row.accel_x_mps2,
            accel_y_mps2: row.accel_y_mps2,
            accel_z_mps2: row.accel_z_mps2,
            vehicle_rate_radps: row.vehicle_rate_radps,
            ..Input::default()
        };
        let output = axis.step(&mut model, axis.units().input(&input));
        let measured = law.measured(cell(Column::GyroAngle, index), cell(Column::MotorTorque, index));
        let estimate = law.si(&law.step(&mut state, &measured, &axis, &model, output.faults));
        points.push(Point {
            angle_rad: estimate.gimbal_angle_rad,
            bound_rad: estimate.bound_rad,
            flags: estimate.flags,
        });
    }
    Ok(Estimated { points, velocity_correction_mps: law.velocity_correction_mps(&state) })
}

/// How good the estimate is.
struct Summary {
    error_rms_rad: f64,
    angle_rms_rad: f64,
    before_mps: f64,
    after_mps: f64,
    coverage: f64,
    flags: Flags,
}

impl Summary {
    fn new(config: &Config, rows: &[Row], truth: &Truth, estimated: &Estimated) -> Self {
        // The first second is not scored: the state before the first row is unknown.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows in a second")]
        let second = (1.0 / config.period_s) as usize;
        let from = if rows.len() > 2 * second { second } else { 0 };
        let (mut error, mut square, mut within, mut count) = (0.0, 0.0, 0_usize, 0_usize);
        for (point, angle) in estimated.points.iter().zip(&truth.angles_rad).skip(from) {
            if angle.is_finite() {
                error += (point.angle_rad - angle).powi(2);
                square += angle * angle;
                within += usize::from((point.angle_rad - angle).abs() <= 2.0 * point.bound_rad);
                count += 1;
            }
        }
        let [x, y] = velocity_error_mps(config, rows, &truth.angles_rad);
        let [cx, cy] = estimated.velocity_correction_mps;
        let count = count.max(1) as f64;
        Self {
            error_rms_rad: (error / count).sqrt(),
            angle_rms_rad: (square / count).sqrt(),
            before_mps: x.hypot(y),
            after_mps: (x + cx).hypot(y + cy),
            coverage: within as f64 / count,
            flags: estimated.points.iter().fold(Flags::NONE, |flags, point| flags | point.flags),
        }
    }

    fn text(&self, truth: &Truth) -> String {
        let names: Vec<&str> =
            Flags::NAMES.iter().filter(|(flag, _)| self.flags.contains(*flag)).map(|(_, name)| *name).collect();
        format!(
            "truth                    {}\nattitude error           {:.3e} rad rms after the estimate, {:.3e} rad rms of phi \
             itself\nvelocity error           {:.4e} m/s before, {:.4e} m/s after the correction\nrows within 2 sigma      \
             {:.1} %\nflags                    {}",
            if truth.measured { "gimbal_angle_rad of the log" } else { "the plant under the log's inputs" },
            self.error_rms_rad,
            self.angle_rms_rad,
            self.before_mps,
            self.after_mps,
            100.0 * self.coverage,
            if names.is_empty() { "none".to_owned() } else { names.join(", ") }
        )
    }

    fn json(&self) -> serde_json::Value {
        json!({
            "attitude_error_rms_rad": self.error_rms_rad,
            "attitude_rms_rad": self.angle_rms_rad,
            "velocity_error_before_mps": self.before_mps,
            "velocity_error_after_mps": self.after_mps,
            "bound_coverage_2sigma": self.coverage,
        })
    }
}

/// (7) over the true phi, by trapezoids.
fn velocity_error_mps(config: &Config, rows: &[Row], angles_rad: &[f64]) -> [f64; 2] {
    let mut velocity = [0.0; 2];
    let at = |index: usize| {
        let angle = if angles_rad[index].is_finite() { angles_rad[index] } else { 0.0 };
        [rows[index].accel_y_mps2 * angle, -rows[index].accel_x_mps2 * angle]
    };
    for index in 1..rows.len() {
        let (before, now) = (at(index - 1), at(index));
        for axis in 0..2 {
            velocity[axis] += 0.5 * config.period_s * (before[axis] + now[axis]);
        }
    }
    velocity
}

fn draw(path: &Path, log: &Log, truth: &Truth, estimated: &Estimated) -> Result<(), Failure> {
    let times = log.column(Column::Time).unwrap_or_default();
    let [mut phi, mut low, mut high, mut error, mut two, mut minus, mut stop] = [(); 7].map(|()| Envelope::new());
    // The bound of the first rows, of which nothing is known before, would hide all others.
    let from = if times.len() > 1_000 { 100 } else { 0 };
    for ((time_s, point), angle) in times.iter().zip(&estimated.points).zip(&truth.angles_rad).skip(from) {
        phi.push(*time_s, *angle);
        low.push(*time_s, point.angle_rad - 2.0 * point.bound_rad);
        high.push(*time_s, point.angle_rad + 2.0 * point.bound_rad);
        error.push(*time_s, point.angle_rad - angle);
        two.push(*time_s, 2.0 * point.bound_rad);
        minus.push(*time_s, -2.0 * point.bound_rad);
        stop.push(*time_s, f64::from(u8::from(point.flags.contains(Flags::SATURATED))));
    }
    let shaded = stop.spans_above(0.5);
    let panels = vec![
        Panel::new(
            "phi within the estimate's 2 sigma",
            "rad",
            vec![Line::new("true", &phi), Line::new("estimate + 2 sigma", &high), Line::new("- 2 sigma", &low)],
        ),
        Panel::new(
            "Estimate less truth",
            "rad",
            vec![Line::new("error", &error), Line::new("+ 2 sigma", &two), Line::new("- 2 sigma", &minus)],
        ),
    ];
    let title = "Attitude estimate";
    let figure = Figure { title, panels, shaded: &shaded, shaded_name: "gyro on its stop" };
    let text = plot::svg(&figure).map_err(|error| Failure::Environment(anyhow::Error::msg(error)))?;
    let fail = || Failure::write(path);
    let mut file = AtomicFile::create(path).map_err(fail())?;
    file.write_all(text.as_bytes()).map_err(fail())?;
    file.commit().map_err(fail())
}
