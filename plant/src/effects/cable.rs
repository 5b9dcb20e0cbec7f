//! `cable_spring` and `cable_hysteresis`: what wires over the gimbal axis do.
//!
//! ```text
//! cable_spring       k rel
//! cable_hysteresis   T z        dz/d rel = (1 - z^2 (1 + sgn(w_rel z)) / 2) / x_y
//! ```
//!
//! The second is the Bouc-Wen model with exponent 2 and equal shape factors: a loop in rel that does not depend on
//! the rate, with the torque T at its ends and the initial stiffness `T / x_y`.
//!
//! Block `disturbance`; rel is zero at the first row. Change `gyro_angle_rad`, `motor_torque_nm` and the angles of
//! the gimbal.
//!
//! Source: Y. K. Wen, *Method for random vibration of hysteretic systems*, J. Eng. Mech. 102 (EM2), 1976.

use super::Altered;

/// A linear spring.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Spring {
    pub(crate) stiffness_nm_per_rad: f64,
}

/// A Bouc-Wen loop.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hysteresis {
    pub(crate) torque_nm: f64,
    displacement_rad: f64,
}

impl Hysteresis {
    /// z' at the rate `w_rel` of the sign given.
    pub(crate) fn rate(&self, share: f64, sign: f64, relative_rate_radps: f64) -> f64 {
        let loading = if share * sign > 0.0 { share * share } else { 0.0 };
        relative_rate_radps * (1.0 - loading) / self.displacement_rad
    }
}

pub(super) fn spring(values: &[f64], altered: &mut Altered) {
    altered.laws.spring.stiffness_nm_per_rad += values[0];
}

pub(super) fn hysteresis(values: &[f64], altered: &mut Altered) {
    altered.laws.hysteresis = Some(Hysteresis { torque_nm: values[0], displacement_rad: values[1] });
}
