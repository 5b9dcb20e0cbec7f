//! F(s) and the motor lag as a cascade of first-order sections.
//!
//! ```text
//! T_m = 1/(1+T s) * (1+T5 s)/s * (1+T4 s)/(1+T9 s) * ... * (1+T1 s)/(1+T6 s) * K theta                  (3)
//! ```
//!
//! Section `(1 + Ti s) / (1 + Tj s)` with input u: `Tj x' = u - x`, output `x + (Ti / Tj) (u - x)`.

use gimbal_servo::servo::Config;

use crate::vector::{INTEGRATOR, SECTION, TORQUE, Vector};

/// Coefficients of the cascade.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cascade {
    gain_nm_per_rad_s: f64,
    /// 1/Tj and Ti/Tj of the four sections.
    sections: [(f64, f64); 4],
    /// T5 [s].
    last_lead_s: f64,
    /// 1/T [1/s].
    motor_rate_per_s: f64,
}

impl Cascade {
    pub(crate) fn new(config: &Config) -> Self {
        let lead = config.lead_time_constants_s;
        let lag = config.lag_time_constants_s;
        Self {
            gain_nm_per_rad_s: config.gain_nm_per_rad_s,
            sections: [0, 1, 2, 3].map(|index| (1.0 / lag[index], lead[index] / lag[index])),
            last_lead_s: lead[4],
            motor_rate_per_s: 1.0 / config.motor_lag_s,
        }
    }

    /// Writes the slopes of the six servo states for the pick-off angle seen.
    pub(crate) fn rate(&self, pickoff_rad: f64, y: &Vector, rate: &mut Vector) {
        let mut signal = self.gain_nm_per_rad_s * pickoff_rad;
        for (index, &(per_s, ratio)) in self.sections.iter().enumerate() {
            let lag = y[SECTION + index];
            let drive = signal - lag;
            rate[SECTION + index] = per_s * drive;
            signal = lag + ratio * drive;
        }
        rate[INTEGRATOR] = signal;
        let command = y[INTEGRATOR] + self.last_lead_s * signal;
        rate[TORQUE] = self.motor_rate_per_s * (command - y[TORQUE]);
    }

    /// Least size of each servo state that the step size resolves, for theta of the size given.
    pub(crate) fn floor(&self, theta_rad: f64, torque_nm: f64, floor: &mut Vector) {
        let mut size = self.gain_nm_per_rad_s * theta_rad;
        for (index, &(_, ratio)) in self.sections.iter().enumerate() {
            floor[SECTION + index] = size;
            size *= ratio.max(1.0);
        }
        floor[INTEGRATOR] = torque_nm;
        floor[TORQUE] = torque_nm;
    }
}
