//! The loaded model: laws, states and the last rows.

use gimbal_servo::monitor::{self, Recorder};
use gimbal_servo::{Config, Faults, Input, Law, Number, Output, State, estimator};
use gimbal_wire::{Outcome, Sensor};

use crate::limits;
use crate::parameters::{self, Values};

/// Rows of the ring: half a second at 1 kHz.
pub(crate) const RING_ROWS: usize = 512;

/// One axis, ready to step or stepping.
pub(crate) struct Axis<N: Number> {
    pub(crate) digest: u64,
    law: Law<N>,
    estimator: estimator::Law<N>,
    monitor: monitor::Law<N>,
    state: State<N>,
    estimate: estimator::State<N>,
    watch: monitor::State<N>,
    pub(crate) ring: Recorder<N, RING_ROWS>,
    /// The last row that came.
    row: Input<N>,
}

/// What a step gives.
pub(crate) struct Stepped {
    pub(crate) output: Output<f64>,
    pub(crate) estimate: estimator::Estimate<f64>,
    pub(crate) disagrees: bool,
}

impl<N: Number> Axis<N> {
    /// Builds the laws of a model.
    // A function of its own: what it takes is taken once, and the gate of the firmware's `computer` ends here.
    #[inline(never)]
    pub(crate) fn build(values: &Values) -> Result<Self, (Outcome, u16)> {
        let wrong = |parameter| (Outcome::WrongModel, parameter);
        let (config, settings) = parameters::model(values).map_err(wrong)?;
        if !limits::allow(&config.range) {
            return Err((Outcome::AboveLimit, 0));
        }
        let none = wrong(u16::MAX);
        let law: Law<N> = config.build().map_err(|_| none)?;
        let estimator: estimator::Law<N> = settings.build(&config).map_err(|_| none)?;
        let monitor = Self::monitor(&config, &settings, &estimator).map_err(|_| none)?;
        Ok(Self {
            digest: parameters::digest(values),
            state: law.start(),
            estimate: estimator.start(),
            watch: monitor.start(),
            ring: Recorder::new(1),
            row: Input::default(),
            law,
            estimator,
            monitor,
        })
    }

    /// The monitor grants the model the tolerance that the estimator is told of.
    fn monitor(
        config: &Config,
        settings: &estimator::Config,
        estimator: &estimator::Law<N>,
    ) -> Result<monitor::Law<N>, gimbal_servo::BuildError> {
        let tolerance = settings.tolerance.damping.max(settings.tolerance.angular_momentum);
        let settings = monitor::Config { model_tolerance: tolerance, ..monitor::Config::default() };
        settings.build(config, estimator.gyro_exponent())
    }

    /// Before the first row.
    pub(crate) fn restart(&mut self) {
        self.state = self.law.start();
        self.estimate = self.estimator.start();
        self.watch = self.monitor.start();
        self.ring = Recorder::new(1);
        self.row = Input::default();
    }

    /// One period: with what the sensors read, or with the last row held and no reading of the axis.
    pub(crate) fn step(&mut self, sensor: Option<&Sensor>) -> Stepped {
        let units = self.law.units();
        if let Some(sensor) = sensor {
            let [x, y, z] = sensor.accel_mps2.map(f64::from);
            self.row = units.input(&Input {
                accel_x_mps2: x,
                accel_y_mps2: y,
                accel_z_mps2: z,
                vehicle_rate_radps: f64::from(sensor.vehicle_rate_radps),
                ..Input::default()
            });
        }
        let gyro = sensor.and_then(|sensor| sensor.gyro_angle_rad).map(f64::from);
        let torque = sensor.and_then(|sensor| sensor.motor_torque_nm).map(f64::from);
        let measured = self.estimator.measured(gyro, torque);
        let output = self.law.step(&mut self.state, self.row);
        let estimate = self.estimator.step(&mut self.estimate, &measured, &self.law, &self.state, output.faults);
        if estimate.flags.contains(estimator::Flags::SATURATED) {
            self.monitor.pause(&mut self.watch);
        }
        let report = self.monitor.step(&mut self.watch, measured.gyro_angle_rad, &self.state);
        self.ring.record(measured.gyro_angle_rad, &self.row, &output, report.disagrees);
        Stepped {
            output: self.law.units().output(&output),
            estimate: self.estimator.si(&estimate),
            disagrees: report.disagrees,
        }
    }

    /// Corrections of velocity and position along x and y.
    pub(crate) fn corrections(&self) -> ([f64; 2], [f64; 2]) {
        (self.estimator.velocity_correction_mps(&self.estimate), self.estimator.position_correction_m(&self.estimate))
    }

    /// A row of the ring in SI, the oldest first.
    pub(crate) fn kept(&self, index: usize) -> Option<gimbal_wire::RingRow> {
        let record = self.ring.rows().nth(index)?;
        let units = self.law.units();
        let real = |value: N, exponent: i32| narrow(value.to_f64(exponent));
        let measured = record.measured_gyro_angle_rad;
        let input = &record.input;
        Some(gimbal_wire::RingRow {
            row: record.row,
            measured_gyro_angle_rad: measured.map_or(f32::NAN, |value| real(value, self.estimator.gyro_exponent())),
            modelled_gyro_angle_rad: real(record.modelled_gyro_angle_rad, units.gyro_angle),
            accel_mps2: [input.accel_x_mps2, input.accel_y_mps2, input.accel_z_mps2]
                .map(|value| real(value, units.accel)),
            vehicle_rate_radps: real(input.vehicle_rate_radps, units.rate),
        })
    }
}

/// A signal as it goes over the wire.
#[allow(clippy::cast_possible_truncation, reason = "rounds to the nearest, the same on every machine")]
pub(crate) fn narrow(value: f64) -> f32 {
    value as f32
}

/// Bits of a step's faults.
pub(crate) fn bits(faults: Faults) -> u16 {
    faults.bits()
}
