//! The configuration, field by field as in the model file.

use gimbal_servo::bearing::ViscousLaw;
use gimbal_servo::{Config, Interpolation, Range, bearing, gyro, servo, unbalance};

/// One gimbal axis, in SI: the fields of the model file, each after the name of its table.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct GimbalConfig {
    /// Jg, inertia of the stable member about the gimbal axis [kg m2].
    pub servo_gimbal_inertia_kg_m2: f64,
    /// K, gain of F(s) [N m/(rad s)].
    pub servo_gain_nm_per_rad_s: f64,
    /// T1 to T5, the zeros of F(s) [s].
    pub servo_lead_time_constants_s: [f64; 5],
    /// T6 to T9, the poles of F(s) [s].
    pub servo_lag_time_constants_s: [f64; 4],
    /// T, the motor's first-order lag [s].
    pub servo_motor_lag_s: f64,
    /// Jo [kg m2].
    pub gyro_float_inertia_kg_m2: f64,
    /// Bo [N m s/rad].
    pub gyro_damping_nm_s_per_rad: f64,
    /// H [N m s].
    pub gyro_angular_momentum_nm_s: f64,
    /// Angle of the stops [rad].
    pub gyro_stop_angle_rad: f64,
    /// Whether the spin-axis rate acts on the gyro.
    pub gyro_cross_coupling: bool,
    /// Number of bearings; 0: no friction.
    pub bearing_count: u32,
    /// Axial preload of each [N].
    pub bearing_preload_n: f64,
    /// Weight that they carry [N].
    pub bearing_gimbal_weight_n: f64,
    /// dm [m].
    pub bearing_pitch_diameter_m: f64,
    /// c of (6.1) [N m/N].
    pub bearing_load_torque_nm_per_n: f64,
    /// Exponent of `F_s`.
    pub bearing_load_exponent: f64,
    /// Factor of `F_a` in `F_s`.
    pub bearing_static_axial_factor: f64,
    /// Factor of `F_r` in `F_s`.
    pub bearing_static_radial_factor: f64,
    /// Factor of `F_a` in (6.1).
    pub bearing_torque_axial_factor: f64,
    /// Factor of `F_r` in (6.1).
    pub bearing_torque_radial_factor: f64,
    /// f0.
    pub bearing_lubrication_factor: f64,
    /// nu [m2/s].
    pub bearing_viscosity_m2ps: f64,
    /// Viscous law: Harris's metric pair; false: the pair that the paper implies.
    pub bearing_viscous_metric: bool,
    /// `w_s` [rad/s].
    pub bearing_slip_rate_radps: f64,
    /// -m `r_x` [kg m].
    pub unbalance_x_kg_m: f64,
    /// -m `r_y` [kg m].
    pub unbalance_y_kg_m: f64,
    /// Largest specific force along x and y [m/s2].
    pub range_radial_accel_mps2: f64,
    /// Largest specific force along z [m/s2].
    pub range_axial_accel_mps2: f64,
    /// Largest vehicle rate [rad/s].
    pub range_rate_radps: f64,
    /// Largest external torque [N m].
    pub range_torque_nm: f64,
    /// Time between two steps [s].
    pub period_s: f64,
    /// Whether a row of inputs is held until the next; false: the mean of both acts.
    pub inputs_held: bool,
}

