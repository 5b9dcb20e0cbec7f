//! A configuration as a list of numbers, and the fingerprint by which a saved state knows its law.
//!
//! Every field is taken apart by name, so that a new one cannot be forgotten.

use crate::bearing::ViscousLaw;
use crate::config::{Config, Interpolation, Range};
use crate::digest::Digest;
use crate::{bearing, gyro, servo, unbalance};

impl Config {
    /// Number of values in [`Config::values`].
    pub const VALUES: usize = 39;

    /// Every field in the order of the tables, SI; a choice of two is 0 or 1: cross coupling on, viscous constants metric,
    /// inputs held.
    #[must_use]
    pub fn values(&self) -> [f64; Self::VALUES] {
        let Self { servo, gyro, bearing, unbalance, range, period_s, interpolation } = *self;
        let servo::Config {
            gimbal_inertia_kg_m2,
            gain_nm_per_rad_s,
            lead_time_constants_s: [t1, t2, t3, t4, t5],
            lag_time_constants_s: [t6, t7, t8, t9],
            motor_lag_s,
        } = servo;
        let gyro::Config {
            float_inertia_kg_m2,
            damping_nm_s_per_rad,
            angular_momentum_nm_s,
            stop_angle_rad,
            cross_coupling,
        } = gyro;
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
        let unbalance::Config { x_kg_m, y_kg_m } = unbalance;
        let Range { radial_accel_mps2, axial_accel_mps2, rate_radps, torque_nm } = range;
        [
            gimbal_inertia_kg_m2,
            gain_nm_per_rad_s,
            t1,
            t2,
            t3,
            t4,
            t5,
            t6,
            t7,
            t8,
            t9,
            motor_lag_s,
            float_inertia_kg_m2,
            damping_nm_s_per_rad,
            angular_momentum_nm_s,
            stop_angle_rad,
            flag(cross_coupling),
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
            flag(viscous_law == ViscousLaw::Metric),
            slip_rate_radps,
            x_kg_m,
            y_kg_m,
            radial_accel_mps2,
            axial_accel_mps2,
            rate_radps,
            torque_nm,
            period_s,
            flag(interpolation == Interpolation::Held),
        ]
    }

    /// The fingerprint of all fields and of the number system.
    pub(crate) fn identity(&self, number: u8) -> u32 {
        let mut digest = Digest::default();
        for value in self.values() {
            digest.add(&value.to_bits().to_le_bytes());
        }
        digest.add(&[number]);
        digest.folded()
    }
}

fn flag(value: bool) -> f64 {
    f64::from(u8::from(value))
}
