//! Simulated logs from the plant: excitations, drifted parameters, sensor noise.

#![allow(
    missing_docs,
    unreachable_pub,
    dead_code,
    clippy::must_use_candidate,
    clippy::missing_panics_doc,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::redundant_closure_for_method_calls,
    reason = "a corpus for experiments, used by several of them, each in part"
)]

pub mod detectable;
pub mod draw;

use std::f64::consts::TAU;

use gimbal_model_file::Tolerance;
use gimbal_plant::{Effect, Plant, Row};
use gimbal_servo::Config;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// How the vehicle moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Excitation {
    /// Slow reversals at 1 g with tilt.
    RateTable,
    /// Random turns and accelerations.
    Manoeuvre,
    /// Boost with roll, coast, vibration.
    Flight,
}

impl Excitation {
    pub const ALL: [Self; 3] = [Self::RateTable, Self::Manoeuvre, Self::Flight];

    /// As tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::RateTable => "rate table",
            Self::Manoeuvre => "manoeuvre",
            Self::Flight => "flight",
        }
    }
}

/// White noise of the sensors: accelerometers, rates, pick-off, motor torque.
pub const ACCEL_NOISE_MPS2: f64 = 0.01;
pub const RATE_NOISE_RADPS: f64 = 2e-4;
pub const PICKOFF_NOISE_RAD: f64 = 2e-6;
pub const TORQUE_NOISE_NM: f64 = 1e-5;

/// The same, as the columns follow each other: accelerations, rate, cross rate, theta, motor torque.
pub const NOISE: [f64; SENSED] = [
    ACCEL_NOISE_MPS2,
    ACCEL_NOISE_MPS2,
    ACCEL_NOISE_MPS2,
    RATE_NOISE_RADPS,
    RATE_NOISE_RADPS,
    PICKOFF_NOISE_RAD,
    TORQUE_NOISE_NM,
];
pub const SENSED: usize = 7;
/// Time between two rows [s].
pub const ROW_S: f64 = 1e-3;

/// One simulated log.
#[derive(Debug, Clone)]
pub struct Case {
    pub seed: u64,
    pub excitation: Excitation,
    pub seconds: f64,
    /// Effects and their values.
    pub effects: Vec<(&'static str, Vec<f64>)>,
    /// Nominal parameters off by up to this share of their tolerance.
    pub drift: f64,
    pub noise: f64,
}

pub fn rng(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream);
    rng
}

/// A smooth random signal: sines of random frequency and phase.
fn wander(rng: &mut ChaCha8Rng, lines: usize, low_hz: f64, high_hz: f64, rms: f64) -> impl Fn(f64) -> f64 + use<> {
    let parts: Vec<(f64, f64)> = (0..lines)
        .map(|_| {
            let share: f64 = rng.random();
            (low_hz * (high_hz / low_hz).powf(share), TAU * rng.random::<f64>())
        })
        .collect();
    let amplitude = rms * (2.0 / lines as f64).sqrt();
    move |time_s| parts.iter().map(|(hz, phase)| amplitude * (TAU * hz * time_s + phase).sin()).sum()
}