impl GimbalConfig {
    fn of(config: &Config) -> Self {
        let Config { servo, gyro, bearing, unbalance, range, .. } = config;
        Self {
            servo_gimbal_inertia_kg_m2: servo.gimbal_inertia_kg_m2,
            servo_gain_nm_per_rad_s: servo.gain_nm_per_rad_s,
            servo_lead_time_constants_s: servo.lead_time_constants_s,
            servo_lag_time_constants_s: servo.lag_time_constants_s,
            servo_motor_lag_s: servo.motor_lag_s,
            gyro_float_inertia_kg_m2: gyro.float_inertia_kg_m2,
            gyro_damping_nm_s_per_rad: gyro.damping_nm_s_per_rad,
            gyro_angular_momentum_nm_s: gyro.angular_momentum_nm_s,
            gyro_stop_angle_rad: gyro.stop_angle_rad,
            gyro_cross_coupling: gyro.cross_coupling,
            bearing_count: bearing.count,
            bearing_preload_n: bearing.preload_n,
            bearing_gimbal_weight_n: bearing.gimbal_weight_n,
            bearing_pitch_diameter_m: bearing.pitch_diameter_m,
            bearing_load_torque_nm_per_n: bearing.load_torque_nm_per_n,
            bearing_load_exponent: bearing.load_exponent,
            bearing_static_axial_factor: bearing.static_axial_factor,
            bearing_static_radial_factor: bearing.static_radial_factor,
            bearing_torque_axial_factor: bearing.torque_axial_factor,
            bearing_torque_radial_factor: bearing.torque_radial_factor,
            bearing_lubrication_factor: bearing.lubrication_factor,
            bearing_viscosity_m2ps: bearing.viscosity_m2ps,
            bearing_viscous_metric: bearing.viscous_law == ViscousLaw::Metric,
            bearing_slip_rate_radps: bearing.slip_rate_radps,
            unbalance_x_kg_m: unbalance.x_kg_m,
            unbalance_y_kg_m: unbalance.y_kg_m,
            range_radial_accel_mps2: range.radial_accel_mps2,
            range_axial_accel_mps2: range.axial_accel_mps2,
            range_rate_radps: range.rate_radps,
            range_torque_nm: range.torque_nm,
            period_s: config.period_s,
            inputs_held: config.interpolation == Interpolation::Held,
        }
    }

    pub(crate) fn config(&self) -> Config {
        Config {
            servo: servo::Config {
                gimbal_inertia_kg_m2: self.servo_gimbal_inertia_kg_m2,
                gain_nm_per_rad_s: self.servo_gain_nm_per_rad_s,
                lead_time_constants_s: self.servo_lead_time_constants_s,
                lag_time_constants_s: self.servo_lag_time_constants_s,
                motor_lag_s: self.servo_motor_lag_s,
            },
            gyro: gyro::Config {
                float_inertia_kg_m2: self.gyro_float_inertia_kg_m2,
                damping_nm_s_per_rad: self.gyro_damping_nm_s_per_rad,
                angular_momentum_nm_s: self.gyro_angular_momentum_nm_s,
                stop_angle_rad: self.gyro_stop_angle_rad,
                cross_coupling: self.gyro_cross_coupling,
            },
            bearing: bearing::Config {
                count: self.bearing_count,
                preload_n: self.bearing_preload_n,
                gimbal_weight_n: self.bearing_gimbal_weight_n,
                pitch_diameter_m: self.bearing_pitch_diameter_m,
                load_torque_nm_per_n: self.bearing_load_torque_nm_per_n,
                load_exponent: self.bearing_load_exponent,
                static_axial_factor: self.bearing_static_axial_factor,
                static_radial_factor: self.bearing_static_radial_factor,
                torque_axial_factor: self.bearing_torque_axial_factor,
                torque_radial_factor: self.bearing_torque_radial_factor,
                lubrication_factor: self.bearing_lubrication_factor,
                viscosity_m2ps: self.bearing_viscosity_m2ps,
                viscous_law: if self.bearing_viscous_metric { ViscousLaw::Metric } else { ViscousLaw::Printed },
                slip_rate_radps: self.bearing_slip_rate_radps,
            },
            unbalance: unbalance::Config { x_kg_m: self.unbalance_x_kg_m, y_kg_m: self.unbalance_y_kg_m },
            range: Range {
                radial_accel_mps2: self.range_radial_accel_mps2,
                axial_accel_mps2: self.range_axial_accel_mps2,
                rate_radps: self.range_rate_radps,
                torque_nm: self.range_torque_nm,
            },
            period_s: self.period_s,
            interpolation: if self.inputs_held { Interpolation::Held } else { Interpolation::Mean },
        }
    }
}

/// The paper's parameters, the misprints among them put right.
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_config_consistent(config: &mut GimbalConfig) {
    *config = GimbalConfig::of(&Config::consistent());
}

/// The paper's parameters as they are printed.
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_config_as_printed(config: &mut GimbalConfig) {
    *config = GimbalConfig::of(&Config::as_printed());
}

#[cfg(test)]
mod tests {
    use super::GimbalConfig;
    use gimbal_servo::{Config, Interpolation};

    #[test]
    fn a_configuration_survives_the_way_to_c_and_back() {
        let mut config = Config::as_printed();
        config.gyro.cross_coupling = true;
        config.interpolation = Interpolation::Held;
        config.unbalance.y_kg_m = 3.0;
        for config in [config, Config::consistent()] {
            assert_eq!(GimbalConfig::of(&config).config(), config);
        }
    }
}
