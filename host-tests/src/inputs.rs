//! Rows of input that tests share.

use std::f64::consts::TAU;

use gimbal_plant::Row;
use gimbal_servo::paper::{DYNE_CM_NM, STANDARD_GRAVITY_MPS2};
use gimbal_servo::{Config, Interpolation};

use crate::random::Random;

/// Rows in a time, the one at its end included.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of rows")]
pub fn rows_in(time_s: f64, period_s: f64) -> usize {
    (time_s / period_s).round() as usize + 1
}

/// A torque from the first row on.
#[must_use]
pub fn torque_step(dyne_cm: f64, time_s: f64, period_s: f64) -> Vec<Row> {
    vec![Row { torque_nm: dyne_cm * DYNE_CM_NM, ..Row::default() }; rows_in(time_s, period_s)]
}

/// A torque from the first row until `off_s`, for inputs held from row to row.
#[must_use]
pub fn torque_pulse(dyne_cm: f64, off_s: f64, time_s: f64, period_s: f64) -> Vec<Row> {
    let mut rows = torque_step(dyne_cm, time_s, period_s);
    rows[rows_in(off_s, period_s) - 1..].fill(Row::default());
    rows
}

/// The paper's profile: 10 s, the acceleration `(0, a, 0)` for the first 5 s, rate zero.
#[must_use]
pub fn unbalance_profile(accel_g: f64, period_s: f64) -> Vec<Row> {
    let on = rows_in(5.0, period_s) - 1;
    let accel = |k| if k < on { accel_g * STANDARD_GRAVITY_MPS2 } else { 0.0 };
    (0..rows_in(10.0, period_s)).map(|k| Row { accel_y_mps2: accel(k), ..Row::default() }).collect()
}

/// The same acceleration, the vehicle's rate +-0.1 rad/s, positive first, reversed every 2 s.
#[must_use]
pub fn friction_profile(accel_g: f64, period_s: f64) -> Vec<Row> {
    let mut rows = unbalance_profile(accel_g, period_s);
    let half = rows_in(2.0, period_s) - 1;
    for (k, row) in rows.iter_mut().enumerate() {
        row.vehicle_rate_radps = if (k / half).is_multiple_of(2) { 0.1 } else { -0.1 };
    }
    rows
}

/// A sine of torque whose frequency rises from 0.1 to 200 Hz over the run.
#[must_use]
pub fn torque_chirp(peak_nm: f64, count: usize, period_s: f64) -> Vec<f64> {
    let time_s = count as f64 * period_s;
    let growth = (200.0_f64 / 0.1).ln();
    let phase = |t: f64| TAU * 0.1 * time_s / growth * ((growth * t / time_s).exp() - 1.0);
    (0..count).map(|k| peak_nm * phase(k as f64 * period_s).sin()).collect()
}

/// A torque that jumps at random, three times a second on average.
#[must_use]
pub fn torque_jumps(peak_nm: f64, count: usize, period_s: f64, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let mut torque = 0.0;
    let jump = |random: &mut Random| random.between(0.0, 1.0) < 3.0 * period_s;
    (0..count)
        .map(|k| {
            if k == 0 || jump(&mut random) {
                torque = random.between(-peak_nm, peak_nm);
            }
            torque
        })
        .collect()
}

/// Torques as rows.
#[must_use]
pub fn torques(torques_nm: &[f64]) -> Vec<Row> {
    torques_nm.iter().map(|&torque_nm| Row { torque_nm, ..Row::default() }).collect()
}

/// A vehicle that boosts at 12 g, coasts and turns, rolling to and fro, with sensor noise on every channel.
#[must_use]
pub fn manoeuvre(time_s: f64, period_s: f64, seed: u64) -> Vec<Row> {
    let mut random = Random::new(seed);
    let g = STANDARD_GRAVITY_MPS2;
    (0..rows_in(time_s, period_s))
        .map(|k| {
            let t = k as f64 * period_s;
            // Boost between 1 s and 4 s with soft edges.
            let boost = 0.5 * ((8.0 * (t - 1.0)).tanh() - (8.0 * (t - 4.0)).tanh());
            let shake = 1.0 + 0.1 * (TAU * 37.0 * t).sin();
            let mut noise = |size: f64| size * random.normal();
            Row {
                accel_x_mps2: g * (0.3 + 2.0 * boost * (TAU * 0.7 * t).sin()) + noise(0.05),
                accel_y_mps2: g * 12.0 * boost * shake + noise(0.05),
                accel_z_mps2: g * (1.0 + 3.0 * boost * (TAU * 0.4 * t).cos()) + noise(0.05),
                vehicle_rate_radps: 2.5 * (TAU * 0.45 * t).sin() + noise(2e-3),
                ..Row::default()
            }
        })
        .collect()
}

/// A configuration on which torques act alone: no friction, no unbalance.
#[must_use]
pub fn bare(config: Config) -> Config {
    config.without_friction().without_unbalance()
}

/// The configuration with its inputs held from row to row.
#[must_use]
pub fn held(mut config: Config) -> Config {
    config.interpolation = Interpolation::Held;
    config
}

/// The configuration at another period.
#[must_use]
pub fn at_period(mut config: Config, period_s: f64) -> Config {
    config.period_s = period_s;
    config
}
