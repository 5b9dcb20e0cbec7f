//! Nominal parameters, each known to its tolerance: what may be off without being a gap.

use gimbal_model_file::Tolerance;

use crate::simulate::Physics;

/// Standard deviation over tolerance within the tolerance, where nearly every value is as good as any other.
const UNIFORM: f64 = 0.7;
/// The same for what lies beyond it.
const BEYOND: f64 = 0.04;

/// How much less than nothing a fit may try, of what cannot be less.
const LESS: f64 = 0.05;

/// Step of a sensitivity over the tolerance: columns nearly cancel each other, and what a curvature adds to one would not.
const STEP: f64 = 0.002;
/// Alignment of the accelerometers with the platform's axes, about each [rad]: the model file has no name for it.
const ALIGNMENT_RAD: f64 = 1e-3;
/// How round the corners of the friction's clamp are, in shares of each shape [1]: no law near zero rate is known better, and
/// the model file has no name for it.
const ROUNDNESS: f64 = 1.0;

/// Share by which the clamp may be narrower than the nominal one: it stands in for stiction, and nobody knows how sharp
/// that is. Its name.
const SHARPER: f64 = 0.995;
pub(crate) const SHARPNESS: &str = "sharpness of the clamp";
/// Displacement over which the clamp's friction follows the rate [rad]: nobody knows it to be none. Its name.
const FOLLOWS_RAD: f64 = 3e-6;
pub(crate) const DISPLACEMENT: &str = "displacement of the clamp";
/// Time constant of the damping of what bends over that displacement [s]. Its name.
const DAMPED_S: f64 = 5e-3;
pub(crate) const DAMPING: &str = "damping of that displacement";
/// How straight it bends [1].
const STRAIGHT: f64 = 1.0;

/// How inputs run between rows, from lines, 0, to cubics, 1, and a little more than those: nobody logs it.
const CURVED: f64 = 1.25;

/// How much of the motor's delay is pure [1]: a lag and a pure delay are both how its sheet may be read.
const PURE: f64 = 1.0;
/// Its name.
pub(crate) const PURE_DELAY: &str = "how pure the motor's delay is";
/// How late the motor's torque may be read [s].
const READ_LATE_S: f64 = 1e-4;

/// One nominal parameter.
#[derive(Debug, Clone, Copy)]
pub struct Nuisance {
    /// What it is; the effect's name where a shift beyond the tolerance is one.
    pub name: &'static str,
    /// Standard deviation, in units of the shift.
    pub sigma: f64,
    /// Up to here a shift is no gap.
    pub tolerance: f64,
    /// How far one goes the other way.
    below: f64,
    /// Step of the finite difference.
    pub step: f64,
    field: Field,
    /// Whether a shift is added; others are logarithms of a ratio, so that scales of all torques together are a line.
    pub absolute: bool,
}

type Field = fn(&mut Physics) -> &mut f64;

fn relative(tolerance: f64, name: &'static str, field: Field) -> Nuisance {
    let (sigma, step) = (UNIFORM * tolerance, STEP * tolerance);
    Nuisance { name, sigma, tolerance, below: tolerance, step, field, absolute: false }
}

fn added(tolerance: f64, name: &'static str, field: Field) -> Nuisance {
    Nuisance { absolute: true, ..relative(tolerance, name, field) }
}

/// One that is not there less than not at all.
fn never_less(tolerance: f64, name: &'static str, field: Field) -> Nuisance {
    Nuisance { below: LESS * tolerance, ..added(tolerance, name, field) }
}

impl Nuisance {
    /// Up to where a shift is no gap, the way that another one goes.
    #[must_use]
    pub fn end(&self, toward: f64) -> f64 {
        if toward < 0.0 { self.below } else { self.tolerance }
    }

    /// Whether a shift is beyond that.
    #[must_use]
    pub fn is_beyond(&self, shift: f64) -> bool {
        shift.abs() > self.end(shift)
    }

    /// A shift that is not beyond it.
    #[must_use]
    pub fn within(&self, shift: f64) -> f64 {
        shift.clamp(-self.below, self.tolerance)
    }

    /// Known so many times better.
    pub(super) fn hold(&mut self, by: f64) {
        self.sigma *= by;
        self.tolerance *= by;
        self.below *= by;
    }

