//! The effects of the contract's table.
//!
//! Where a formulation differs from the contract's equation it keeps the meaning of its parameters: Stribeck curves
//! with an exponent other than 2, pre-sliding by bristles or by Maxwell elements with a yield, cable hysteresis by
//! stop operators (Prandtl-Ishlinskii), ripple with a weak third harmonic, a hardening cable, drift with two time
//! constants, a mode as a second mass.

use core::f64::consts::PI;

use super::{Effect, Scale, World};
use crate::truth::{Appendage, Presliding};

/// Small and largest size of an effect.
#[allow(clippy::match_same_arms)] // one row an effect
pub(super) fn range(effect: &Effect) -> Option<(f64, f64)> {
    let growing = effect.sign > 0.0;
    Some(match effect.name {
        "friction_level" => (0.02, if growing { 2.0 } else { 0.8 }),
        "viscous_friction" => (1e-6, 2e-2),
        "stribeck" => (1e-5, 1e-2),
        "presliding" => (1e-5, 1e-2),
        "load_dependence" => (1e-3, 1.0),
        "direction_asymmetry" => (1e-3, 0.6),
        "quadratic_drag" => (1e-7, 1e-2),
        "friction_drift" => (5e-3, if growing { 1.5 } else { 0.7 }),
        "mass_unbalance" => (3e-7, 3e-4),
        "anisoelasticity" => (1e-10, 1e-5),
        "cable_spring" => (1e-6, 5e-2),
        "cable_hysteresis" => (1e-6, 1e-2),
        "torque_ripple" => (1e-7, 5e-3),
        "constant_torque" => (1e-7, 1e-2),
        "cross_axis_coupling" => (1e-6, 5e-2),
        "loop_gain" => (5e-3, if growing { 0.4 } else { 0.5 }),
        "loop_delay" => (2e-6, 5e-4),
        "motor_lag" => (5e-3, 0.5),
        "torque_saturation" => (1e-2, 1.5),
        "dead_zone" => (1e-7, 2e-3),
        "pickoff_quantisation" => (2e-8, 1e-4),
        "gyro_damping" | "angular_momentum" | "gimbal_inertia" => (5e-3, 0.4),
        "stop_angle" => (1e-2, 0.9),
        "float_torque" => (1e-8, 4e-5),
        "g_sensitive_float_torque" => (1e-9, 4e-6),
        "flexible_mode" => (1e-3, 0.25),
        "pickoff_scale" | "torque_scale" => (5e-3, 0.5),
        "pickoff_bias" => (1e-8, 1e-3),
        "torque_bias" => (1e-7, 1e-2),
        "time_skew" => (1e-6, 3e-2),
        _ => return None,
    })
}

/// Width of the Stribeck curve [rad/s] and its exponent.
fn stribeck_shape(effect: &Effect) -> [f64; 2] {
    [effect.between_logs(0, 4e-3, 4e-2), effect.between(1, 1.7, 2.3)]
}

/// Displacement of the cable's hysteresis [rad].
fn hysteresis_rad(effect: &Effect, scale: &Scale) -> f64 {
    effect.between_logs(0, 2e-3, 3e-2).min((0.3 * scale.relative_rad).max(1e-4))
}

/// Cycles a revolution.
fn ripple_cycles(effect: &Effect) -> f64 {
    libm::floor(effect.between_logs(0, 8.0, 96.0))
}

fn unbalance(effect: &Effect, size: f64) -> [f64; 2] {
    let angle = 2.0 * PI * effect.shape[0];
    [size * libm::cos(angle), size * libm::sin(angle)]
}

fn mode(effect: &Effect) -> [f64; 2] {
    [effect.between_logs(0, 14.0, 180.0), effect.between_logs(1, 0.012, 0.06)]
}

/// Places and weights of elements whose initial stiffness together is 1 over the displacement.
fn spread(displacement: f64, count: usize) -> Vec<(f64, f64)> {
    let place = |index: usize| 0.3 + 1.6 * index as f64 / (count - 1) as f64;
    let stiffness: f64 = (0..count).map(|index| 1.0 / place(index)).sum::<f64>() / count as f64;
    (0..count).map(|index| (displacement * place(index) * stiffness, 1.0 / count as f64)).collect()
}

fn apply_friction(effect: &Effect, size: f64, world: &mut World) {
    let friction = &mut world.truth.friction;
    let signed = effect.sign * size;
    match effect.name {
        "friction_level" => friction.load_change = signed,
        "viscous_friction" => friction.linear = size,
        "stribeck" => {
            let [width, exponent] = stribeck_shape(effect);
            friction.stribeck = Some([size, width, exponent]);
        }
        "presliding" => {
            friction.presliding = Some(if effect.shape[0] < 0.5 {
                Presliding::Bristles(size)
            } else {
                Presliding::MaxwellSlip(spread(size, 6))
            });
        }
        "load_dependence" => friction.load_per_g = size,
        "direction_asymmetry" => friction.asymmetry = signed,
        "quadratic_drag" => friction.quadratic = size,
        "friction_drift" => friction.drift = Some([signed, effect.between(0, 4.0, 15.0), 0.1]),
        _ => {}
    }
}

