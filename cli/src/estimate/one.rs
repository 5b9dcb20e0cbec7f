//! A log of one axis.

use gimbal_log::{Column, Log};
use gimbal_model_file::ModelFile;
use gimbal_plant::{Plant, Row};
use gimbal_servo::{BuildError, Config, Input, Number};

use super::{Axis, Course, kept, settings};

/// Estimates all rows.
pub(super) fn course<N: Number>(log: &Log, model: &ModelFile) -> Result<Course, BuildError> {
    let config = Config { period_s: log.time.period_s, ..model.config };
    let rows = rows(log);
    let angles = log.column(Column::GyroAngle).unwrap_or_default();
    let torques = log.column(Column::MotorTorque);
    let settings = settings(&model.tolerance, angles, torques.is_some());
    let (axis, law) = (config.build::<N>()?, settings.build::<N>(&config)?);
    let (mut state, mut estimator) = (axis.start(), law.start());
    let (mut angle_rad, mut bound_rad, mut flags) = (Vec::new(), Vec::new(), Vec::new());
    for (index, row) in rows.iter().enumerate() {
        let input = Input {
            accel_x_mps2: row.accel_x_mps2,
            accel_y_mps2: row.accel_y_mps2,
            accel_z_mps2: row.accel_z_mps2,
            vehicle_rate_radps: row.vehicle_rate_radps,
            ..Input::default()
        };
        let output = axis.step(&mut state, axis.units().input(&input));
        let measured = law.measured(angles.get(index).copied(), torques.map(|torques| torques[index]));
        let estimate = law.si(&law.step(&mut estimator, &measured, &axis, &state, output.faults));
        angle_rad.push(estimate.gimbal_angle_rad);
        bound_rad.push(estimate.bound_rad);
        flags.push(estimate.flags);
    }
    let (truth_rad, measured) = truth(log, &config, &rows)?;
    let [x, y] = law.velocity_correction_mps(&estimator);
    Ok(Course {
        times_s: log.column(Column::Time).unwrap_or_default().to_vec(),
        period_s: config.period_s,
        axes: vec![Axis { suffix: "", truth_rad, angle_rad, bound_rad }],
        flags,
        accels_mps2: rows.iter().map(|row| [row.accel_x_mps2, row.accel_y_mps2, row.accel_z_mps2]).collect(),
        measured,
        velocity_correction_mps: [x, y, 0.0],
    })
}

/// phi, and whether it is the log's own.
fn truth(log: &Log, config: &Config, rows: &[Row]) -> Result<(Vec<f64>, bool), BuildError> {
    if let Some(angles) = log.column(Column::GimbalAngle) {
        return Ok((angles.to_vec(), true));
    }
    let plant = Plant::new(config)?.with_tolerance(1e-8);
    Ok((plant.run(rows.iter().copied()).map(|sample| sample.gimbal_angle_rad).collect(), false))
}

/// Inputs of each row.
fn rows(log: &Log) -> Vec<Row> {
    let columns = [Column::AccelX, Column::AccelY, Column::AccelZ, Column::VehicleRate];
    let [x, y, z, rate] = columns.map(|column| kept(log.column(column).unwrap_or_default()));
    (0..log.len())
        .map(|k| Row {
            accel_x_mps2: x[k],
            accel_y_mps2: y[k],
            accel_z_mps2: z[k],
            vehicle_rate_radps: rate[k],
            ..Row::default()
        })
        .collect()
}
