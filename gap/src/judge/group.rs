//! Torques that are functions of the same.

use super::on_float;
use crate::fit::{Fit, Problem};

/// A group of them.
#[derive(Debug)]
pub(crate) struct Group {
    /// What of.
    pub(crate) of: &'static str,
    /// A torque a row on the gimbal [N m], or a drift of the float [rad/s].
    pub(crate) torques: Vec<Vec<f64>>,
    /// Which of both.
    pub(crate) on_float: bool,
    /// What their choice among others costs [nats].
    pub(crate) choice: f64,
}

impl Group {
    /// What they do to the whitened channels at a fit.
    pub(super) fn columns(&self, problem: &Problem, fit: &Fit) -> Vec<Vec<f32>> {
        if self.on_float {
            on_float::columns(problem, fit, &self.torques)
        } else {
            self.torques.iter().map(|torque| problem.torque_column(torque)).collect()
        }
    }
}
