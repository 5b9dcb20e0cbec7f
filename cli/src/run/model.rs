//! What runs: the flight law in either number system, or the reference plant, behind one face.

use gimbal_servo::{Config, Faults, Input};

/// One axis that takes rows; samples and sums are SI.
pub(crate) trait Model {
    /// Takes the row of the next instant.
    fn step(&mut self, row: &Drive);

    /// Takes rows that nobody looks at one by one.
    fn steps(&mut self, rows: &[Drive]) {
        for row in rows {
            self.step(row);
        }
    }

    /// Everything at the instant of the last row.
    fn sample(&self) -> Sample;

    /// What has added up over all rows.
    fn totals(&self) -> Totals;
}

/// What drives a model at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Drive {
    /// What the flight law takes, and the plant.
    pub(crate) input: Input<f64>,
    /// Vehicle rate about x [rad/s]; the plant's `cross_axis_coupling` alone takes it.
    pub(crate) cross_rate_radps: f64,
}

impl From<Input<f64>> for Drive {
    /// Without a rate about x.
    fn from(input: Input<f64>) -> Self {
        Self { input, cross_rate_radps: 0.0 }
    }
}

/// The axis at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    pub(crate) gimbal_angle_rad: f64,
    pub(crate) gyro_angle_rad: f64,
    pub(crate) motor_torque_nm: f64,
    pub(crate) friction_torque_nm: f64,
    pub(crate) unbalance_torque_nm: f64,
    /// -1, 0 or 1: the stop on which the float is.
    pub(crate) stop: i8,
    /// Along x and y.
    pub(crate) velocity_error_mps: [f64; 2],
    /// Along x and y.
    pub(crate) position_error_m: [f64; 2],
    pub(crate) faults: Faults,
}

/// A run as a whole.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Totals {
    pub(crate) samples: u64,
    pub(crate) peak_gimbal_angle_rad: f64,
    pub(crate) peak_gyro_angle_rad: f64,
    pub(crate) time_on_stop_s: f64,
    /// What phi has moved unseen by the gyro.
    pub(crate) residual_offset_rad: f64,
    /// Every bit that was set at any instant.
    pub(crate) faults: Faults,
    /// 64-bit FNV-1a over the bits of all outputs.
    pub(crate) digest: u64,
}

/// Where a run begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Initial {
    /// Everything zero.
    Zero,
    /// Steady under the first row: theta zero, the motor carrying the disturbance.
    Settled,
}

/// What is to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The flight law in f32.
    Float,
    /// The flight law in fixed point.
    Fixed,
    /// The reference plant.
    Plant,
}

impl Kind {
    /// Name in results.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Float => "f32",
            Self::Fixed => "fixed",
            Self::Plant => "plant",
        }
    }
}

/// Time on a stop within a period, in periods: `age` is how long ago the float met or left the stop, 0 if it did not.
pub(crate) fn share_on_stop(on_stop: bool, age: f64) -> f64 {
    match (on_stop, age > 0.0) {
        (true, true) => age,
        (true, false) => 1.0,
        (false, true) => 1.0 - age,
        (false, false) => 0.0,
    }
}

/// A configuration for rows that stand for a held profile instead of point samples.
pub(crate) fn held(mut config: Config) -> Config {
    config.interpolation = gimbal_servo::Interpolation::Held;
    config
}
