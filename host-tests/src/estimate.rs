//! The estimator over a simulated flight: truth from the plant, readings with noise and quantisation.

use gimbal_plant::{Plant, Row, Sample, Stop};
use gimbal_servo::estimator::{self, Flags, Measured};
use gimbal_servo::{Config, Fixed, Number};

use crate::axis::{Axis, System, si};
use crate::random::Random;

/// Noise of the inputs; that of theta and of the motor torque is in the estimator's own configuration.
#[derive(Debug, Clone, Copy)]
pub struct Noise {
    /// Specific force, rms [m/s2].
    pub accel_mps2: f64,
    /// Rate, rms [rad/s].
    pub rate_radps: f64,
}

impl Default for Noise {
    fn default() -> Self {
        Self { accel_mps2: 0.01, rate_radps: 2e-4 }
    }
}

/// What the sensors read at one row.
#[derive(Debug, Clone, Copy)]
pub struct Reading {
    /// theta [rad].
    pub gyro_angle_rad: Option<f64>,
    /// `T_m` [N m].
    pub motor_torque_nm: Option<f64>,
    /// The inputs; no external torque, which nothing on board measures.
    pub inputs: Row,
}

/// The truth and the readings of one flight.
#[derive(Debug, Clone)]
pub struct Flight {
    /// From the plant.
    pub truth: Vec<Sample>,
    /// Of the sensors.
    pub readings: Vec<Reading>,
}

impl Flight {
    /// Flies `rows` through the plant of `truth`, read by `sensors`.
    ///
    /// # Panics
    /// If the configuration is wrong.
    #[must_use]
    pub fn new(truth: &Config, sensors: &estimator::Sensors, noise: &Noise, rows: &[Row], seed: u64) -> Self {
        Self::of(&Plant::new(truth).expect("a configuration that builds"), sensors, noise, rows, seed)
    }

    /// [`Flight::new`] through any plant.
    #[must_use]
    pub fn of(plant: &Plant, sensors: &estimator::Sensors, noise: &Noise, rows: &[Row], seed: u64) -> Self {
        let mut random = Random::new(seed);
        let plant = plant.clone().with_tolerance(1e-8);
        let truth: Vec<Sample> = plant.run(rows.iter().copied()).collect();
        let readings = truth.iter().map(|sample| read(sample, sensors, noise, &mut random)).collect();
        Self { truth, readings }
    }
}

/// What the sensors make of a sample.
pub fn read(sample: &Sample, sensors: &estimator::Sensors, noise: &Noise, random: &mut Random) -> Reading {
    let logged = &sample.logged;
    let step = sensors.gyro_step_rad;
    let theta = logged.gyro_angle_rad + sensors.gyro_noise_rad * random.normal();
    let theta = if step > 0.0 { (theta / step).round() * step } else { theta };
    let mut accel = |value: f64| value + noise.accel_mps2 * random.normal();
    let [x, y, z] =
        [logged.inputs.accel_x_mps2, logged.inputs.accel_y_mps2, logged.inputs.accel_z_mps2].map(&mut accel);
    let rate = logged.inputs.vehicle_rate_radps + noise.rate_radps * random.normal();
    Reading {
        gyro_angle_rad: Some(theta),
        motor_torque_nm: Some(logged.motor_torque_nm + sensors.motor_torque_noise_nm * random.normal()),
        inputs: Row {
            accel_x_mps2: x,
            accel_y_mps2: y,
            accel_z_mps2: z,
            vehicle_rate_radps: rate,
            torque_nm: 0.0,
            ..logged.inputs
        },
    }
}

/// The estimate at one row, in SI.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// phi [rad].
    pub angle_rad: f64,
    /// 1 sigma [rad].
    pub bound_rad: f64,
    /// `T_d` [N m].
    pub torque_nm: f64,
    /// The model's theta [rad].
    pub modelled_gyro_angle_rad: f64,
    /// theta's innovation [rad].
    pub innovation_rad: f64,
    /// What the estimate says of itself.
    pub flags: Flags,
}

