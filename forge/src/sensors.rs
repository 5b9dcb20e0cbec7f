//! The instruments: what is logged of the inputs and of the platform, with noise, quantisation and misalignment.

use core::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::draw::Draw;
use crate::track::{Row, Track};

/// Errors that do not change from row to row.
#[derive(Debug, Clone)]
pub struct Sensors {
    /// Pick-off scale.
    pub pickoff_scale: f64,
    /// Pick-off bias [rad].
    pub pickoff_bias_rad: f64,
    /// Step of a quantised pick-off [rad].
    pub pickoff_step_rad: Option<f64>,
    /// Scale of the torque measurement.
    pub torque_scale: f64,
    /// Bias of the torque measurement [N m].
    pub torque_bias_nm: f64,
    /// Accelerations and rates are logged late by this [s].
    pub skew_s: f64,
    /// Small turns of the accelerometers about x, y, z [rad].
    pub misalignment_rad: [f64; 3],
}

impl Default for Sensors {
    fn default() -> Self {
        Self {
            pickoff_scale: 1.0,
            pickoff_bias_rad: 0.0,
            pickoff_step_rad: None,
            torque_scale: 1.0,
            torque_bias_nm: 0.0,
            skew_s: 0.0,
            misalignment_rad: [0.0; 3],
        }
    }
}

impl Sensors {
    /// Whether the logged inputs differ from the true ones, noise aside.
    #[must_use]
    pub fn changes_inputs(&self) -> bool {
        self.skew_s != 0.0 || self.misalignment_rad.iter().any(|turn| *turn != 0.0)
    }

    /// The logged inputs without noise.
    #[must_use]
    pub fn logged(&self, track: &Track) -> Track {
        let [about_x, about_y, about_z] = self.misalignment_rad;
        let rows = (0..track.rows.len())
            .map(|index| {
                let mut row = track.at(index as f64 * track.period_s - self.skew_s);
                let [x, y, z] = row.accel_mps2;
                row.accel_mps2 =
                    [x + about_z * y - about_y * z, y - about_z * x + about_x * z, z + about_y * x - about_x * y];
                // neither is measured with the rest
                row.external_nm = track.rows[index].external_nm;
                row.temperature_c = track.rows[index].temperature_c;
                row
            })
            .collect();
        Track { period_s: track.period_s, rows }
    }
}

/// Noise and least counts of one corpus log.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Noise {
    /// White noise of the pick-off [rad].
    pub gyro_angle_rad: f64,
    /// White noise of the motor torque [N m].
    pub motor_torque_nm: f64,
    /// White noise of the outside reference [rad].
    pub gimbal_angle_rad: f64,
    /// White noise of the resolver [rad].
    pub relative_angle_rad: f64,
    /// White noise of the accelerometers [m/s2].
    pub accel_mps2: f64,
    /// White noise of the rate sensors [rad/s].
    pub rate_radps: f64,
    /// Coloured noise of pick-off and torque over their white noise.
    pub coloured: f64,
    /// Corner of the coloured noise [Hz].
    pub corner_hz: f64,
    /// Whether the servo takes the pick-off's noise for motion, and shakes the gimbal with it.
    #[serde(default)]
    pub in_loop: bool,
}

/// Least counts [rad, N m, m/s2, rad/s]: pick-off, torque, accelerometer, rate sensor, all angles.
const COUNTS: [f64; 4] = [1e-8, 5e-7, 5e-4, 1e-6];

impl Noise {
    /// Draws the instruments' quality: a factor of two to either side.
    #[must_use]
    pub fn draw(draw: &mut Draw) -> Self {
        let mut around = |typical: f64| draw.log_uniform(0.5 * typical, 2.0 * typical);
        Self {
            gyro_angle_rad: around(3e-7),
            motor_torque_nm: around(2e-5),
            gimbal_angle_rad: around(2e-6),
            relative_angle_rad: around(2e-5),
            accel_mps2: around(5e-3),
            rate_radps: around(2e-5),
            coloured: if draw.chance(0.5) { draw.uniform(0.2, 1.0) } else { 0.0 },
            corner_hz: draw.log_uniform(0.5, 20.0),
            in_loop: draw.chance(0.25),
        }
    }

    /// Noise on inputs, rounded to the least counts.
    #[must_use]
    pub fn on_inputs(&self, track: &Track, draw: &mut Draw) -> Track {
        let mut noisy = |value: f64, noise: f64, count: f64| rounded(value + noise * draw.normal(), count);
        let rows = track
            .rows
            .iter()
            .map(|row| Row {
                accel_mps2: row.accel_mps2.map(|value| noisy(value, self.accel_mps2, COUNTS[2])),
                rate_radps: noisy(row.rate_radps, self.rate_radps, COUNTS[3]),
                cross_rate_radps: noisy(row.cross_rate_radps, self.rate_radps, COUNTS[3]),
                external_nm: 0.0,
                temperature_c: noisy(row.temperature_c, 0.05, 0.0625),
            })
            .collect();
        Track { period_s: track.period_s, rows }
    }

    /// White and coloured noise of standard deviation `white`, one value a row.
    #[must_use]
    pub fn series(&self, white: f64, rows: usize, period_s: f64, draw: &mut Draw) -> Vec<f64> {
        let keep = libm::exp(-2.0 * PI * self.corner_hz * period_s);
        let drive = self.coloured * libm::sqrt(1.0 - keep * keep);
        let mut coloured = self.coloured * draw.normal();
        (0..rows)
            .map(|_| {
                coloured = keep * coloured + drive * draw.normal();
                white * (draw.normal() + coloured)
            })
            .collect()
    }
}

/// The nearest multiple of `count`.
#[must_use]
pub fn rounded(value: f64, count: f64) -> f64 {
    libm::round(value / count) * count
}

/// Rounds to a quantised pick-off's step, or to the pick-off's least count.
#[must_use]
pub fn pickoff_rounded(sensors: &Sensors, value: f64) -> f64 {
    rounded(value, sensors.pickoff_step_rad.unwrap_or(COUNTS[0]))
}

/// Rounds to the least count of the torque measurement.
#[must_use]
pub fn torque_rounded(value: f64) -> f64 {
    rounded(value, COUNTS[1])
}
