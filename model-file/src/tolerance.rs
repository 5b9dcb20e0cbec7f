//! How well the nominal parameters are known: the `[tolerance]` table.

use gimbal_servo::estimator;
use serde::{Deserialize, Serialize};

/// Of the bearings' torques: points measured by the paper lie so near to its curve (fig. 4).
const BEARINGS: f64 = 0.15;

/// Relative standard uncertainty of each nominal parameter, by the name of the effect that shifts it, and the bias that the
/// logged rate may have.
///
/// A shift inside it is a nuisance; a shift beyond it is the effect of that name. The alignment of the accelerometers is
/// not in the table: the diagnosis takes it to be known to 1e-3 rad about each axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    /// What holds for every parameter that the table does not name: T1 to T9, Jo and the bearing's slip rate, each by
    /// itself.
    pub default_relative: f64,
    /// Load friction: the scatter of the paper's own measurements.
    pub friction_level: f64,
    /// Viscous friction: what they scatter by is the torque of both.
    pub viscous_friction: f64,
    /// Unbalance vector, relative to its nominal size.
    pub mass_unbalance: f64,
    /// K.
    pub loop_gain: f64,
    /// T, the motor's lag.
    pub motor_lag: f64,
    /// Bo.
    pub gyro_damping: f64,
    /// H.
    pub angular_momentum: f64,
    /// Stop angle.
    pub stop_angle: f64,
    /// Jg.
    pub gimbal_inertia: f64,
    /// Scale of the pick-off.
    pub pickoff_scale: f64,
    /// Scale of the torque measurement.
    pub torque_scale: f64,
    /// Bias of the logged vehicle rate, absolute [rad/s]; 0 is none.
    pub vehicle_rate_bias_radps: f64,
}

impl Tolerance {
    /// Everything known to `default_relative`, the bearings' torques to 15 %, a logged rate without bias.
    #[must_use]
    pub fn with_default(default_relative: f64) -> Self {
        Self {
            default_relative,
            friction_level: BEARINGS,
            viscous_friction: BEARINGS,
            mass_unbalance: default_relative,
            loop_gain: default_relative,
            motor_lag: default_relative,
            gyro_damping: default_relative,
            angular_momentum: default_relative,
            stop_angle: default_relative,
            gimbal_inertia: default_relative,
            pickoff_scale: default_relative,
            torque_scale: default_relative,
            vehicle_rate_bias_radps: 0.0,
        }
    }

    /// Names and values; the names are effect names but for the last.
    #[must_use]
    pub fn entries(&self) -> [(&'static str, f64); 13] {
        [
            ("default_relative", self.default_relative),
            ("friction_level", self.friction_level),
            ("viscous_friction", self.viscous_friction),
            ("mass_unbalance", self.mass_unbalance),
            ("loop_gain", self.loop_gain),
            ("motor_lag", self.motor_lag),
            ("gyro_damping", self.gyro_damping),
            ("angular_momentum", self.angular_momentum),
            ("stop_angle", self.stop_angle),
            ("gimbal_inertia", self.gimbal_inertia),
            ("pickoff_scale", self.pickoff_scale),
            ("torque_scale", self.torque_scale),
            ("vehicle_rate_bias_radps", self.vehicle_rate_bias_radps),
        ]
    }

    /// What the onboard estimator is told of it.
    #[must_use]
    pub fn estimator(&self) -> estimator::Tolerance {
        estimator::Tolerance {
            damping: self.gyro_damping,
            float_inertia: self.default_relative,
            angular_momentum: self.angular_momentum,
            gimbal_inertia: self.gimbal_inertia,
            stop_angle: self.stop_angle,
            friction_level: self.friction_level,
        }
    }

    /// The tolerance of the parameter that an effect shifts; the default where the table has no such name.
    #[must_use]
    pub fn of(&self, effect: &str) -> f64 {
        self.entries().into_iter().find(|(name, _)| *name == effect).map_or(self.default_relative, |(_, value)| value)
    }
}

impl Default for Tolerance {
    /// 3 %, the bearings' torques 15 %.
    fn default() -> Self {
        Self::with_default(0.03)
    }
}
