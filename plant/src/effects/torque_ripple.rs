//! `torque_ripple`: cogging of the motor and waviness of the bearings.
//!
//! ```text
//! A sin(n rel + phase)        independent of T_m
//! ```
//!
//! Block `disturbance`; n cycles a revolution, rel zero at the first row. Changes `gyro_angle_rad`,
//! `motor_torque_nm` and the angles of the gimbal.

use super::Altered;

/// One line of ripple.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ripple {
    amplitude_nm: f64,
    cycles: f64,
    phase_rad: f64,
}

impl Ripple {
    pub(crate) fn torque_nm(&self, relative_rad: f64) -> f64 {
        self.amplitude_nm * (self.cycles * relative_rad + self.phase_rad).sin()
    }
}

pub(super) fn apply(values: &[f64], altered: &mut Altered) {
    altered.laws.ripple = Some(Ripple { amplitude_nm: values[0], cycles: values[1], phase_rad: values[2] });
}
