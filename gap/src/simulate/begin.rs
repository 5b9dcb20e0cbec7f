//! Where a prediction begins.

use gimbal_servo::Config;

use super::bearing::Viscous;
use super::chain::{INTEGRATOR, PLAIN, SECTION, THETA, TORQUE};
use super::{Inputs, Physics};

/// Where a prediction begins.
#[derive(Debug, Clone, PartialEq)]
pub struct Begin {
    /// phi', theta, theta', four sections, integrator, motor torque, phi.
    pub state: [f64; PLAIN],
}

impl Begin {
    /// At rest under the first row, with the pick-off angle and motor torque that the log begins with, and a servo that has
    /// settled at them:
    ///
    /// ```text
    /// section y = (1 - r) in        I = T_m - T5 K theta
    /// ```
    #[must_use]
    pub fn at(physics: &Physics, inputs: &Inputs, theta_rad: f64, torque_nm: Option<f64>) -> Self {
        let Config { servo, bearing, unbalance, .. } = &physics.config;
        let rate = inputs.rate_radps[0];
        let level = inputs.load_nm[0] + Viscous::new(bearing).torque_nm(rate.abs());
        let disturbance = level * (rate / physics.slip_rate_radps()).clamp(-1.0, 1.0)
            + unbalance.torque_nm(inputs.accel_mps2[0][0], inputs.accel_mps2[1][0]);
        let torque_nm = torque_nm.unwrap_or(disturbance);
        let signal = servo.gain_nm_per_rad_s * theta_rad;
        let mut state = [0.0; PLAIN];
        state[THETA] = theta_rad;
        for (section, (lag_s, lead_s)) in
            servo.lag_time_constants_s.iter().zip(&servo.lead_time_constants_s).enumerate()
        {
            state[SECTION + section] = (1.0 - lead_s / lag_s) * signal;
        }
        state[INTEGRATOR] = torque_nm - servo.lead_time_constants_s[4] * signal;
        state[TORQUE] = torque_nm;
        Self { state }
    }
}
