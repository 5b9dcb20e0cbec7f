//! A model as a list of numbers, as it goes over the wire.
//!
//! Every field is taken apart by name, so that a new one cannot be forgotten. The order stands in `docs/wire.md`.

mod reader;

use gimbal_servo::{Config, Digest, estimator};

pub use reader::model;

/// Number of parameters.
pub const COUNT: usize = 60;
/// Of which the first belong to the axis.
const AXIS_COUNT: usize = Config::VALUES;

/// Parameters of the axis, then of the estimator.
pub type Values = [f64; COUNT];

/// Names of the parameters, in order.
pub const NAMES: [&str; COUNT] = [
    "servo.gimbal_inertia_kg_m2",
    "servo.gain_nm_per_rad_s",
    "servo.lead_time_constants_s[0]",
    "servo.lead_time_constants_s[1]",
    "servo.lead_time_constants_s[2]",
    "servo.lead_time_constants_s[3]",
    "servo.lead_time_constants_s[4]",
    "servo.lag_time_constants_s[0]",
    "servo.lag_time_constants_s[1]",
    "servo.lag_time_constants_s[2]",
    "servo.lag_time_constants_s[3]",
    "servo.motor_lag_s",
    "gyro.float_inertia_kg_m2",
    "gyro.damping_nm_s_per_rad",
    "gyro.angular_momentum_nm_s",
    "gyro.stop_angle_rad",
    "gyro.cross_coupling",
    "bearing.count",
    "bearing.preload_n",
    "bearing.gimbal_weight_n",
    "bearing.pitch_diameter_m",
    "bearing.load_torque_nm_per_n",
    "bearing.load_exponent",
    "bearing.static_axial_factor",
    "bearing.static_radial_factor",
    "bearing.torque_axial_factor",
    "bearing.torque_radial_factor",
    "bearing.lubrication_factor",
    "bearing.viscosity_m2ps",
    "bearing.viscous_law",
    "bearing.slip_rate_radps",
    "unbalance.x_kg_m",
    "unbalance.y_kg_m",
    "range.radial_accel_mps2",
    "range.axial_accel_mps2",
    "range.rate_radps",
    "range.torque_nm",
    "period_s",
    "interpolation",
    "sensors.gyro_noise_rad",
    "sensors.gyro_step_rad",
    "sensors.gyro_range_rad",
    "sensors.motor_torque_noise_nm",
    "sensors.motor_torque_measured",
    "sensors.delay_s",
    "sensors.stuck_rows",
    "sensors.accel_jump_mps2",
    "sensors.rate_jump_radps",
    "sensors.torque_jump_nm",
    "tolerance.damping",
    "tolerance.float_inertia",
    "tolerance.angular_momentum",
    "tolerance.gimbal_inertia",
    "tolerance.stop_angle",
    "tolerance.friction_level",
    "disturbance_walk_nm",
    "horizon_s",
    "bridge_s",
    "widest_bound_rad",
    "reserved",
];

/// Digest of parameters: the name of a model on the wire.
#[must_use]
pub fn digest(values: &Values) -> u64 {
    let mut digest = Digest::default();
    for value in values {
        digest.add(&value.to_bits().to_le_bytes());
    }
    digest.value()
}

/// The parameters of a model.
#[must_use]
pub fn values(axis: &Config, estimator: &estimator::Config) -> Values {
    let mut values = [0.0; COUNT];
    let all = axis.values().into_iter().chain(estimator_values(estimator));
    for (place, value) in values.iter_mut().zip(all) {
        *place = value;
    }
    values
}

fn estimator_values(estimator: &estimator::Config) -> [f64; COUNT - AXIS_COUNT] {
    let estimator::Config { sensors, tolerance, disturbance_walk_nm, horizon_s, bridge_s, widest_bound_rad } =
        *estimator;
    let estimator::Sensors {
        gyro_noise_rad,
        gyro_step_rad,
        gyro_range_rad,
        motor_torque_noise_nm,
        motor_torque_measured,
        delay_s,
        stuck_rows,
        accel_jump_mps2,
        rate_jump_radps,
        torque_jump_nm,
    } = sensors;
    let estimator::Tolerance { damping, float_inertia, angular_momentum, gimbal_inertia, stop_angle, friction_level } =
        tolerance;
    [
        gyro_noise_rad,
        gyro_step_rad,
        gyro_range_rad,
        motor_torque_noise_nm,
        flag(motor_torque_measured),
        delay_s,
        f64::from(stuck_rows),
        accel_jump_mps2,
        rate_jump_radps,
        torque_jump_nm,
        damping,
        float_inertia,
        angular_momentum,
        gimbal_inertia,
        stop_angle,
        friction_level,
        disturbance_walk_nm,
        horizon_s,
        bridge_s,
        widest_bound_rad,
        0.0,
    ]
}

fn flag(value: bool) -> f64 {
    f64::from(u8::from(value))
}
