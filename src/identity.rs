//! A fingerprint of a configuration, by which a saved state knows its law.
//!
//! Every field is taken apart by name, so that a new one cannot be forgotten.

use crate::config::{Config, Interpolation, Range};
use crate::digest::Digest;
use crate::{bearing, gyro, servo, unbalance};

impl Config {
    /// The fingerprint of all fields and of the number system.
    pub(crate) fn identity(&self, number: u8) -> u32 {
        let Self { servo, gyro, bearing, unbalance, range, period_s, interpolation } = *self;
        let held = interpolation == Interpolation::Held;
        let mut digest = Digest::default();
        sign(&mut digest, &servo_fields(servo));
        sign(&mut digest, &gyro_fields(gyro));
        sign(&mut digest, &bearing_fields(bearing));
        let unbalance::Config { x_kg_m, y_kg_m } = unbalance;
        let Range { radial_accel_mps2, axial_accel_mps2, rate_radps, torque_nm } = range;
        sign(&mut digest, &[x_kg_m, y_kg_m, radial_accel_mps2, axial_accel_mps2, rate_radps, torque_nm]);
        sign(&mut digest, &[period_s, f64::from(u8::from(held)), f64::from(number)]);
        digest.folded()
    }
}

fn sign(digest: &mut Digest, fields: &[f64]) {
    for field in fields {
        digest.add(&field.to_bits().to_le_bytes());
    }
}

fn servo_fields(servo: servo::Config) -> [f64; 12] {
    let servo::Config {
        gimbal_inertia_kg_m2,
        gain_nm_per_rad_s,
        lead_time_constants_s: [t1, t2, t3, t4, t5],
        lag_time_constants_s: [t6, t7, t8, t9],
        motor_lag_s,
    } = servo;
    [gimbal_inertia_kg_m2, gain_nm_per_rad_s, t1, t2, t3, t4, t5, t6, t7, t8, t9, motor_lag_s]
}

fn gyro_fields(gyro: gyro::Config) -> [f64; 5] {
    let gyro::Config {
        float_inertia_kg_m2,
        damping_nm_s_per_rad,
        angular_momentum_nm_s,
        stop_angle_rad,
        cross_coupling,
    } = gyro;
    let coupled = f64::from(u8::from(cross_coupling));
    [float_inertia_kg_m2, damping_nm_s_per_rad, angular_momentum_nm_s, stop_angle_rad, coupled]
}

fn bearing_fields(bearing: bearing::Config) -> [f64; 15] {
    let bearing::Config {
        count,
        preload_n,
        gimbal_weight_n,
        pitch_diameter_m,
        load_torque_nm_per_n,
        load_exponent,
        static_axial_factor,
        static_radial_factor,
        torque_axial_factor,
        torque_radial_factor,
        lubrication_factor,
        viscosity_m2ps,
        viscous_law,
        slip_rate_radps,
    } = bearing;
    let (viscous_low, viscous_high) = viscous_law.coefficients();
    [
        f64::from(count),
        preload_n,
        gimbal_weight_n,
        pitch_diameter_m,
        load_torque_nm_per_n,
        load_exponent,
        static_axial_factor,
        static_radial_factor,
        torque_axial_factor,
        torque_radial_factor,
        lubrication_factor,
        viscosity_m2ps,
        viscous_low,
        viscous_high,
        slip_rate_radps,
    ]
}
