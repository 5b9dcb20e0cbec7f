//! What a tick of the program `flight` works out: the model's step, the estimate of phi from theta and motor torque, and
//! whether the model still describes the axis.

use crate::minute::Flown;
use gimbal_servo::estimator::{self, Flags, Measured};
use gimbal_servo::{BuildError, Digest, ImageError, Input, Law, Number, Output, State, monitor};

/// What the sensors give at a row.
#[derive(Debug, Clone, Copy)]
pub struct Row<N> {
    /// Of the vehicle.
    pub input: Input<N>,
    /// Of the axis.
    pub measured: Measured<N>,
}

/// What the tick tells.
#[derive(Debug, Clone, Copy)]
pub struct Told<N: Number> {
    /// The model's state.
    pub output: Output<N>,
    /// What is known of phi and of the disturbance.
    pub estimate: estimator::Estimate<N>,
    /// What the gap monitor says.
    pub report: monitor::Report<N>,
}

/// The laws of one axis.
#[derive(Debug)]
pub struct Laws<N: Number> {
    /// Of the model.
    pub axis: Law<N>,
    /// Of the estimator.
    pub estimator: estimator::Law<N>,
    /// Of the gap monitor.
    pub monitor: monitor::Law<N>,
}

/// One axis under way.
#[derive(Debug)]
pub struct Onboard<'a, N: Number> {
    laws: &'a Laws<N>,
    model: State<N>,
    estimate: estimator::State<N>,
    watch: monitor::State<N>,
}

impl<N: Flown> Laws<N> {
    /// The place for laws to be read into.
    pub const BLANK: Self = Self { axis: Law::BLANK, estimator: estimator::Law::BLANK, monitor: monitor::Law::BLANK };

    /// Reads the images that the build script made; nothing here computes with doubles.
    ///
    /// # Errors
    /// What is wrong with an image.
    pub fn read_images(&mut self) -> Result<(), ImageError> {
        let [axis, estimator, monitor] = N::IMAGES;
        self.axis.read_image(axis)?;
        self.estimator.read_image(estimator)?;
        self.monitor.read_image(monitor)
    }
}

impl<N: Number> Laws<N> {
    /// Builds the laws, with doubles.
    ///
    /// # Errors
    /// The first field of the configuration that is wrong.
    pub fn build() -> Result<Self, BuildError> {
        let (config, settings) = (crate::minute::config(), estimator::Config::default());
        let estimator = settings.build::<N>(&config)?;
        Ok(Self {
            axis: config.build()?,
            monitor: crate::minute::monitor().build(&config, estimator.gyro_exponent())?,
            estimator,
        })
    }

    /// Before the first row.
    pub fn start(&self) -> Onboard<'_, N> {
        let (model, estimate) = (self.axis.start(), self.estimator.start());
        Onboard { laws: self, model, estimate, watch: self.monitor.start() }
    }
}

impl<N: Number> Onboard<'_, N> {
    /// One period.
    pub fn step(&mut self, row: &Row<N>) -> Told<N> {
        let Laws { axis, estimator, monitor } = self.laws;
        let output = axis.step(&mut self.model, row.input);
        let estimate = estimator.step(&mut self.estimate, &row.measured, axis, &self.model, output.faults);
        if estimate.flags.contains(Flags::SATURATED) {
            monitor.pause(&mut self.watch);
        }
        let report = monitor.step(&mut self.watch, row.measured.gyro_angle_rad, &self.model);
        Told { output, estimate, report }
    }
}

impl<N: Number> Told<N> {
    /// Adds every bit of it to a digest.
    pub fn digest(&self, digest: &mut Digest) {
        digest.add_output(&self.output);
        let Self { estimate, report, .. } = self;
        digest.add_signals(&[
            estimate.gimbal_angle_rad,
            estimate.bound_rad,
            estimate.disturbance_torque_nm,
            estimate.innovation_rad,
            report.residual_rad,
            report.score,
        ]);
        digest.add(&estimate.flags.bits().to_le_bytes());
        digest.add(&[u8::from(report.disagrees), report.regime as u8]);
    }
}