    /// Half the slope and half the curvature of the prior's cost at a shift, and the cost; of the parabola that
    /// holds at the shift `ahead`.
    ///
    /// ```text
    /// cost = (s / sigma)^2 + (max(0, |s| - tol) / (0.04 tol))^2        sigma = 0.7 tol
    /// ```
    #[must_use]
    pub fn prior(&self, shift: f64, ahead: f64) -> (f64, f64, f64) {
        let wall = BEYOND * self.tolerance;
        let flat = 1.0 / (self.sigma * self.sigma);
        if !self.is_beyond(ahead) {
            return (flat * shift, flat, flat * shift * shift);
        }
        let steep = 1.0 / (wall * wall);
        let beyond = shift - self.end(ahead).copysign(ahead);
        (flat * shift + steep * beyond, flat + steep, flat * shift * shift + steep * beyond * beyond)
    }

    /// The change of the parameter that a shift stands for: relative but for those that are added.
    #[must_use]
    pub fn change(&self, nominal: &Physics, shift: f64) -> f64 {
        let mut physics = nominal.clone();
        let nominal = *(self.field)(&mut physics);
        self.shift(&mut physics, shift);
        let moved = *(self.field)(&mut physics);
        if self.absolute { moved - nominal } else { moved / nominal - 1.0 }
    }

    /// The shift that stands for a change.
    pub(crate) fn shift_of(&self, change: f64) -> f64 {
        if self.absolute { change } else { change.max(LEAST_CHANGE).ln_1p() }
    }

    /// Moves the parameter.
    pub fn shift(&self, physics: &mut Physics, by: f64) {
        let value = (self.field)(physics);
        if self.absolute { stretch(value, by) } else { *value *= by.exp() }
    }
}

/// Least relative change whose logarithm is taken.
const LEAST_CHANGE: f64 = -0.95;
/// Up to this share of a value something is added to its logarithm.
const LOGARITHM: f64 = 0.5;

/// Adds to a value: in its logarithm where there is one, on in a line from there.
fn stretch(value: &mut f64, by: f64) {
    let share = by / *value;
    if !share.is_finite() {
        *value += by;
        return;
    }
    let near = share.clamp(-LOGARITHM, LOGARITHM);
    *value = *value * near.exp() + (by - near * *value);
}

/// Every nominal parameter of the platform.
#[must_use]
pub fn nuisances(tolerance: &Tolerance, physics: &Physics) -> Vec<Nuisance> {
    let default = tolerance.default_relative;
    let unbalance = &physics.config.unbalance;
    let size = unbalance.x_kg_m.hypot(unbalance.y_kg_m).max(1e-6);
    let bias_radps = tolerance.vehicle_rate_bias_radps;
    let biased = (bias_radps > 0.0)
        .then(|| added(bias_radps, "bias of the vehicle rate", |p| &mut p.measurement.rate_bias_radps));
    let mut all = vec![
        relative(tolerance.friction_level, "friction_level", |p| &mut p.friction.load_factor),
        relative(tolerance.viscous_friction, "bearing viscosity", |p| &mut p.friction.viscous_factor),
        added(tolerance.mass_unbalance * size, "unbalance x", |p| &mut p.config.unbalance.x_kg_m),
        added(tolerance.mass_unbalance * size, "unbalance y", |p| &mut p.config.unbalance.y_kg_m),
        added(ALIGNMENT_RAD, "accelerometers about x", |p| &mut p.turned_rad[0]),
        added(ALIGNMENT_RAD, "accelerometers about y", |p| &mut p.turned_rad[1]),
        added(ALIGNMENT_RAD, "accelerometers about z", |p| &mut p.turned_rad[2]),
        relative(tolerance.loop_gain, "loop_gain", |p| &mut p.config.servo.gain_nm_per_rad_s),
        relative(tolerance.motor_lag, "motor_lag", |p| &mut p.config.servo.motor_lag_s),
        relative(tolerance.gyro_damping, "gyro_damping", |p| &mut p.config.gyro.damping_nm_s_per_rad),
        relative(tolerance.angular_momentum, "angular_momentum", |p| &mut p.config.gyro.angular_momentum_nm_s),
        relative(tolerance.gimbal_inertia, "gimbal_inertia", |p| &mut p.config.servo.gimbal_inertia_kg_m2),
        relative(default, "float inertia", |p| &mut p.config.gyro.float_inertia_kg_m2),
        relative(default, "slip rate", |p| &mut p.config.bearing.slip_rate_radps),
        added(CURVED, "inputs between rows", |p| &mut p.curved),
        never_less(PURE, PURE_DELAY, |p| &mut p.pure_delay),
        never_less(READ_LATE_S, "torque read late", |p| &mut p.measurement.torque_late_s),
        added(ROUNDNESS, "roundness of the clamp", |p| &mut p.friction.corner.wide),
        added(ROUNDNESS, "roundness of half its width", |p| &mut p.friction.corner.middle),
        added(ROUNDNESS, "roundness of its corners alone", |p| &mut p.friction.corner.narrow),
        never_less(ROUNDNESS, "tails of the clamp", |p| &mut p.friction.corner.tails),
        never_less(SHARPER, SHARPNESS, |p| &mut p.friction.sharper),
        never_less(FOLLOWS_RAD, DISPLACEMENT, |p| &mut p.friction.follows_rad),
        never_less(STRAIGHT, "straightness of that displacement", |p| &mut p.friction.straight),
        never_less(DAMPED_S, DAMPING, |p| &mut p.friction.damped_s),
        relative(default, "T1", |p| &mut p.config.servo.lead_time_constants_s[0]),
        relative(default, "T2", |p| &mut p.config.servo.lead_time_constants_s[1]),
        relative(default, "T3", |p| &mut p.config.servo.lead_time_constants_s[2]),
        relative(default, "T4", |p| &mut p.config.servo.lead_time_constants_s[3]),
        relative(default, "T5", |p| &mut p.config.servo.lead_time_constants_s[4]),
        relative(default, "T6", |p| &mut p.config.servo.lag_time_constants_s[0]),
        relative(default, "T7", |p| &mut p.config.servo.lag_time_constants_s[1]),
        relative(default, "T8", |p| &mut p.config.servo.lag_time_constants_s[2]),
        relative(default, "T9", |p| &mut p.config.servo.lag_time_constants_s[3]),
        relative(tolerance.pickoff_scale, "pickoff_scale", |p| &mut p.measurement.pickoff_factor),
        relative(tolerance.torque_scale, "torque_scale", |p| &mut p.measurement.torque_factor),
    ];
    all.extend(biased);
    all
}

