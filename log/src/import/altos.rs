//! `AltOS` CSV, the export of Altus Metrum flight computers.
//!
//! Body axes there: x along the rocket, y and z across it; roll, pitch and yaw are the rates about x, y and z.
//! Whichever body axis is the gimbal's, gimbal axes are a rotation of body axes: determinant +1.

use super::map::{ColumnMap, Source};
use crate::{Column, Log};

/// The axis of the vehicle along which the gimbal axis z lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GimbalAxis {
    /// Along the rocket: spin about the gimbal axis, thrust along it.
    Roll,
    /// Across the rocket: thrust normal to the gimbal axis, on the lever of the unbalance.
    #[default]
    Pitch,
    /// Across the rocket, the other way.
    Yaw,
}

/// Columns of an `AltOS` file that decide that it is one.
const SIGNATURE: [&str; 8] =
    ["time", "accel_x", "accel_y", "accel_z", "gyro_roll", "gyro_pitch", "gyro_yaw", "state_name"];

/// Whether a header is that of an `AltOS` file.
#[must_use]
pub fn is_altos(names: &[String]) -> bool {
    SIGNATURE.iter().all(|wanted| names.iter().any(|name| name == wanted))
}

/// Rate about the vehicle's x axis [rad/s], where no column of the log takes it.
#[must_use]
pub fn roll_rate_radps(log: &Log) -> Option<Vec<f64>> {
    let extra = log.extras().iter().find(|extra| extra.name == "gyro_roll")?;
    Some(extra.numbers().into_iter().map(f64::to_radians).collect())
}

impl GimbalAxis {
    /// The column map for this axis.
    ///
    /// ```text
    /// roll    (x, y, z)_gimbal = ( y, z, x)_body
    /// pitch   (x, y, z)_gimbal = ( z, x, y)_body
    /// yaw     (x, y, z)_gimbal = (-y, x, z)_body
    /// ```
    ///
    /// For pitch and yaw the thrust is along the gimbal's y, so that it acts on the paper's unbalance u = (`u_x`, 0).
    #[must_use]
    pub fn column_map(self) -> ColumnMap {
        let axes = self.body_axes();
        let accel = ["accel_x", "accel_y", "accel_z"];
        let rate = ["gyro_roll", "gyro_pitch", "gyro_yaw"];
        let source = |names: [&str; 3], (axis, sign): (usize, f64), unit: &str| Source {
            name: names[axis].to_owned(),
            unit: unit.to_owned(),
            sign,
        };
        ColumnMap(vec![
            (Column::Time, Source { name: "time".to_owned(), unit: "s".to_owned(), sign: 1.0 }),
            (Column::AccelX, source(accel, axes[0], "mps2")),
            (Column::AccelY, source(accel, axes[1], "mps2")),
            (Column::AccelZ, source(accel, axes[2], "mps2")),
            (Column::VehicleRate, source(rate, axes[2], "dps")),
            (Column::CrossRate, source(rate, axes[0], "dps")),
            (Column::Temperature, Source { name: "temperature".to_owned(), unit: "c".to_owned(), sign: 1.0 }),
        ])
    }

    /// Body axis (0 x, 1 y, 2 z) and sign of each gimbal axis.
    fn body_axes(self) -> [(usize, f64); 3] {
        match self {
            Self::Roll => [(1, 1.0), (2, 1.0), (0, 1.0)],
            Self::Pitch => [(2, 1.0), (0, 1.0), (1, 1.0)],
            Self::Yaw => [(1, -1.0), (0, 1.0), (2, 1.0)],
        }
    }
}

impl ColumnMap {
    /// Leaves out columns that a file does not have and that no model needs.
    #[must_use]
    pub fn without_absent_temperature(mut self, names: &[String]) -> Self {
        self.0.retain(|(column, source)| *column != Column::Temperature || names.contains(&source.name));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::GimbalAxis;

    #[test]
    fn closed_form_gimbal_axes_are_right_handed() {
        for axis in [GimbalAxis::Roll, GimbalAxis::Pitch, GimbalAxis::Yaw] {
            let mut rows = [[0.0_f64; 3]; 3];
            for (row, (body, sign)) in rows.iter_mut().zip(axis.body_axes()) {
                row[body] = sign;
            }
            let [a, b, c] = rows;
            let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            let determinant: f64 = cross.iter().zip(c).map(|(x, y)| x * y).sum();
            assert!((determinant - 1.0).abs() < 1e-15, "{axis:?}");
        }
    }
}
