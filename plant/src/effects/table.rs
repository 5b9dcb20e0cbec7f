//! Every effect: name, block, parameters, logged columns.

use super::Block::{Disturbance, Friction, Gyro, Measurement, Servo, Structure};
use super::Bound::{Any, NotNegative, Positive};
use super::{Altered, Block, Bound, Parameter};
use super::{
    cable, fixed_torque, flexible_mode, float_torque, loop_delay, measurement, motor, parameters, pickoff_quantisation,
    presliding, scaled_friction, stribeck, torque_ripple, viscous,
};

/// One line of the table.
pub(crate) struct Entry {
    pub(crate) name: &'static str,
    pub(crate) block: Block,
    pub(crate) parameters: &'static [Parameter],
    /// How many of the parameters, from the first, are sizes.
    pub(crate) sizes: usize,
    pub(crate) columns: &'static [&'static str],
    pub(crate) apply: fn(&[f64], &mut Altered),
}

/// What everything that acts in the loop changes.
const LOOP: &[&str] = &["gyro_angle_rad", "motor_torque_nm", "gimbal_angle_rad", "relative_angle_rad"];
const PICKOFF: &[&str] = &["gyro_angle_rad"];
const TORQUE: &[&str] = &["motor_torque_nm"];
const SKEWED: &[&str] = &[
    "accel_x_mps2",
    "accel_y_mps2",
    "accel_z_mps2",
    "vehicle_rate_radps",
    "cross_rate_radps",
    "gyro_angle_rad",
    "motor_torque_nm",
];

const fn parameter(name: &'static str, unit: &'static str, [low, typical, high]: [f64; 3], bound: Bound) -> Parameter {
    Parameter { name, unit, low, typical, high, bound }
}

const fn relative(range: [f64; 3]) -> [Parameter; 1] {
    [parameter("relative_change", "1", range, Any)]
}

const fn entry(
    name: &'static str,
    block: Block,
    parameters: &'static [Parameter],
    columns: &'static [&'static str],
    apply: fn(&[f64], &mut Altered),
) -> Entry {
    Entry { name, block, parameters, sizes: 1, columns, apply }
}

