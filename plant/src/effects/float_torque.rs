//! `float_torque` and `g_sensitive_float_torque`: torques on the gyro's float, which are drift of the platform.
//!
//! ```text
//! Jo theta'' = H (phi' + theta w_x) + M + c a_x - Bo theta'
//! ```
//!
//! `float_torque` is M, `g_sensitive_float_torque` is c. On a stop they act on the float as `H phi'` does. The loop
//! keeps theta still, so that phi drifts at `-(M + c a_x) / H`.
//!
//! Block `gyro`. Change `gyro_angle_rad`, `motor_torque_nm` in passing, and `gimbal_angle_rad` lastingly.

use super::Altered;
use crate::row::Row;

/// Both torques.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct FloatTorque {
    constant_nm: f64,
    per_accel_kg_m: f64,
}

impl FloatTorque {
    pub(crate) fn torque_nm(&self, row: &Row) -> f64 {
        self.constant_nm + self.per_accel_kg_m * row.accel_x_mps2
    }
}

pub(super) fn constant(values: &[f64], altered: &mut Altered) {
    altered.laws.float.constant_nm += values[0];
}

pub(super) fn g_sensitive(values: &[f64], altered: &mut Altered) {
    altered.laws.float.per_accel_kg_m += values[0];
}
