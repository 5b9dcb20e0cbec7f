//! Single-axis rate-integrating gyro with stops: the `[gyro]` table.
//!
//! ```text
//! gyro   Jo theta'' = H phi' - Bo theta'      |theta| < stop                      (2)
//! ```
//!
//! With `cross_coupling` the input axis, turned by theta, also senses the stable member's own inertial rate
//! `w_x` about the spin axis: `Jo theta'' = H (phi' + theta w_x) - Bo theta'`.
//!
//! On a stop theta stands still and the stop carries the torque `H phi'`; the float leaves it when that torque
//! points away from it.

use crate::BuildError;
use crate::config::positive;

/// Parameters of the gyro.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Config {
    /// Jo, inertia of the float about the output axis [kg m2].
    pub float_inertia_kg_m2: f64,
    /// Bo, damping of the float about the output axis [N m s/rad].
    pub damping_nm_s_per_rad: f64,
    /// H, angular momentum of the wheel [N m s].
    pub angular_momentum_nm_s: f64,
    /// Largest output angle to either side [rad].
    pub stop_angle_rad: f64,
    /// Whether theta couples the rate about the spin axis into the gyro.
    pub cross_coupling: bool,
}

impl Config {
    pub(crate) fn check(&self) -> Result<(), BuildError> {
        positive("gyro.float_inertia_kg_m2", self.float_inertia_kg_m2)?;
        positive("gyro.damping_nm_s_per_rad", self.damping_nm_s_per_rad)?;
        positive("gyro.angular_momentum_nm_s", self.angular_momentum_nm_s)?;
        positive("gyro.stop_angle_rad", self.stop_angle_rad)
    }

    /// H/Bo, the ratio of theta to phi at low frequency: 4.315 for the paper's gyro.
    #[must_use]
    pub fn low_frequency_gain(&self) -> f64 {
        self.angular_momentum_nm_s / self.damping_nm_s_per_rad
    }
}