pub fn rows(excitation: Excitation, seconds: f64, seed: u64) -> Vec<Row> {
    let rng = &mut rng(seed, 1);
    let g = 9.806_65;
    let count = (seconds * 1000.0) as usize;
    let times = (0..=count).map(|k| k as f64 * ROW_S);
    match excitation {
        Excitation::RateTable => {
            let rate = 0.03 + 0.3 * rng.random::<f64>();
            let half_s = 1.0 + 2.0 * rng.random::<f64>();
            let tilt = wander(rng, 4, 0.02, 0.2, 0.5);
            let small = wander(rng, 12, 0.5, 40.0, 0.02);
            times
                .map(|t| {
                    let square = (60.0 * (TAU * t / (2.0 * half_s)).sin()).tanh();
                    Row {
                        accel_x_mps2: g * tilt(t).sin(),
                        accel_y_mps2: g * tilt(t + 7.0).sin() * 0.8,
                        accel_z_mps2: g * tilt(t).cos(),
                        vehicle_rate_radps: rate * square * (1.0 + 0.5 * (0.3 * t).sin()) + small(t),
                        cross_rate_radps: 0.2 * (0.5 * t).sin(),
                        ..Row::default()
                    }
                })
                .collect()
        }
        Excitation::Manoeuvre => {
            let (ax, ay, az) = (
                wander(rng, 14, 0.05, 8.0, 3.0 * g),
                wander(rng, 14, 0.05, 8.0, 3.0 * g),
                wander(rng, 10, 0.05, 3.0, 1.0 * g),
            );
            let (rate, cross) = (wander(rng, 12, 0.1, 6.0, 0.6), wander(rng, 10, 0.1, 4.0, 0.5));
            times
                .map(|t| Row {
                    accel_x_mps2: ax(t),
                    accel_y_mps2: ay(t),
                    accel_z_mps2: g + az(t),
                    vehicle_rate_radps: rate(t),
                    cross_rate_radps: cross(t),
                    ..Row::default()
                })
                .collect()
        }
        Excitation::Flight => {
            let (vx, vy, vz) = (
                wander(rng, 20, 15.0, 120.0, 4.0),
                wander(rng, 20, 15.0, 120.0, 4.0),
                wander(rng, 20, 15.0, 120.0, 4.0),
            );
            let (slow_x, slow_y) = (wander(rng, 8, 0.05, 2.0, 4.0), wander(rng, 8, 0.05, 2.0, 4.0));
            let roll = wander(rng, 8, 0.1, 1.5, 0.8);
            let shake = wander(rng, 20, 5.0, 80.0, 0.02);
            let cross = wander(rng, 8, 0.1, 2.0, 0.2);
            let boost_s = 0.25 * seconds;
            times
                .map(|t| {
                    let thrust = if t < boost_s {
                        12.0 * g * (1.0 - (-t / 0.3).exp())
                    } else {
                        12.0 * g * (-(t - boost_s) / 0.2).exp()
                    };
                    let level = if t < boost_s { 1.0 } else { 0.3 };
                    Row {
                        accel_x_mps2: level * (vx(t) + slow_x(t)) + thrust * 0.8,
                        accel_y_mps2: level * (vy(t) + slow_y(t)) + thrust * 0.3,
                        accel_z_mps2: level * vz(t) + 0.1 * thrust,
                        vehicle_rate_radps: roll(t) + level * shake(t),
                        cross_rate_radps: cross(t),
                        ..Row::default()
                    }
                })
                .collect()
        }
    }
}

/// The platform with its nominal parameters off by up to `share` of the tolerance.
pub fn drifted(config: &Config, share: f64, seed: u64) -> Config {
    let rng = &mut rng(seed, 2);
    let mut off =
        |value: &mut f64, tolerance: f64| *value *= 1.0 + share * tolerance * (2.0 * rng.random::<f64>() - 1.0);
    let mut drifted = *config;
    off(&mut drifted.servo.gimbal_inertia_kg_m2, 0.03);
    off(&mut drifted.servo.gain_nm_per_rad_s, 0.03);
    off(&mut drifted.servo.motor_lag_s, 0.03);
    for value in drifted.servo.lead_time_constants_s.iter_mut().chain(&mut drifted.servo.lag_time_constants_s) {
        off(value, 0.03);
    }
    off(&mut drifted.gyro.float_inertia_kg_m2, 0.03);
    off(&mut drifted.gyro.damping_nm_s_per_rad, 0.03);
    off(&mut drifted.gyro.angular_momentum_nm_s, 0.03);
    off(&mut drifted.gyro.stop_angle_rad, 0.03);
    off(&mut drifted.bearing.load_torque_nm_per_n, 0.15);
    off(&mut drifted.bearing.lubrication_factor, 0.03);
    off(&mut drifted.unbalance.x_kg_m, 0.03);
    drifted
}

