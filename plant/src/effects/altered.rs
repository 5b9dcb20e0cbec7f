//! What effects write into: the configuration, and the laws that the nominal plant has not.

use gimbal_servo::Config;

use super::cable::{Hysteresis, Spring};
use super::flexible_mode::Appendage;
use super::float_torque::FloatTorque;
use super::measurement::Measurement;
use super::motor::Motor;
use super::presliding::Presliding;
use super::scaled_friction::{Drift, Scales};
use super::stribeck::Stribeck;
use super::torque_ripple::Ripple;
use super::viscous::Drag;

/// The configuration after parameter changes, and the additional laws.
#[derive(Debug, Clone)]
pub(crate) struct Altered {
    pub(crate) config: Config,
    pub(crate) laws: Laws,
}

/// Laws beside the nominal ones; all absent by default.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Laws {
    pub(crate) scales: Scales,
    pub(crate) drift: Option<Drift>,
    pub(crate) stribeck: Option<Stribeck>,
    pub(crate) presliding: Option<Presliding>,
    pub(crate) drag: Drag,
    /// Constant torque on the gimbal [N m].
    pub(crate) constant_nm: f64,
    /// Torque over `a_x a_y` [N m s4/m2].
    pub(crate) anisoelasticity: f64,
    /// Torque over vehicle rate times cross rate [kg m2].
    pub(crate) cross_axis_kg_m2: f64,
    pub(crate) spring: Spring,
    pub(crate) hysteresis: Option<Hysteresis>,
    pub(crate) ripple: Option<Ripple>,
    /// Pure delay of the motor torque [s].
    pub(crate) delay_s: f64,
    pub(crate) motor: Motor,
    /// Step of the pick-off [rad]; 0 when it is smooth.
    pub(crate) pickoff_step_rad: f64,
    pub(crate) float: FloatTorque,
    pub(crate) appendage: Option<Appendage>,
    pub(crate) measurement: Measurement,
}

impl Laws {
    /// Whether the torque has a corner where `w_rel` changes its sign.
    pub(crate) fn corner_at_rest(&self) -> bool {
        self.scales.asymmetry != 0.0
            || self.drag.quadratic_nm_s2 != 0.0
            || self.presliding.is_some()
            || self.hysteresis.is_some()
    }

    /// Torques on the gimbal that depend on the inputs alone [N m].
    pub(crate) fn input_torque_nm(&self, row: &crate::Row) -> f64 {
        self.constant_nm
            + self.anisoelasticity * row.accel_x_mps2 * row.accel_y_mps2
            + self.cross_axis_kg_m2 * row.vehicle_rate_radps * row.cross_rate_radps
    }
}
