//! `stribeck`: friction that falls as the film builds up.
//!
//! ```text
//! T_f = (T_load + T_visc + dT exp(-(w_rel / v)^2)) * clamp(w_rel / w_s, -1, 1)
//! ```
//!
//! Block `friction`; dT for all bearings together, v the Stribeck rate. Changes `gyro_angle_rad`,
//! `motor_torque_nm` and the angles of the gimbal.

use super::Altered;

/// Excess of the level at rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stribeck {
    excess_nm: f64,
    rate_radps: f64,
}

impl Stribeck {
    pub(crate) fn level_nm(&self, relative_rate_radps: f64) -> f64 {
        let ratio = relative_rate_radps / self.rate_radps;
        self.excess_nm * (-ratio * ratio).exp()
    }
}

pub(super) fn apply(values: &[f64], altered: &mut Altered) {
    altered.laws.stribeck = Some(Stribeck { excess_nm: values[0], rate_radps: values[1] });
}
