//! Gimbal inertia, servo compensation F(s) and motor lag: the `[servo]` table.
//!
//! ```text
//! gimbal   Jg phi'' = T_d - H theta' - T_m                                        (1)
//! servo    T_m(s) = F(s) / (1 + T s) * theta(s)                                   (3)
//! F(s) = K (1+T1 s)(1+T2 s)(1+T3 s)(1+T4 s)(1+T5 s) / [ s (1+T6 s)(1+T7 s)(1+T8 s)(1+T9 s) ]
//! ```
//!
//! Source: Kim, Chung and Oh, "The simulation of INS error due to gimbal servo dynamics", section 2.

use crate::BuildError;
use crate::config::positive;

/// Parameters of the stable member and its servo.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Config {
    /// Jg, inertia of the stable member about the gimbal axis [kg m2].
    pub gimbal_inertia_kg_m2: f64,
    /// K, gain of F(s) [N m/(rad s)]: F has an integrator.
    pub gain_nm_per_rad_s: f64,
    /// T1 to T5, the zeros of F(s) [s].
    pub lead_time_constants_s: [f64; 5],
    /// T6 to T9, the poles of F(s) beside the integrator [s].
    pub lag_time_constants_s: [f64; 4],
    /// T, the motor's first-order lag [s].
    pub motor_lag_s: f64,
}

impl Config {
    pub(crate) fn check(&self) -> Result<(), BuildError> {
        positive("servo.gimbal_inertia_kg_m2", self.gimbal_inertia_kg_m2)?;
        positive("servo.gain_nm_per_rad_s", self.gain_nm_per_rad_s)?;
        for value in self.lead_time_constants_s {
            positive("servo.lead_time_constants_s", value)?;
        }
        for value in self.lag_time_constants_s {
            positive("servo.lag_time_constants_s", value)?;
        }
        positive("servo.motor_lag_s", self.motor_lag_s)
    }
}
