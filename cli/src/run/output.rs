//! A run as a CSV file: inputs, what the model makes of them, and what the log held beside.

use std::io;
use std::path::{Path, PathBuf};

use gimbal_log::{AtomicFile, Batch, Column, TableWriter};
use gimbal_servo::Input;

use super::model::Sample;
use crate::exit::Failure;

/// Columns that every run has.
const COMPUTED: [&str; 16] = [
    "time_s",
    "accel_x_mps2",
    "accel_y_mps2",
    "accel_z_mps2",
    "vehicle_rate_radps",
    "gimbal_angle_rad",
    "gyro_angle_rad",
    "motor_torque_nm",
    "friction_torque_nm",
    "unbalance_torque_nm",
    "stop",
    "velocity_error_x_mps",
    "velocity_error_y_mps",
    "position_error_x_m",
    "position_error_y_m",
    "faults",
];

/// A file under way.
pub(crate) struct Output {
    path: PathBuf,
    writer: TableWriter<AtomicFile>,
    /// Columns of the contract that are carried through.
    carried: Vec<Column>,
    extras: usize,
}

impl Output {
    /// Starts a file; `columns` and `extras` are those of the log, if there is one.
    pub(crate) fn create(path: &Path, columns: &[Column], extras: &[String]) -> Result<Self, Failure> {
        let file = AtomicFile::create(path).map_err(Failure::write(path))?;
        // The five that drive the model are written as it took them.
        let carried: Vec<Column> = columns.iter().copied().filter(|column| column.index() > 4).collect();
        let others = carried.iter().map(|column| column.name()).chain(extras.iter().map(String::as_str));
        let mut names: Vec<String> = COMPUTED.map(str::to_owned).to_vec();
        for name in others {
            let taken = names.iter().any(|known| known == name);
            names.push(if taken { format!("logged_{name}") } else { name.to_owned() });
        }
        let writer = TableWriter::new(file, names.iter().map(String::as_str)).map_err(Failure::write(path))?;
        Ok(Self { path: path.to_owned(), writer, carried, extras: extras.len() })
    }

    /// Writes a row; `source` is the row of the log that it comes from.
    pub(crate) fn row(
        &mut self,
        time_s: f64,
        input: &Input<f64>,
        sample: &Sample,
        source: Option<(&Batch, usize)>,
    ) -> Result<(), Failure> {
        for value in [
            time_s,
            input.accel_x_mps2,
            input.accel_y_mps2,
            input.accel_z_mps2,
            input.vehicle_rate_radps,
            sample.gimbal_angle_rad,
            sample.gyro_angle_rad,
            sample.motor_torque_nm,
            sample.friction_torque_nm,
            sample.unbalance_torque_nm,
            f64::from(sample.stop),
            sample.velocity_error_mps[0],
            sample.velocity_error_mps[1],
            sample.position_error_m[0],
            sample.position_error_m[1],
            f64::from(sample.faults.bits()),
        ] {
            self.writer.number(value);
        }
        for column in &self.carried {
            self.writer.number(source.map_or(f64::NAN, |(batch, row)| batch.rows()[row][*column]));
        }
        if let Some((batch, row)) = source {
            for cell in batch.extras(row) {
                self.writer.text(cell);
            }
        } else {
            for _ in 0..self.extras {
                self.writer.text("");
            }
        }
        self.writer.end_row().map_err(|error| Failure::write(&self.path)(error))
    }

    /// Lets the file appear.
    pub(crate) fn commit(self) -> Result<PathBuf, Failure> {
        let write = |error: io::Error| Failure::write(&self.path)(error);
        self.writer.finish().and_then(AtomicFile::commit).map_err(write)?;
        Ok(self.path)
    }
}
