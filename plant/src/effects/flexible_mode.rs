//! `flexible_mode`: part of the stable member's inertia sits on a spring.
//!
//! ```text
//! J2 = r Jg      k = J2 (2 pi f)^2      c = 2 d J2 (2 pi f)
//! (Jg - J2) phi'' = T_d - H theta' - T_m - k (phi - q) - c (phi' - q')
//!        J2 q''   = k (phi - q) + c (phi' - q')
//! ```
//!
//! f is the frequency of the appendage with the gimbal held; the gimbal alone rings at `f / sqrt(1 - r)`. Motor,
//! gyro and bearings act on the main body, the total inertia is kept.
//!
//! Block `structure`. Changes `gyro_angle_rad`, `motor_torque_nm` and the angles of the gimbal.

use super::Altered;

/// The appendage.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Appendage {
    /// J2 / Jg.
    pub(crate) ratio: f64,
    frequency_radps: f64,
    damping: f64,
}

impl Appendage {
    /// q'' for the twist `phi - q` and its rate [rad/s2].
    pub(crate) fn acceleration(&self, twist_rad: f64, twist_rate_radps: f64) -> f64 {
        self.frequency_radps * (self.frequency_radps * twist_rad + 2.0 * self.damping * twist_rate_radps)
    }
}

pub(super) fn apply(values: &[f64], altered: &mut Altered) {
    altered.laws.appendage = Some(Appendage {
        // a body that is all appendage has no gimbal
        ratio: values[0].min(0.9),
        frequency_radps: std::f64::consts::TAU * values[1],
        damping: values[2],
    });
}