#[cfg(test)]
mod tests {
    use gimbal_model_file::{ModelFile, Tolerance};

    use super::{DAMPING, DISPLACEMENT, PURE_DELAY, SHARPNESS, nuisances};
    use crate::library::platform;

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

    #[test]
    fn contract_a_rate_has_a_bias_where_the_table_says_so() {
        let physics = platform(&ModelFile::default());
        let of = |vehicle_rate_bias_radps| {
            let tolerance = Tolerance { vehicle_rate_bias_radps, ..Tolerance::default() };
            nuisances(&tolerance, &physics).into_iter().find(|own| own.name == "bias of the vehicle rate")
        };
        assert!(of(0.0).is_none());
        let bias = of(2e-5).expect("a nominal parameter");
        assert!((bias.tolerance / 2e-5 - 1.0).abs() < 1e-12);
        assert!((bias.change(&physics, bias.tolerance) / bias.tolerance - 1.0).abs() < 1e-12);
    }

    #[test]
    fn contract_what_cannot_be_less_than_none_is_no_less() {
        let all = nuisances(&Tolerance::default(), &platform(&ModelFile::default()));
        for name in [
            PURE_DELAY,
            "torque read late",
            "tails of the clamp",
            SHARPNESS,
            DISPLACEMENT,
            DAMPING,
            "straightness of that displacement",
        ] {
            let own = all.iter().find(|own| own.name == name).expect("a nominal parameter");
            let cost = |share: f64| own.prior(share * own.tolerance, share * own.tolerance).2;
            assert!(cost(0.9) < 2.0 && cost(-0.04) < 1.0 && cost(-0.5) > 100.0 && cost(1.5) > 100.0, "{name}");
        }
    }

    #[test]
    fn closed_form_a_shift_stands_for_the_change_that_it_makes() {
        let physics = platform(&ModelFile::default());
        let all = nuisances(&Tolerance::default(), &physics);
        let change = |name: &str, shift: f64| {
            all.iter().find(|own| own.name == name).map(|own| own.change(&physics, shift)).expect("a parameter")
        };
        let x_kg_m = physics.config.unbalance.x_kg_m;
        assert!((change("unbalance x", -0.3 * x_kg_m) / x_kg_m - (-0.3_f64).exp_m1()).abs() < 1e-12);
        assert!((change("unbalance y", 1e-5) - 1e-5).abs() < 1e-18);
        assert!((change("loop_gain", 0.2) - 0.2_f64.exp_m1()).abs() < 1e-12);
        let gain = all.iter().find(|own| own.name == "loop_gain").expect("a parameter");
        assert!((gain.shift_of(gain.change(&physics, -0.3)) + 0.3).abs() < 1e-12);
        // no step where the logarithm ends
        let [below, above] = [0.499_999, 0.500_001].map(|share| change("unbalance x", share * x_kg_m));
        assert!((above - below).abs() < 1e-5 * x_kg_m);
    }
}
