//! The flight of a real sounding rocket as input, from the CSV export of its flight computer.
//!
//! Rows are about 100 a second, some times repeat and some are missing: rows whose time does not rise are left out,
//! the rest is joined by straight lines.

use gimbal_servo::paper::DEGREE_RAD;

use super::PERIOD_S;
use crate::draw::Draw;
use crate::track::{Row, Track};

/// Accelerations along the body [m/s2], rates about it [rad/s].
#[derive(Debug, Clone)]
pub struct Rocket {
    times_s: Vec<f64>,
    accel_mps2: Vec<[f64; 3]>,
    rates_radps: Vec<[f64; 3]>,
}

impl Rocket {
    /// Reads the export.
    ///
    /// # Errors
    /// The line and what is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut lines = text.lines().enumerate();
        let header: Vec<&str> = lines.next().ok_or("the file is empty")?.1.split(',').collect();
        let place = |name: &str| {
            header.iter().position(|column| *column == name).ok_or_else(|| format!("line 1: no column `{name}`"))
        };
        let columns = [
            place("time")?,
            place("accel_x")?,
            place("accel_y")?,
            place("accel_z")?,
            place("gyro_roll")?,
            place("gyro_pitch")?,
            place("gyro_yaw")?,
        ];
        let mut flight = Self { times_s: Vec::new(), accel_mps2: Vec::new(), rates_radps: Vec::new() };
        for (line, text) in lines {
            let cells: Vec<&str> = text.split(',').collect();
            let mut values = [0.0; 7];
            for (value, column) in values.iter_mut().zip(columns) {
                let cell = cells.get(column).copied().unwrap_or("");
                *value = cell.parse().map_err(|_| format!("line {}: `{cell}` is not a number", line + 1))?;
            }
            let [time_s, x, y, z, roll, pitch, yaw] = values;
            if flight.times_s.last().is_none_or(|last| time_s > *last) {
                flight.times_s.push(time_s);
                flight.accel_mps2.push([x, y, z]);
                flight.rates_radps.push([roll, pitch, yaw].map(|rate| rate * DEGREE_RAD));
            }
        }
        if flight.times_s.len() < 2 { Err("fewer than two rows".to_owned()) } else { Ok(flight) }
    }

    fn at(&self, time_s: f64) -> ([f64; 3], [f64; 3]) {
        let next = self.times_s.partition_point(|time| *time <= time_s).clamp(1, self.times_s.len() - 1);
        let (from_s, to_s) = (self.times_s[next - 1], self.times_s[next]);
        let part = ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
        let mix = |list: &[[f64; 3]]| {
            core::array::from_fn(|axis| list[next - 1][axis] + part * (list[next][axis] - list[next - 1][axis]))
        };
        (mix(&self.accel_mps2), mix(&self.rates_radps))
    }

    /// A piece of the flight that holds the boost, with the gimbal axis along the roll, pitch or yaw axis.
    pub(super) fn track(&self, rows: usize, draw: &mut Draw) -> Track {
        let from_s = self.times_s[0] + draw.uniform(-1.0, 0.5);
        // body axes that become x, y, z of the platform, right-handed
        let [x, y, z] = draw.pick(&[[1, 2, 0], [2, 0, 1], [0, 1, 2]]);
        super::track_of(rows, |index| {
            let (accel, rates) = self.at(from_s + index as f64 * PERIOD_S);
            Row {
                accel_mps2: [accel[x], accel[y], accel[z]],
                rate_radps: rates[z],
                cross_rate_radps: rates[x],
                ..Row::default()
            }
        })
    }
}
