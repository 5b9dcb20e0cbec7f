//! `viscous_friction` and `quadratic_drag`: torques that grow with the rate.
//!
//! ```text
//! viscous_friction   b w_rel
//! quadratic_drag     b w_rel |w_rel|
//! ```
//!
//! Block `friction`; added to `T_f` outside the clamp, bearings present or not. Changes `gyro_angle_rad`,
//! `motor_torque_nm` and the angles of the gimbal.

use super::Altered;

/// Both coefficients.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Drag {
    linear_nm_s: f64,
    pub(crate) quadratic_nm_s2: f64,
}

impl Drag {
    pub(crate) fn torque_nm(&self, relative_rate_radps: f64) -> f64 {
        (self.linear_nm_s + self.quadratic_nm_s2 * relative_rate_radps.abs()) * relative_rate_radps
    }
}

pub(super) fn viscous_friction(values: &[f64], altered: &mut Altered) {
    altered.laws.drag.linear_nm_s += values[0];
}

pub(super) fn quadratic_drag(values: &[f64], altered: &mut Altered) {
    altered.laws.drag.quadratic_nm_s2 += values[0];
}
