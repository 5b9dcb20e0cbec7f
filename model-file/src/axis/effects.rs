//! Effects that an axis may have, by name: what `known_good` may say.

use super::{AxisModel, AxisTolerance};
use crate::fields::nearest;

/// Names of the effects of an axis.
pub const EFFECTS: [&str; 36] = [
    "inertia",
    "viscous_friction",
    "friction_level",
    "torque_scale",
    "constant_torque",
    "torque_bias",
    "direction_asymmetry",
    "stribeck",
    "presliding",
    "quadratic_drag",
    "viscous_curve",
    "friction_drift",
    "viscous_drift",
    "bias_drift",
    "load_dependence",
    "position_friction",
    "friction_taper",
    "cable_spring",
    "cable_hysteresis",
    "torque_ripple",
    "motor_ripple",
    "dead_zone",
    "torque_curve",
    "motor_lag",
    "flexible_mode",
    "backlash",
    "external_load",
    "load_friction",
    "load_gain",
    "velocity_delay",
    "velocity_scale",
    "position_scale",
    "time_scale",
    "torque_sign",
    "command_bias",
    "loop_gain",
];

/// What is wrong with a name that is no effect.
pub(super) fn unknown(known_good: &[String]) -> Option<String> {
    let wrong = known_good.iter().find(|name| !EFFECTS.contains(&name.as_str()))?;
    Some(format!(
        "has `{wrong}`, which is no effect of an axis; the nearest known one is `{}`",
        nearest(wrong, EFFECTS.into_iter())
    ))
}

/// Tolerance of gains that are known to be good, relative.
const EXACTLY: f64 = 1e-6;

/// Holds the nominal parameters that are known to be good where the model has them.
pub(super) fn hold(model: &mut AxisModel) {
    let trusted = ["inertia", "viscous_friction", "friction_level"].map(|name| model.trusts(name));
    let AxisTolerance { inertia, viscous, coulomb } = &mut model.tolerance;
    for (tolerance, trusted) in [inertia, viscous, coulomb].into_iter().zip(trusted) {
        if trusted {
            *tolerance = 0.0;
        }
    }
    if model.trusts("loop_gain")
        && let Some(controller) = &mut model.controller
    {
        controller.tolerance = EXACTLY;
    }
}

impl AxisModel {
    /// Whether an effect cannot be, as its part is known to be good.
    #[must_use]
    pub fn trusts(&self, effect: &str) -> bool {
        self.known_good.iter().any(|good| good == effect)
    }
}
