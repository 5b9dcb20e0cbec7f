//! The recorded rocket flight as rows of the model, resampled to 1 kHz by straight lines.
//!
//! x of the rocket lies along its length. The roll gimbal's axis is the one that spins, z = rocket x: the launch load
//! is axial, the rate reaches 800 deg/s. The pitch gimbal's axis is z = rocket y: the launch load is radial.

use std::path::PathBuf;

use gimbal_plant::Row;
use gimbal_servo::paper::DEGREE_RAD;

/// Which axis of the rocket is the gimbal's z; x and y follow cyclically.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Gimbal {
    /// z = rocket x.
    Roll,
    /// z = rocket y.
    Pitch,
}

/// Where the recording is looked for.
#[must_use]
pub fn path() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/real/rocket/irec_2023_easymega.csv"))
}

/// The flight at 1 kHz, at most `time_s` of it from half a second before launch; `None` if the file is not there.
///
/// # Panics
/// If the file is not the recording.
#[must_use]
pub fn flight(gimbal: Gimbal, time_s: f64) -> Option<Vec<Row>> {
    let text = std::fs::read_to_string(path()).ok()?;
    let mut points: Vec<(f64, Row)> = Vec::new();
    let names: Vec<&str> = text.lines().next()?.split(',').collect();
    let column = |name: &str| names.iter().position(|&other| other == name).expect("a column of the recording");
    let places = ["time", "accel_x", "accel_y", "accel_z", "gyro_roll", "gyro_pitch"].map(column);
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [time_s, x, y, z, roll, pitch] = places.map(|place| cells[place].parse::<f64>().expect("a number"));
        let row = match gimbal {
            Gimbal::Roll => Row {
                accel_x_mps2: y,
                accel_y_mps2: z,
                accel_z_mps2: x,
                vehicle_rate_radps: roll * DEGREE_RAD,
                ..Row::default()
            },
            Gimbal::Pitch => Row {
                accel_x_mps2: z,
                accel_y_mps2: x,
                accel_z_mps2: y,
                vehicle_rate_radps: pitch * DEGREE_RAD,
                ..Row::default()
            },
        };
        // Some time stamps repeat: the first of them stands.
        if points.last().is_none_or(|last| time_s > last.0) {
            points.push((time_s, row));
        }
    }
    let start_s = points[0].0;
    let end_s = points[points.len() - 1].0.min(start_s + time_s);
    let mut rows = Vec::new();
    let mut next = 1;
    loop {
        let t = start_s + rows.len() as f64 * 1e-3;
        if t > end_s {
            return Some(rows);
        }
        while points[next].0 < t && next + 1 < points.len() {
            next += 1;
        }
        let ((from_s, from), (to_s, to)) = (&points[next - 1], &points[next]);
        rows.push(from.toward(to, (t - from_s) / (to_s - from_s)));
    }
}