/// A whole run.
#[derive(Debug, Clone)]
pub struct Estimated {
    /// One a row.
    pub points: Vec<Point>,
    /// Velocity correction at the end [m/s].
    pub velocity_correction_mps: [f64; 2],
    /// Offset at the end [rad].
    pub offset_rad: f64,
    /// Its uncertainty, 1 sigma [rad].
    pub offset_bound_rad: f64,
}

/// Runs the estimator over readings.
///
/// # Panics
/// If a configuration does not build.
#[must_use]
pub fn estimate(system: System, nominal: &Config, config: &estimator::Config, readings: &[Reading]) -> Estimated {
    match system {
        System::F32 => estimate_in::<f32>(nominal, config, readings),
        System::Fixed => estimate_in::<Fixed>(nominal, config, readings),
    }
}

fn estimate_in<N: Number>(nominal: &Config, config: &estimator::Config, readings: &[Reading]) -> Estimated {
    let mut axis = Axis::<N>::new(nominal).expect("a configuration that builds");
    let law = config.build::<N>(nominal).expect("an estimator that builds");
    let mut state = law.start();
    let mut points = Vec::with_capacity(readings.len());
    for reading in readings {
        let output = axis.law.step(&mut axis.state, axis.law.units().input(&si(&reading.inputs)));
        let measured: Measured<N> = law.measured(reading.gyro_angle_rad, reading.motor_torque_nm);
        let estimate = law.step(&mut state, &measured, &axis.law, &axis.state, output.faults);
        let estimate = law.si(&estimate);
        points.push(Point {
            angle_rad: estimate.gimbal_angle_rad,
            bound_rad: estimate.bound_rad,
            torque_nm: estimate.disturbance_torque_nm,
            modelled_gyro_angle_rad: axis.law.units().output(&output).gyro_angle_rad,
            innovation_rad: estimate.innovation_rad,
            flags: estimate.flags,
        });
    }
    Estimated {
        points,
        velocity_correction_mps: law.velocity_correction_mps(&state),
        offset_rad: law.offset_rad(&state),
        offset_bound_rad: law.offset_bound_rad(&state),
    }
}

/// How good an estimate is.
#[derive(Debug, Clone, Copy)]
pub struct Score {
    /// rms of the attitude error over rms of phi.
    pub attitude: f64,
    /// The same for the static ratio Bo theta / H.
    pub static_ratio: f64,
    /// Norm of the velocity error after the correction over that before.
    pub velocity: f64,
    /// rms of phi [rad].
    pub rms_rad: f64,
    /// Share of rows within twice the bound.
    pub coverage: f64,
}

/// Scores an estimate over the rows from `from` on.
///
/// # Panics
/// Without any row.
#[must_use]
pub fn score(nominal: &Config, flight: &Flight, estimated: &Estimated, from: usize) -> Score {
    let rms = |of: &dyn Fn(usize) -> f64| {
        let count = (from..flight.truth.len()).len() as f64;
        ((from..flight.truth.len()).map(|k| of(k).powi(2)).sum::<f64>() / count).sqrt()
    };
    let phi = |k: usize| flight.truth[k].gimbal_angle_rad;
    let error = |k: usize| estimated.points[k].angle_rad - phi(k);
    let ratio = 1.0 / nominal.gyro.low_frequency_gain();
    let still = |k: usize| ratio * flight.readings[k].gyro_angle_rad.unwrap_or(0.0) - phi(k);
    let rms_rad = rms(&phi);
    let last = flight.truth.last().expect("rows");
    let [x, y] = last.velocity_error_mps;
    let [cx, cy] = estimated.velocity_correction_mps;
    let within = (from..flight.truth.len()).filter(|&k| error(k).abs() <= 2.0 * estimated.points[k].bound_rad).count();
    Score {
        attitude: rms(&error) / rms_rad,
        static_ratio: rms(&still) / rms_rad,
        velocity: (x + cx).hypot(y + cy) / x.hypot(y),
        rms_rad,
        coverage: within as f64 / (flight.truth.len() - from) as f64,
    }
}

/// Whether the float was on a stop at any row.
#[must_use]
pub fn saturates(flight: &Flight) -> bool {
    flight.truth.iter().any(|sample| sample.stop != Stop::Free)
}