/// The platform with every nominal parameter anywhere inside its tolerance, and what of that its sensors do.
#[must_use]
pub fn anywhere(seed: u64) -> (Config, Vec<(&'static str, Vec<f64>)>) {
    let tolerance = Tolerance::default();
    let mut platform = drifted(&Config::consistent(), 1.0, seed);
    let rng = &mut rng(seed, 4);
    let mut off = |tolerance: f64| tolerance * (2.0 * rng.random::<f64>() - 1.0);
    platform.bearing.slip_rate_radps *= 1.0 + off(tolerance.default_relative);
    let unbalance = &platform.unbalance;
    platform.unbalance.y_kg_m += off(tolerance.mass_unbalance) * unbalance.x_kg_m.hypot(unbalance.y_kg_m);
    let sensors = vec![
        ("pickoff_scale", vec![off(tolerance.pickoff_scale)]),
        ("torque_scale", vec![off(tolerance.torque_scale)]),
    ];
    (platform, sensors)
}

/// The log's columns: time, accelerations, rate, cross rate, theta, motor torque, phi.
#[derive(Default)]
pub struct Simulated {
    pub columns: [Vec<f64>; SENSED + 2],
}

impl Simulated {
    /// One more row: what the sensors sense, each with its noise, and phi.
    pub fn push(&mut self, sensed: [f64; SENSED], noise: [f64; SENSED], phi_rad: f64, rng: &mut ChaCha8Rng) {
        let time_s = self.columns[0].len() as f64 * ROW_S;
        let noisy = sensed.iter().zip(noise).map(|(value, sigma)| value + sigma * rng.sample::<f64, _>(StandardNormal));
        let values = std::iter::once(time_s).chain(noisy).chain([phi_rad]);
        self.columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
    }

    /// The pick-off's column through its converter.
    #[must_use]
    pub fn converted(mut self) -> Self {
        for value in &mut self.columns[6] {
            *value = (*value / PICKOFF_STEP_RAD).round() * PICKOFF_STEP_RAD;
        }
        self
    }
}

/// Step of a pick-off of 16 bit over +-10 mrad [rad].
pub const PICKOFF_STEP_RAD: f64 = 20e-3 / 65536.0;

/// What the sensors sense of a row and its state.
pub fn sensed(row: &Row, theta_rad: f64, motor_torque_nm: f64) -> [f64; SENSED] {
    [
        row.accel_x_mps2,
        row.accel_y_mps2,
        row.accel_z_mps2,
        row.vehicle_rate_radps,
        row.cross_rate_radps,
        theta_rad,
        motor_torque_nm,
    ]
}

/// A line between two rows.
pub fn between(from: &Row, to: &Row, share: f64) -> Row {
    let line = |a: f64, b: f64| a + share * (b - a);
    Row {
        accel_x_mps2: line(from.accel_x_mps2, to.accel_x_mps2),
        accel_y_mps2: line(from.accel_y_mps2, to.accel_y_mps2),
        accel_z_mps2: line(from.accel_z_mps2, to.accel_z_mps2),
        vehicle_rate_radps: line(from.vehicle_rate_radps, to.vehicle_rate_radps),
        ..*from
    }
}

pub fn simulate(case: &Case) -> Simulated {
    simulate_platform(case, &drifted(&Config::consistent(), case.drift, case.seed))
}

/// The same of a given platform.
pub fn simulate_platform(case: &Case, platform: &Config) -> Simulated {
    let rows = rows(case.excitation, case.seconds, case.seed);
    simulate_rows(&rows, platform, &case.effects, case.noise, &mut rng(case.seed, 3))
}

/// The same of given rows and noise.
pub fn simulate_rows(
    rows: &[Row],
    platform: &Config,
    effects: &[(&'static str, Vec<f64>)],
    share: f64,
    rng: &mut ChaCha8Rng,
) -> Simulated {
    let mut plant = Plant::new(platform).expect("drifted").with_tolerance(1e-8);
    for (name, values) in effects {
        plant = plant.with_effect(Effect::from_name(name).expect("known"), values).expect("legal");
    }
    let noise = NOISE.map(|sigma| share * sigma);
    let mut simulated = Simulated::default();
    for sample in plant.run_from(plant.settled(&rows[0]), rows.iter().copied()) {
        let logged = &sample.logged;
        let sensed = sensed(&logged.inputs, logged.gyro_angle_rad, logged.motor_torque_nm);
        simulated.push(sensed, noise, sample.gimbal_angle_rad, rng);
    }
    simulated
}

/// The same as a log.
pub fn as_log(simulated: &Simulated) -> gimbal_log::Log {
    use gimbal_log::Column;
    let columns = [
        Column::Time,
        Column::AccelX,
        Column::AccelY,
        Column::AccelZ,
        Column::VehicleRate,
        Column::CrossRate,
        Column::GyroAngle,
        Column::MotorTorque,
    ];
    let mut log = gimbal_log::Log::default();
    log.time.period_s = ROW_S;
    for (column, values) in columns.into_iter().zip(&simulated.columns) {
        log.set(column, values.clone());
    }
    log
}
