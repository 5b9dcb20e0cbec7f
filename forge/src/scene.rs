//! A track, where the record begins on it, and what the instruments would show there without noise.

use crate::draw::Draw;
use crate::effects::{Scale, World};
use crate::machine::{Loads, Machine, Sample};
use crate::sensors::Noise;
use crate::track::Track;
use crate::truth::Truth;

/// Time the platform is given to settle before the first row of a track [s].
const SETTLE_S: f64 = 1.5;

/// A track with its record.
#[derive(Debug, Clone)]
pub struct Scene {
    /// True inputs.
    pub track: Track,
    /// Rows before the first one of the record.
    pub before: usize,
}

/// Names of the channels that can be compared.
pub const CHANNELS: [&str; 3] = ["gyro_angle_rad", "motor_torque_nm", "gimbal_angle_rad"];

/// One series for each of [`CHANNELS`].
pub type Outputs = [Vec<f64>; 3];

impl Scene {
    /// Rows of the record.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.track.rows.len() - self.before
    }

    /// A platform whose servo sees noise of the pick-off, and what is logged beside what it sees, one value a row of the record.
    #[must_use]
    pub fn shaken(&self, truth: &Truth, noise: &Noise, draw: &mut Draw) -> (Truth, Vec<f64>) {
        let mut shaken = truth.clone();
        let mut series = noise.series(noise.gyro_angle_rad, self.track.rows.len(), self.track.period_s, draw);
        if noise.in_loop {
            shaken.drive.noise_rad = series;
            return (shaken, vec![0.0; self.rows()]);
        }
        (shaken, series.split_off(self.before))
    }

    /// Runs a platform along the track of the scene, or along another one of the same length.
    #[must_use]
    pub fn run(&self, truth: &Truth, track: &Track, steps_per_row: usize) -> Vec<Sample> {
        self.run_with(truth, track, steps_per_row, None)
    }

    /// The same with load torques from a table for that track.
    #[must_use]
    pub fn run_with(&self, truth: &Truth, track: &Track, steps_per_row: usize, loads: Option<&Loads>) -> Vec<Sample> {
        let start_s = -(self.before as f64) * track.period_s;
        let mut machine = Machine::new(truth, track, steps_per_row, start_s).with_loads(loads);
        machine.settle(SETTLE_S);
        for _ in 0..self.before {
            machine.advance();
        }
        machine.zero_record();
        machine.hold(truth.drive.begins_nm);
        let rows = self.rows();
        let mut samples = Vec::with_capacity(rows);
        samples.push(machine.sample());
        for _ in 1..rows {
            machine.advance();
            samples.push(machine.sample());
        }
        samples
    }

    /// What the instruments show, noise aside.
    #[must_use]
    pub fn outputs(world: &World, samples: &[Sample]) -> Outputs {
        let sensors = &world.sensors;
        [
            samples.iter().map(|s| sensors.pickoff_scale * s.gyro_angle_rad + sensors.pickoff_bias_rad).collect(),
            samples.iter().map(|s| sensors.torque_scale * s.motor_torque_nm + sensors.torque_bias_nm).collect(),
            samples.iter().map(|s| s.gimbal_angle_rad).collect(),
        ]
    }

    /// Sizes by which effects are scaled, from a run without effects.
    #[must_use]
    pub fn scale(&self, samples: &[Sample]) -> Scale {
        let largest = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(|s| of(s).abs()).fold(0.0, f64::max);
        Scale {
            torque_nm: largest(&|s| s.motor_torque_nm).max(1e-6),
            relative_rad: largest(&|s| s.relative_angle_rad),
            rate_radps: self.track.rows.iter().map(|row| row.rate_radps.abs()).fold(1e-4, f64::max),
            length_s: self.rows() as f64 * self.track.period_s,
            rows: self.track.rows.len(),
            before: self.before,
            period_s: self.track.period_s,
        }
    }
}
