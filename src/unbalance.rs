//! Mass unbalance of the stable member: the `[unbalance]` table.
//!
//! ```text
//! T_u = u_x a_y - u_y a_x        u = -m r_cm                                      (section 3)
//! ```
//!
//! The paper's case `T_u = T_u0 A_r sin(psi)` is `u = (T_u0 / g, 0)`, psi the angle of the acceleration from x.

use crate::BuildError;
use crate::config::within;

/// Unbalance vector in the plane normal to the gimbal axis.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Config {
    /// `u_x` [N m per m/s2 = kg m]; positive: the centre of mass lies towards -x.
    pub x_kg_m: f64,
    /// `u_y` [N m per m/s2 = kg m].
    pub y_kg_m: f64,
}

impl Config {
    pub(crate) fn check(&self) -> Result<(), BuildError> {
        within("unbalance.x_kg_m", self.x_kg_m, -1.0, 1.0)?;
        within("unbalance.y_kg_m", self.y_kg_m, -1.0, 1.0)
    }

    /// `T_u` [N m] under the specific force `(accel_x_mps2, accel_y_mps2)`.
    #[must_use]
    pub fn torque_nm(&self, accel_x_mps2: f64, accel_y_mps2: f64) -> f64 {
        self.x_kg_m * accel_y_mps2 - self.y_kg_m * accel_x_mps2
    }
}
