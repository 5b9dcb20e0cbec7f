//! A log of three axes: the columns of one with the suffix of each axis, and one angle a gimbal (`docs/platform.md`).

use std::fs::File;
use std::path::Path;

use gimbal_log::import::{self, ColumnMap, Source};
use gimbal_log::{Column, Log, LogError};
use gimbal_model_file::ModelFile;
use gimbal_plant::Platform;
use gimbal_servo::platform::{self, Gimbal, Input};
use gimbal_servo::{BuildError, Fixed, Number as System};

use super::{Args, Axis, Course, Number, kept, refused, settings, with_rows};
use crate::exit::Failure;

/// Axes from the outside in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Order([platform::Axis; 3]);

/// Columns that each axis has, needed ones first, with their units in a map.
const EACH: [(Column, &str); 5] = [
    (Column::VehicleRate, "radps"),
    (Column::RelativeAngle, "rad"),
    (Column::GyroAngle, "rad"),
    (Column::MotorTorque, "nm"),
    (Column::GimbalAngle, "rad"),
];
const NEEDED: usize = 3;

impl Order {
    /// `xyz`
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}`: write each of x, y and z once, from the outside in: xyz, zyx");
        let axis = |letter: char| platform::Axis::ALL.into_iter().find(|axis| axis.letter() == letter);
        let axes: Vec<platform::Axis> = text.chars().map(axis).collect::<Option<_>>().ok_or_else(wrong)?;
        let axes: [platform::Axis; 3] = axes.try_into().map_err(|_| wrong())?;
        if axes[0] == axes[1] || axes[1] == axes[2] || axes[2] == axes[0] { Err(wrong()) } else { Ok(Self(axes)) }
    }
}

fn name(column: Column, axis: platform::Axis) -> String {
    format!("{}_{}", column.name(), axis.letter())
}

/// Whether a log has three axes: whether theta or the rate is there with an axis' suffix. A pipe has one.
pub(super) fn is_three_axes(path: &Path) -> Result<bool, Failure> {
    if !path.is_file() {
        return Ok(false);
    }
    let names = header(path)?;
    let suffixed = |column| platform::Axis::ALL.into_iter().any(|axis| names.contains(&name(column, axis)));
    Ok(suffixed(Column::GyroAngle) || suffixed(Column::VehicleRate))
}

fn header(path: &Path) -> Result<Vec<String>, LogError> {
    import::header_names(open(path)?, path)
}

fn open(path: &Path) -> Result<File, LogError> {
    File::open(path).map_err(|error| LogError::unreadable(path, error))
}

/// Estimates what the command line says.
pub(super) fn course(args: &Args, model: &ModelFile) -> Result<Course, Failure> {
    let names = header(&args.log)?;
    let read = |axis| axis_log(&args.log, &names, axis);
    let [x, y, z] = platform::Axis::ALL;
    let logs = [read(x)?, read(y)?, read(z)?];
    with_rows(&logs[0], args)?;
    let config = config(&logs, model, args.gimbals);
    let course = match args.number {
        Number::F32 => estimated::<f32>(&config, &logs),
        Number::Fixed => estimated::<Fixed>(&config, &logs),
    };
    course.map_err(|error| refused(args, &error))
}

/// The log as that of one axis.
fn axis_log(path: &Path, names: &[String], axis: platform::Axis) -> Result<Log, Failure> {
    let shared = [Column::Time, Column::AccelX, Column::AccelY, Column::AccelZ];
    let shared = shared
        .into_iter()
        .zip(["s", "mps2", "mps2", "mps2"])
        .map(|(column, unit)| (column, unit, column.name().to_owned()));
    let there = |(index, (column, unit)): (usize, &(Column, &'static str))| {
        let name = name(*column, axis);
        (index < NEEDED || names.contains(&name)).then_some((*column, *unit, name))
    };
    let own = EACH.iter().enumerate().filter_map(there);
    let source =
        |(column, unit, name): (Column, &str, String)| (column, Source { name, unit: unit.to_owned(), sign: 1.0 });
    Ok(import::read(open(path)?, path, &ColumnMap(shared.chain(own).map(source).collect()))?)
}

/// Three gimbals alike, with the gyros' cross coupling; each with the sensors that its columns show.
fn config(logs: &[Log; 3], model: &ModelFile, Order(order): Order) -> platform::Config {
    let mut servo = model.config;
    servo.period_s = logs[0].time.period_s;
    servo.gyro.cross_coupling = true;
    platform::Config {
        gimbals: order.map(|axis| {
            let log = &logs[axis.index()];
            let angles = log.column(Column::GyroAngle).unwrap_or_default();
            let estimator = settings(&model.tolerance, angles, log.column(Column::MotorTorque).is_some());
            Gimbal { axis, servo, estimator }
        }),
    }
}

fn estimated<N: System>(config: &platform::Config, logs: &[Log; 3]) -> Result<Course, BuildError> {
    let law = config.build::<N>()?;
    let mut state = law.start();
    let rows = rows(logs);
    let mut angles = [const { (Vec::new(), Vec::new()) }; 3];
    let mut flags = Vec::with_capacity(rows.len());
    let cells = |column: Column, k: usize| logs.each_ref().map(|log| log.column(column).map(|values| values[k]));
    for (k, row) in rows.iter().enumerate() {
        law.step(&mut state, &law.input(row));
        let measured = law.measured(cells(Column::GyroAngle, k), cells(Column::MotorTorque, k));
        let estimate = law.estimate(&mut state, &measured);
        let (angle, bound) = (law.angle_rad(estimate.attitude_error_rad), law.angle_rad(estimate.bound_rad));
        for ((angles, bounds), (angle, bound)) in angles.iter_mut().zip(angle.into_iter().zip(bound)) {
            angles.push(angle);
            bounds.push(bound);
        }
        flags.push(estimate.flags);
    }
    let (truths, measured) = truth(config, logs, &rows)?;
    let axes = angles.into_iter().zip(truths).zip([" about x", " about y", " about z"]);
    Ok(Course {
        times_s: logs[0].column(Column::Time).unwrap_or_default().to_vec(),
        period_s: law.period_s(),
        axes: axes
            .map(|(((angle_rad, bound_rad), truth_rad), suffix)| Axis { suffix, truth_rad, angle_rad, bound_rad })
            .collect(),
        flags,
        accels_mps2: rows.iter().map(|row| row.accel_mps2).collect(),
        measured,
        velocity_correction_mps: law.velocity_correction_mps(&state),
    })
}

/// phi by axis, and whether it is the log's own.
fn truth(config: &platform::Config, logs: &[Log; 3], rows: &[Input<f64>]) -> Result<([Vec<f64>; 3], bool), BuildError> {
    if let [Some(x), Some(y), Some(z)] = logs.each_ref().map(|log| log.column(Column::GimbalAngle)) {
        return Ok(([x.to_vec(), y.to_vec(), z.to_vec()], true));
    }
    let platform = Platform::new(config)?.with_tolerance(1e-8);
    let mut truths = [const { Vec::new() }; 3];
    for sample in platform.run(rows.iter().copied()) {
        for (truth, angle) in truths.iter_mut().zip(sample.attitude_error_rad) {
            truth.push(angle);
        }
    }
    Ok((truths, false))
}

/// Inputs of each row.
fn rows(logs: &[Log; 3]) -> Vec<Input<f64>> {
    let accels = [Column::AccelX, Column::AccelY, Column::AccelZ];
    let accels = accels.map(|column| kept(logs[0].column(column).unwrap_or_default()));
    let of_each = |column: Column| logs.each_ref().map(|log| kept(log.column(column).unwrap_or_default()));
    let (rates, angles) = (of_each(Column::VehicleRate), of_each(Column::RelativeAngle));
    let at = |columns: &[Vec<f64>; 3], k: usize| columns.each_ref().map(|values| values[k]);
    (0..logs[0].len())
        .map(|k| Input {
            accel_mps2: at(&accels, k),
            vehicle_rate_radps: at(&rates, k),
            gimbal_angle_rad: at(&angles, k),
            torque_nm: [0.0; 3],
        })
        .collect()
}
