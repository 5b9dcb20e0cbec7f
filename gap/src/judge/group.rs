//! What an effect of no name might add, in groups of functions of the same.

use super::on_float;
use crate::fit::{Fit, Problem, narrow};
use crate::record::Signal;

/// What is added to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum On {
    /// A torque on the gimbal [N m].
    Gimbal,
    /// A drift of the float [rad/s].
    Float,
    /// What a sensor reads, in its unit.
    Reading(Signal),
}

/// A group of functions.
#[derive(Debug)]
pub(crate) struct Group {
    /// What of.
    pub(crate) of: &'static str,
    /// One a function, row by row.
    pub(crate) series: Vec<Vec<f64>>,
    /// What they are added to.
    pub(crate) on: On,
    /// What their choice among others costs [nats].
    pub(crate) choice: f64,
}

impl Group {
    /// What they do to the whitened channels at a fit.
    pub(super) fn columns(&self, problem: &Problem, fit: &Fit) -> Vec<Vec<f32>> {
        match self.on {
            On::Float => on_float::columns(problem, fit, &self.series),
            On::Gimbal => self.series.iter().map(|torque| problem.torque_column(torque)).collect(),
            On::Reading(signal) => self.series.iter().map(|own| read(problem, signal, own)).collect(),
        }
    }
}

/// What a reading of one sensor is to the whitened channels.
fn read(problem: &Problem, signal: Signal, reading: &[f64]) -> Vec<f32> {
    let channels = problem.record.channels.iter();
    let signals = channels.map(|own| if own.signal == signal { reading.to_vec() } else { vec![0.0; reading.len()] });
    narrow(&problem.whiten(signals.collect()))
}
