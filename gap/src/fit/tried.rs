//! What a search tried, told so that another log can try it too.

use super::{Fit, Problem};
use crate::library::Candidate;

/// A set that was fitted: small, and without the log.
#[derive(Debug, Clone)]
pub(crate) struct Tried {
    /// Its candidates, in the order of the values.
    pub(crate) candidates: Vec<Candidate>,
    pub(crate) values: Vec<Vec<f64>>,
    /// Shifts of the nominal parameters.
    pub(crate) shifts: Vec<f64>,
    /// Beginning, from where the log seems to begin.
    pub(crate) state: Vec<f64>,
    /// Square of the whitened residual.
    pub(crate) square: f64,
}

impl Tried {
    pub(crate) fn new(problem: &Problem, fit: &Fit) -> Self {
        let point = fit.point(problem);
        Self {
            candidates: fit.set.0.iter().map(|&index| problem.candidates[index].clone()).collect(),
            values: point.values,
            shifts: point.shifts,
            state: point.state,
            square: fit.square,
        }
    }

    /// Names, in alphabetical order.
    pub(crate) fn effects(&self) -> Vec<&'static str> {
        let mut names: Vec<&str> = self.candidates.iter().map(|candidate| candidate.effect).collect();
        names.sort_unstable();
        names
    }
}
