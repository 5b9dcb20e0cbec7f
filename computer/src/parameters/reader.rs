//! The way back: a model from its parameters.

use gimbal_servo::bearing::ViscousLaw;
use gimbal_servo::{Config, Interpolation, Range, bearing, estimator, gyro, servo, unbalance};

use super::Values;

/// The model of parameters.
///
/// # Errors
/// The number of the first parameter that has no meaning: a flag that is not 0 or 1, a count that is not whole, a
/// reserved one that is not 0.
pub fn model(values: &Values) -> Result<(Config, estimator::Config), u16> {
    let mut reader = Reader { values, at: 0, wrong: None };
    let axis = axis(&mut reader);
    let estimator = estimator(&mut reader);
    let reserved = reader.next();
    reader.refuse_unless(reserved.to_bits() == 0);
    reader.wrong.map_or(Ok((axis, estimator)), Err)
}

/// The axis' parameters; struct expressions are evaluated in the order in which they are written.
fn axis(reader: &mut Reader) -> Config {
    Config {
        servo: servo::Config {
            gimbal_inertia_kg_m2: reader.next(),
            gain_nm_per_rad_s: reader.next(),
            lead_time_constants_s: reader.several(),
            lag_time_constants_s: reader.several(),
            motor_lag_s: reader.next(),
        },
        gyro: gyro::Config {
            float_inertia_kg_m2: reader.next(),
            damping_nm_s_per_rad: reader.next(),
            angular_momentum_nm_s: reader.next(),
            stop_angle_rad: reader.next(),
            cross_coupling: reader.flag(),
        },
        bearing: bearing::Config {
            count: reader.count(),
            preload_n: reader.next(),
            gimbal_weight_n: reader.next(),
            pitch_diameter_m: reader.next(),
            load_torque_nm_per_n: reader.next(),
            load_exponent: reader.next(),
            static_axial_factor: reader.next(),
            static_radial_factor: reader.next(),
            torque_axial_factor: reader.next(),
            torque_radial_factor: reader.next(),
            lubrication_factor: reader.next(),
            viscosity_m2ps: reader.next(),
            viscous_law: if reader.flag() { ViscousLaw::Metric } else { ViscousLaw::Printed },
            slip_rate_radps: reader.next(),
        },
        unbalance: unbalance::Config { x_kg_m: reader.next(), y_kg_m: reader.next() },
        range: Range {
            radial_accel_mps2: reader.next(),
            axial_accel_mps2: reader.next(),
            rate_radps: reader.next(),
            torque_nm: reader.next(),
        },
        period_s: reader.next(),
        interpolation: if reader.flag() { Interpolation::Held } else { Interpolation::Mean },
    }
}

fn estimator(reader: &mut Reader) -> estimator::Config {
    estimator::Config {
        sensors: estimator::Sensors {
            gyro_noise_rad: reader.next(),
            gyro_step_rad: reader.next(),
            gyro_range_rad: reader.next(),
            motor_torque_noise_nm: reader.next(),
            motor_torque_measured: reader.flag(),
            delay_s: reader.next(),
            stuck_rows: reader.count(),
            accel_jump_mps2: reader.next(),
            rate_jump_radps: reader.next(),
            torque_jump_nm: reader.next(),
        },
        tolerance: estimator::Tolerance {
            damping: reader.next(),
            float_inertia: reader.next(),
            angular_momentum: reader.next(),
            gimbal_inertia: reader.next(),
            stop_angle: reader.next(),
            friction_level: reader.next(),
        },
        disturbance_walk_nm: reader.next(),
        horizon_s: reader.next(),
        bridge_s: reader.next(),
        widest_bound_rad: reader.next(),
    }
}

struct Reader<'a> {
    values: &'a Values,
    at: u16,
    wrong: Option<u16>,
}

impl Reader<'_> {
    fn next(&mut self) -> f64 {
        let value = self.values.get(usize::from(self.at)).copied().unwrap_or_default();
        self.at = self.at.saturating_add(1);
        value
    }

    fn several<const L: usize>(&mut self) -> [f64; L] {
        let mut values = [0.0; L];
        for value in &mut values {
            *value = self.next();
        }
        values
    }

    fn flag(&mut self) -> bool {
        self.count_below(2) == 1
    }

    fn count(&mut self) -> u32 {
        self.count_below(u32::MAX)
    }

    fn count_below(&mut self, end: u32) -> u32 {
        let value = self.next();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked by the way back")]
        let count = value as u32;
        self.refuse_unless(f64::from(count).to_bits() == value.to_bits() && count < end);
        count
    }

    /// The parameter just read is wrong.
    fn refuse_unless(&mut self, right: bool) {
        if !right && self.wrong.is_none() {
            self.wrong = Some(self.at.saturating_sub(1));
        }
    }
}
