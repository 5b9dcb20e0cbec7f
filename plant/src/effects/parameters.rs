//! `loop_gain`, `motor_lag`, `gyro_damping`, `angular_momentum`, `stop_angle`, `gimbal_inertia`: parameters of the
//! nominal equations that are not what the data sheet says.
//!
//! ```text
//! loop_gain          K (1 + s)        block servo
//! motor_lag          T (1 + s)        block servo
//! gyro_damping       Bo (1 + s)       block gyro
//! angular_momentum   H (1 + s)        block gyro
//! stop_angle         stop (1 + s)     block gyro
//! gimbal_inertia     Jg (1 + s)       block structure
//! ```
//!
//! All act in the loop and change `gyro_angle_rad`, `motor_torque_nm` and the angles of the gimbal; `stop_angle`
//! only while theta reaches a stop.

use super::Altered;

pub(super) fn loop_gain(values: &[f64], altered: &mut Altered) {
    altered.config.servo.gain_nm_per_rad_s *= 1.0 + values[0];
}

pub(super) fn motor_lag(values: &[f64], altered: &mut Altered) {
    altered.config.servo.motor_lag_s *= 1.0 + values[0];
}

pub(super) fn gyro_damping(values: &[f64], altered: &mut Altered) {
    altered.config.gyro.damping_nm_s_per_rad *= 1.0 + values[0];
}

pub(super) fn angular_momentum(values: &[f64], altered: &mut Altered) {
    altered.config.gyro.angular_momentum_nm_s *= 1.0 + values[0];
}

pub(super) fn stop_angle(values: &[f64], altered: &mut Altered) {
    altered.config.gyro.stop_angle_rad *= 1.0 + values[0];
}

pub(super) fn gimbal_inertia(values: &[f64], altered: &mut Altered) {
    altered.config.servo.gimbal_inertia_kg_m2 *= 1.0 + values[0];
}
