//! A model as a list of numbers, as it goes over the wire.
//!
//! Every field is taken apart by name, so that a new one cannot be forgotten. The order stands in `docs/wire.md`.

use gimbal_servo::bearing::ViscousLaw;
use gimbal_servo::{Config, Digest, Interpolation, Range, bearing, estimator, gyro, servo, unbalance};

/// Number of parameters.
pub const COUNT: usize = 60;
/// Of which the first belong to the axis.
const AXIS_COUNT: usize = 39;

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
    let all = axis_values(axis).into_iter().chain(estimator_values(estimator));
    for (place, value) in values.iter_mut().zip(all) {
        *place = value;
    }
    values
}

fn axis_values(axis: &Config) -> [f64; AXIS_COUNT] {
    let Config { servo, gyro, bearing, unbalance, range, period_s, interpolation } = *axis;
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