pub(crate) const TABLE: [Entry; 33] = [
    entry("friction_level", Friction, &relative([-0.5, 0.3, 1.0]), LOOP, scaled_friction::friction_level),
    entry(
        "viscous_friction",
        Friction,
        &[parameter("coefficient_nm_s_per_rad", "N m s/rad", [1e-4, 1e-3, 1e-2], Any)],
        LOOP,
        viscous::viscous_friction,
    ),
    entry(
        "stribeck",
        Friction,
        &[
            parameter("excess_nm", "N m", [1e-4, 6e-4, 3e-3], Any),
            parameter("rate_radps", "rad/s", [5e-3, 5e-2, 0.5], Positive),
        ],
        LOOP,
        stribeck::apply,
    ),
    entry(
        "presliding",
        Friction,
        &[parameter("displacement_rad", "rad", [1e-5, 1e-4, 2e-3], NotNegative)],
        LOOP,
        presliding::apply,
    ),
    entry(
        "load_dependence",
        Friction,
        &[parameter("ratio_per_g", "1", [-0.02, 0.01, 0.05], Any)],
        LOOP,
        scaled_friction::load_dependence,
    ),
    entry(
        "direction_asymmetry",
        Friction,
        &[parameter("ratio", "1", [-0.3, 0.1, 0.3], Any)],
        LOOP,
        scaled_friction::direction_asymmetry,
    ),
    entry(
        "quadratic_drag",
        Friction,
        &[parameter("coefficient_nm_s2_per_rad2", "N m s2/rad2", [1e-4, 1e-3, 1e-2], Any)],
        LOOP,
        viscous::quadratic_drag,
    ),
    entry(
        "friction_drift",
        Friction,
        &[
            parameter("ratio", "1", [-0.5, 0.3, 1.0], Any),
            parameter("time_constant_s", "s", [5.0, 30.0, 300.0], Positive),
        ],
        LOOP,
        scaled_friction::friction_drift,
    ),
    Entry {
        name: "mass_unbalance",
        block: Disturbance,
        parameters: &[
            parameter("change_x_kg_m", "kg m", [-1e-4, 2e-5, 1e-4], Any),
            parameter("change_y_kg_m", "kg m", [-1e-4, 1e-5, 1e-4], Any),
        ],
        sizes: 2,
        columns: LOOP,
        apply: fixed_torque::mass_unbalance,
    },
    entry(
        "anisoelasticity",
        Disturbance,
        &[parameter("coefficient_nm_s4_per_m2", "N m s4/m2", [-1e-6, 1e-7, 1e-6], Any)],
        LOOP,
        fixed_torque::anisoelasticity,
    ),
    entry(
        "cable_spring",
        Disturbance,
        &[parameter("stiffness_nm_per_rad", "N m/rad", [1e-4, 1e-3, 1e-2], Any)],
        LOOP,
        cable::spring,
    ),
    entry(
        "cable_hysteresis",
        Disturbance,
        &[
            parameter("torque_nm", "N m", [1e-4, 6e-4, 3e-3], Any),
            parameter("displacement_rad", "rad", [1e-2, 5e-2, 0.5], Positive),
        ],
        LOOP,
        cable::hysteresis,
    ),
    entry(
        "torque_ripple",
        Disturbance,
        &[
            parameter("amplitude_nm", "N m", [5e-5, 3e-4, 2e-3], Any),
            parameter("cycles_per_revolution", "1", [1.0, 12.0, 60.0], Any),
            parameter("phase_rad", "rad", [-3.1, 0.5, 3.1], Any),
        ],
        LOOP,
        torque_ripple::apply,
    ),
    entry(
        "constant_torque",
        Disturbance,
        &[parameter("torque_nm", "N m", [-3e-3, 1e-3, 3e-3], Any)],
        LOOP,
        fixed_torque::constant_torque,
    ),
    entry(
        "cross_axis_coupling",
        Disturbance,
        &[parameter("coefficient_kg_m2", "kg m2", [-5e-3, 1e-3, 5e-3], Any)],
        LOOP,
        fixed_torque::cross_axis_coupling,
    ),
    entry("loop_gain", Servo, &relative([-0.3, 0.1, 0.3]), LOOP, parameters::loop_gain),
    entry("loop_delay", Servo, &[parameter("delay_s", "s", [5e-5, 2e-4, 6e-4], NotNegative)], LOOP, loop_delay::apply),
    entry("motor_lag", Servo, &relative([-0.5, 0.2, 0.5]), LOOP, parameters::motor_lag),
    entry(
        "torque_saturation",
        Servo,
        &[parameter("limit_nm", "N m", [1.5e-2, 2e-2, 5e-2], NotNegative)],
        LOOP,
        motor::torque_saturation,
    ),
    entry("dead_zone", Servo, &[parameter("width_nm", "N m", [1e-5, 1e-4, 1e-3], NotNegative)], LOOP, motor::dead_zone),
    entry(
        "pickoff_quantisation",
        Servo,
        &[parameter("step_rad", "rad", [1e-6, 5e-6, 2e-5], NotNegative)],
        LOOP,
        pickoff_quantisation::apply,
    ),
    entry("gyro_damping", Gyro, &relative([-0.3, 0.1, 0.3]), LOOP, parameters::gyro_damping),
    entry("angular_momentum", Gyro, &relative([-0.2, 0.05, 0.2]), LOOP, parameters::angular_momentum),
    entry("stop_angle", Gyro, &relative([-0.5, 0.1, 0.5]), LOOP, parameters::stop_angle),
    entry(
        "float_torque",
        Gyro,
        &[parameter("torque_nm", "N m", [-2e-5, 2e-6, 2e-5], Any)],
        LOOP,
        float_torque::constant,
    ),
    entry(
        "g_sensitive_float_torque",
        Gyro,
        &[parameter("coefficient_kg_m", "kg m", [-1e-6, 1e-7, 1e-6], Any)],
        LOOP,
        float_torque::g_sensitive,
    ),
    entry("gimbal_inertia", Structure, &relative([-0.3, 0.1, 0.3]), LOOP, parameters::gimbal_inertia),
    entry(
        "flexible_mode",
        Structure,
        &[
            parameter("inertia_ratio", "1", [5e-3, 3e-2, 0.15], NotNegative),
            parameter("frequency_hz", "Hz", [12.0, 150.0, 400.0], Positive),
            parameter("damping_ratio", "1", [5e-3, 3e-2, 0.2], NotNegative),
        ],
        LOOP,
        flexible_mode::apply,
    ),
    entry("pickoff_scale", Measurement, &relative([-0.1, 0.02, 0.1]), PICKOFF, measurement::pickoff_scale),
    entry(
        "pickoff_bias",
        Measurement,
        &[parameter("bias_rad", "rad", [-1e-3, 1e-4, 1e-3], Any)],
        PICKOFF,
        measurement::pickoff_bias,
    ),
    entry("torque_scale", Measurement, &relative([-0.1, 0.02, 0.1]), TORQUE, measurement::torque_scale),
    entry(
        "torque_bias",
        Measurement,
        &[parameter("bias_nm", "N m", [-2e-3, 2e-4, 2e-3], Any)],
        TORQUE,
        measurement::torque_bias,
    ),
    entry(
        "time_skew",
        Measurement,
        &[parameter("skew_s", "s", [-5e-3, 1e-3, 5e-3], Any)],
        SKEWED,
        measurement::time_skew,
    ),
];
