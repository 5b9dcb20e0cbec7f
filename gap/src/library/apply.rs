//! An effect by its name and values, put into the physics; values as in the plant's table.

use crate::simulate::{BuildUp, Fall, Hysteresis, Loop, Physics, Ripple, Stribeck};

/// Place of the value that says how a cable's loop begins: it is the log's own, and none of the effect's.
pub(crate) const WOUND: usize = 3;

/// Adds an effect to the physics. Unknown names change nothing.
pub fn apply(effect: &str, values: &[f64], physics: &mut Physics) {
    let v = |index: usize| values.get(index).copied().unwrap_or(0.0);
    let config = &mut physics.config;
    match effect {
        "friction_level" => physics.friction.load_factor *= 1.0 + v(0),
        "viscous_friction" => physics.friction.viscous_nm_s += v(0),
        "stribeck" => {
            // a third value says how it falls
            let falls = match v(2) {
                way if way > 1.5 => Fall::Lorentzian,
                way if way > 0.5 => Fall::Exponential,
                _ => Fall::Gaussian,
            };
            physics.friction.stribeck = Some(Stribeck { excess_nm: v(0), rate_radps: v(1), falls });
        }
        "presliding" => {
            physics.friction.presliding_rad = v(0);
            // a second value says how it is formulated
            physics.friction.builds_up = match v(1) {
                way if way > 2.5 => BuildUp::Sprung,
                way if way > 1.5 => BuildUp::LoadAlone,
                way if way > 0.5 => BuildUp::OnClamp,
                _ => BuildUp::InPlaceOfClamp,
            };
        }
        "load_dependence" => physics.friction.per_g += v(0),
        "direction_asymmetry" => physics.friction.asymmetry += v(0),
        "quadratic_drag" => physics.friction.quadratic_nm_s2 += v(0),
        "friction_drift" => physics.friction.drift = Some([v(0), v(1)]),
        "mass_unbalance" => {
            config.unbalance.x_kg_m += v(0);
            config.unbalance.y_kg_m += v(1);
        }
        "anisoelasticity" => physics.anisoelasticity += v(0),
        "cable_spring" => physics.spring_nm_per_rad += v(0),
        "cable_hysteresis" => {
            // a third value says how it is formulated, a fourth how it begins
            let formulation = match v(2) {
                way if way > 2.5 => Loop::Dahl,
                way if way > 1.5 => Loop::Exponential,
                way if way > 0.5 => Loop::Stops,
                _ => Loop::BoucWen,
            };
            let wound = v(WOUND);
            physics.hysteresis = Some(Hysteresis { torque_nm: v(0), displacement_rad: v(1), formulation, wound });
        }
        "torque_ripple" => {
            let (sine, cosine) = v(2).sin_cos();
            physics.ripple = Some(Ripple { sine_nm: v(0) * cosine, cosine_nm: v(0) * sine, cycles: v(1) });
        }
        "constant_torque" => physics.constant_nm += v(0),
        "cross_axis_coupling" => physics.cross_axis_kg_m2 += v(0),
        "loop_gain" => config.servo.gain_nm_per_rad_s *= 1.0 + v(0),
        "loop_delay" => physics.delay_s += v(0).max(0.0),
        "motor_lag" => config.servo.motor_lag_s *= (1.0 + v(0)).max(0.05),
        "torque_saturation" => physics.limit_nm = (v(0) > 0.0).then_some(v(0)),
        "dead_zone" => physics.dead_zone_nm += v(0).max(0.0),
        "pickoff_quantisation" => physics.quantum_rad = v(0),
        "gyro_damping" => config.gyro.damping_nm_s_per_rad *= 1.0 + v(0),
        "angular_momentum" => config.gyro.angular_momentum_nm_s *= 1.0 + v(0),
        "stop_angle" => config.gyro.stop_angle_rad *= 1.0 + v(0),
        "float_torque" => physics.float_nm += v(0),
        "g_sensitive_float_torque" => physics.float_kg_m += v(0),
        "gimbal_inertia" => config.servo.gimbal_inertia_kg_m2 *= 1.0 + v(0),
        "flexible_mode" => physics.appendage = Some([v(0).clamp(0.0, 0.9), v(1), v(2)]),
        "pickoff_scale" => physics.measurement.pickoff_factor *= 1.0 + v(0),
        "pickoff_bias" => physics.measurement.pickoff_bias_rad += v(0),
        "torque_scale" => physics.measurement.torque_factor *= 1.0 + v(0),
        "torque_bias" => physics.measurement.torque_bias_nm += v(0),
        "time_skew" => physics.measurement.skew_s += v(0),
        _ => {}
    }
}