fn apply_disturbance(effect: &Effect, size: f64, scale: &Scale, world: &mut World) {
    let torque = &mut world.truth.torque;
    let signed = effect.sign * size;
    match effect.name {
        "mass_unbalance" => torque.unbalance_kg_m = unbalance(effect, size),
        "anisoelasticity" => torque.anisoelastic = signed,
        "cable_spring" => torque.spring = [size, 0.03 * size / (scale.relative_rad * scale.relative_rad).max(1e-6)],
        "cable_hysteresis" => {
            torque.hysteresis = spread(hysteresis_rad(effect, scale), 10)
                .iter()
                .map(|(place, weight)| (*place, weight * size))
                .collect();
        }
        "torque_ripple" => {
            let (cycles, phase) = (ripple_cycles(effect), 2.0 * PI * effect.shape[1]);
            torque.ripple = vec![[size, cycles, phase], [0.05 * size, 3.0 * cycles, phase]];
        }
        "constant_torque" => torque.constant_nm = signed,
        "cross_axis_coupling" => torque.cross_rates = signed,
        _ => {}
    }
}

fn apply_servo(effect: &Effect, size: f64, scale: &Scale, world: &mut World) {
    let World { truth, sensors } = world;
    let grown = 1.0 + effect.sign * size;
    match effect.name {
        "loop_gain" => truth.config.servo.gain_nm_per_rad_s *= grown,
        "loop_delay" => truth.drive.delay_s += size,
        "motor_lag" => {
            truth.config.servo.motor_lag_s *= grown;
            truth.drive.delay_s *= grown;
        }
        "torque_saturation" => truth.drive.limit_nm = Some(scale.torque_nm / (1.0 + size)),
        "dead_zone" => truth.drive.dead_zone_nm = size,
        "pickoff_quantisation" => {
            truth.drive.step_rad = Some(size);
            sensors.pickoff_step_rad = Some(size);
        }
        _ => {}
    }
}

fn apply_rest(effect: &Effect, size: f64, world: &mut World) {
    let World { truth, sensors } = world;
    let signed = effect.sign * size;
    match effect.name {
        "gyro_damping" => truth.config.gyro.damping_nm_s_per_rad *= 1.0 + signed,
        "angular_momentum" => truth.config.gyro.angular_momentum_nm_s *= 1.0 + signed,
        "stop_angle" => truth.config.gyro.stop_angle_rad *= 1.0 - size,
        "float_torque" => truth.float.constant_nm = signed,
        "g_sensitive_float_torque" => truth.float.per_accel = signed,
        "gimbal_inertia" => truth.config.servo.gimbal_inertia_kg_m2 *= 1.0 + signed,
        "flexible_mode" => {
            let [frequency_hz, damping] = mode(effect);
            let frequency_radps = 2.0 * PI * frequency_hz;
            truth.appendage = Some(Appendage { share: size, frequency_radps, damping, play_rad: 0.0 });
        }
        "pickoff_scale" => sensors.pickoff_scale += signed,
        "pickoff_bias" => sensors.pickoff_bias_rad = signed,
        "torque_scale" => sensors.torque_scale += signed,
        "torque_bias" => sensors.torque_bias_nm = signed,
        "time_skew" => sensors.skew_s = size,
        _ => {}
    }
}

pub(super) fn apply(effect: &Effect, size: f64, scale: &Scale, world: &mut World) {
    apply_friction(effect, size, world);
    apply_disturbance(effect, size, scale, world);
    apply_servo(effect, size, scale, world);
    apply_rest(effect, size, world);
}

/// Name, value and unit, in the order of the contract.
pub(super) fn parameters(effect: &Effect, size: f64, scale: &Scale) -> Vec<(&'static str, f64, &'static str)> {
    let signed = effect.sign * size;
    match effect.name {
        "viscous_friction" => vec![("coefficient", size, "N m s/rad")],
        "quadratic_drag" => vec![("coefficient", size, "N m s2/rad2")],
        "stribeck" => vec![("excess_torque", size, "N m"), ("rate", stribeck_shape(effect)[0], "rad/s")],
        "presliding" => vec![("displacement", size, "rad")],
        "load_dependence" => vec![("ratio_per_g", size, "1/g")],
        "friction_drift" => vec![("ratio", signed, "1"), ("time_constant", effect.between(0, 4.0, 15.0), "s")],
        "mass_unbalance" => {
            let [x, y] = unbalance(effect, size);
            vec![("change_x", x, "kg m"), ("change_y", y, "kg m")]
        }
        "anisoelasticity" => vec![("coefficient", signed, "N m s4/m2")],
        "cable_spring" => vec![("stiffness", size, "N m/rad")],
        "cable_hysteresis" => vec![("torque", size, "N m"), ("displacement", hysteresis_rad(effect, scale), "rad")],
        "torque_ripple" => vec![
            ("amplitude", size, "N m"),
            ("cycles", ripple_cycles(effect), "1/rev"),
            ("phase", 2.0 * PI * effect.shape[1], "rad"),
        ],
        "constant_torque" | "float_torque" | "torque_bias" => vec![("torque", signed, "N m")],
        "cross_axis_coupling" => vec![("coefficient", signed, "N m s2/rad2")],
        "loop_delay" => vec![("delay", size, "s")],
        "torque_saturation" => vec![("limit", scale.torque_nm / (1.0 + size), "N m")],
        "dead_zone" => vec![("width", size, "N m")],
        "pickoff_quantisation" => vec![("step", size, "rad")],
        "stop_angle" => vec![("relative_change", -size, "1")],
        "g_sensitive_float_torque" => vec![("coefficient", signed, "N m s2/m")],
        "flexible_mode" => {
            let [frequency_hz, damping] = mode(effect);
            vec![("inertia_ratio", size, "1"), ("frequency", frequency_hz, "Hz"), ("damping_ratio", damping, "1")]
        }
        "pickoff_bias" => vec![("bias", signed, "rad")],
        "time_skew" => vec![("skew", size, "s")],
        // the relative changes and ratios
        _ => vec![("relative_change", signed, "1")],
    }
}
