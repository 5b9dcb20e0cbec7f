//! Nominal parameters, each known to its tolerance: what may be off without being a gap.

use gimbal_model_file::Tolerance;

use crate::simulate::Physics;

/// Standard deviation over tolerance within the tolerance, where nearly every value is as good as any other.
const UNIFORM: f64 = 0.7;
/// The same for what lies beyond it.
const BEYOND: f64 = 0.12;

/// Step of a sensitivity over the tolerance: columns nearly cancel each other, a curvature of 1 % would not.
const STEP: f64 = 0.02;
/// Alignment of the accelerometers with the platform's axes, about each [rad]: the model file has no name for it.
const ALIGNMENT_RAD: f64 = 1e-3;

/// One nominal parameter.
#[derive(Debug, Clone, Copy)]
pub struct Nuisance {
    /// What it is; the effect's name where a shift beyond the tolerance is one.
    pub name: &'static str,
    /// Standard deviation, in units of the shift.
    pub sigma: f64,
    /// Up to here a shift is no gap.
    pub tolerance: f64,
    /// Step of the finite difference.
    pub step: f64,
    shift: fn(&mut Physics, f64),
    /// Whether a shift is added; others are logarithms of a ratio, so that scales of all torques together are a line.
    pub absolute: bool,
}

impl Nuisance {
    /// Half the slope and half the curvature of the prior's cost at a shift, and the cost; of the parabola that
    /// holds at the shift `ahead`.
    ///
    /// ```text
    /// cost = (s / sigma)^2 + (max(0, |s| - tol) / (0.12 tol))^2        sigma = 0.7 tol
    /// ```
    #[must_use]
    pub fn prior(&self, shift: f64, ahead: f64) -> (f64, f64, f64) {
        let tolerance = self.tolerance;
        let wall = BEYOND * tolerance;
        let flat = 1.0 / (self.sigma * self.sigma);
        if ahead.abs() <= tolerance {
            return (flat * shift, flat, flat * shift * shift);
        }
        let steep = 1.0 / (wall * wall);
        let beyond = shift - tolerance.copysign(ahead);
        (flat * shift + steep * beyond, flat + steep, flat * shift * shift + steep * beyond * beyond)
    }

    /// The change that a shift stands for: relative but for those that are added.
    #[must_use]
    pub fn change(&self, shift: f64) -> f64 {
        if self.absolute { shift } else { shift.exp_m1() }
    }

    /// Moves the parameter.
    pub fn shift(&self, physics: &mut Physics, by: f64) {
        (self.shift)(physics, by);
    }
}

/// Adds to a value, in its logarithm where there is one.
fn stretch(value: &mut f64, by: f64) {
    if by.abs() < 0.5 * value.abs() { *value *= (by / *value).exp() } else { *value += by }
}

macro_rules! relative {
    ($tolerance:expr, $name:literal, $physics:ident => $field:expr) => {
        Nuisance {
            name: $name,
            sigma: UNIFORM * $tolerance,
            tolerance: $tolerance,
            step: STEP * $tolerance,
            shift: |$physics: &mut Physics, by: f64| $field *= by.exp(),
            absolute: false,
        }
    };
}

/// Every nominal parameter of the platform.
#[must_use]
pub fn nuisances(tolerance: &Tolerance, physics: &Physics) -> Vec<Nuisance> {
    let default = tolerance.default_relative;
    let unbalance = &physics.config.unbalance;
    let size = unbalance.x_kg_m.hypot(unbalance.y_kg_m).max(1e-6);
    let added = |name, tolerance: f64, shift| Nuisance {
        name,
        sigma: UNIFORM * tolerance,
        tolerance,
        step: STEP * tolerance,
        shift,
        absolute: true,
    };
    vec![
        relative!(tolerance.friction_level, "friction_level", p => p.friction.load_factor),
        relative!(tolerance.viscous_friction, "bearing viscosity", p => p.friction.viscous_factor),
        added("unbalance x", tolerance.mass_unbalance * size, |physics, by| {
            stretch(&mut physics.config.unbalance.x_kg_m, by);
        }),
        added("unbalance y", tolerance.mass_unbalance * size, |physics, by| {
            stretch(&mut physics.config.unbalance.y_kg_m, by);
        }),
        added("accelerometers about x", ALIGNMENT_RAD, |physics, by| physics.turned_rad[0] += by),
        added("accelerometers about y", ALIGNMENT_RAD, |physics, by| physics.turned_rad[1] += by),
        added("accelerometers about z", ALIGNMENT_RAD, |physics, by| physics.turned_rad[2] += by),
        relative!(tolerance.loop_gain, "loop_gain", p => p.config.servo.gain_nm_per_rad_s),
        relative!(tolerance.motor_lag, "motor_lag", p => p.config.servo.motor_lag_s),
        relative!(tolerance.gyro_damping, "gyro_damping", p => p.config.gyro.damping_nm_s_per_rad),
        relative!(tolerance.angular_momentum, "angular_momentum", p => p.config.gyro.angular_momentum_nm_s),
        relative!(tolerance.gimbal_inertia, "gimbal_inertia", p => p.config.servo.gimbal_inertia_kg_m2),
        relative!(default, "float inertia", p => p.config.gyro.float_inertia_kg_m2),
        relative!(default, "slip rate", p => p.config.bearing.slip_rate_radps),
        relative!(default, "T1", p => p.config.servo.lead_time_constants_s[0]),
        relative!(default, "T2", p => p.config.servo.lead_time_constants_s[1]),
        relative!(default, "T3", p => p.config.servo.lead_time_constants_s[2]),
        relative!(default, "T4", p => p.config.servo.lead_time_constants_s[3]),
        relative!(default, "T5", p => p.config.servo.lead_time_constants_s[4]),
        relative!(default, "T6", p => p.config.servo.lag_time_constants_s[0]),
        relative!(default, "T7", p => p.config.servo.lag_time_constants_s[1]),
        relative!(default, "T8", p => p.config.servo.lag_time_constants_s[2]),
        relative!(default, "T9", p => p.config.servo.lag_time_constants_s[3]),
        relative!(tolerance.pickoff_scale, "pickoff_scale", p => p.measurement.pickoff_factor),
        relative!(tolerance.torque_scale, "torque_scale", p => p.measurement.torque_factor),
    ]
}

#[cfg(test)]
mod tests {
    use gimbal_model_file::{ModelFile, Tolerance};

    use super::nuisances;

    #[test]
    #[allow(clippy::float_cmp, reason = "tolerances are copied")]
    fn contract_what_the_table_does_not_name_takes_its_default() {
        let tolerance = Tolerance { default_relative: 0.07, ..Tolerance::default() };
        let all = nuisances(&tolerance, &crate::library::platform(&ModelFile::default()));
        let of = |name: &str| all.iter().find(|own| own.name == name).expect("a nominal parameter").tolerance;
        for name in ["T1", "T2", "T3", "T4", "T5", "T6", "T7", "T8", "T9", "float inertia", "slip rate"] {
            assert_eq!(of(name), 0.07, "{name}");
        }
        for axis in ["x", "y", "z"] {
            assert_eq!(of(&format!("accelerometers about {axis}")), 1e-3);
        }
        assert_eq!((of("loop_gain"), of("friction_level")), (0.03, 0.15));
    }
}
