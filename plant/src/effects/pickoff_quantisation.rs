//! `pickoff_quantisation`: the pick-off resolves steps.
//!
//! ```text
//! seen = q round(theta / q)
//! ```
//!
//! Block `servo`; F(s) acts on the angle seen, and the log holds it. Changes `gyro_angle_rad`, `motor_torque_nm`
//! and the angles of the gimbal. F(s) turns a step q at once into a slope of the torque, so that a coarse pick-off
//! keeps the loop in a limit cycle.

use super::Altered;

/// The cell that holds theta, as a whole number.
pub(crate) fn cell(step_rad: f64, theta_rad: f64) -> f64 {
    if step_rad > 0.0 { (theta_rad / step_rad).round() } else { 0.0 }
}

/// The angle seen.
pub(crate) fn seen_rad(step_rad: f64, cell: f64, theta_rad: f64) -> f64 {
    if step_rad > 0.0 { cell * step_rad } else { theta_rad }
}

pub(super) fn apply(values: &[f64], altered: &mut Altered) {
    altered.laws.pickoff_step_rad = values[0];
}
