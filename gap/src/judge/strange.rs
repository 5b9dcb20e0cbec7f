//! What a fit leaves, tried on torques that no effect of the library is asked for: smooth functions of what the
//! platform does. A gap of a kind that the library lacks still depends on something.
//!
//! ```text
//! gain = max over c of |r|^2 - |r - B b - W G sum c_i d_i|^2        d_i(t) a group's torques, B all that is fitted
//! ```
//!
//! Of n torques, chance gives a gain of n, with a scatter of sqrt(2 n).

use std::fmt;

use rayon::prelude::*;

use super::torques::groups;
use crate::fit::{Fit, Linear, Problem, solve};

/// Precision of a torque's size: none, but for what keeps equations regular.
const FREE: f64 = 1e-9;

/// How well a group of torques takes what is left.
#[derive(Debug, Clone, PartialEq)]
pub struct Stranger {
    /// What the torques are functions of.
    pub of: &'static str,
    /// What the square of the residual would fall by.
    pub gain: f64,
    /// Number of torques.
    pub torques: usize,
    /// What choosing them among others costs [nats].
    pub choice: f64,
}

impl Stranger {
    /// Beyond chance [nats].
    #[must_use]
    pub fn nats(&self) -> f64 {
        0.5 * (self.gain - self.torques as f64) - self.choice
    }
}

impl fmt::Display for Stranger {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} ({:.0} nats beyond chance)", self.of, self.nats())
    }
}

/// Every group at a fit, the one that takes most first.
#[must_use]
pub(crate) fn strangers(problem: &Problem, fit: &Fit) -> Vec<Stranger> {
    let linear = Linear::of(problem);
    let (_, precision) = problem.chosen(&fit.set.0);
    let begin = problem.columns.begin;
    let fixed = begin + problem.columns.nuisances;
    let (slopes, curvatures) = problem.pulled(&precision, &fit.shifts);
    let gain = |torques: &[Vec<f64>]| -> f64 {
        let mut others = fit.sensitivities.clone();
        others.extend(torques.iter().map(|torque| problem.torque_column(torque)));
        let (gram, mut drive) = linear.joined(&others, &fit.residual);
        let mut weights = precision[..fixed].to_vec();
        for (place, (slope, curvature)) in slopes.iter().zip(&curvatures).enumerate() {
            drive[begin + place] -= slope;
            weights[begin + place] = *curvature;
        }
        weights.extend(others.iter().map(|_| FREE));
        let chosen: Vec<usize> = (0..drive.len()).collect();
        solve(&gram, &drive, &chosen, &weights).map_or(0.0, |solution| solution.gain)
    };
    let base = gain(&[]);
    let mut strangers: Vec<Stranger> = groups(problem, fit)
        .into_par_iter()
        .map(|group| Stranger {
            of: group.of,
            gain: gain(&group.torques) - base,
            torques: group.torques.len(),
            choice: group.choice,
        })
        .collect();
    strangers.sort_by(|a, b| b.nats().total_cmp(&a.nats()));
    strangers
}
