//! What a fit leaves, tried on torques that no effect of the library is asked for: smooth functions of what the
//! platform does. A gap of a kind that the library lacks still depends on something.
//!
//! ```text
//! gain = max over c of |r|^2 - |r - B b - W G sum c_i d_i|^2        d_i(t) a group's torques, B all that is fitted
//! ```
//!
//! Of n torques, chance gives a gain of n, with a scatter of sqrt(2 n).
//!
//! A torque at random depends on nothing; that all sensors show the same one tells it from their noise, whatever the
//! spectra of that are: its gain is the square of their agreement.

use std::fmt;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::torques::groups;
use crate::fit::{Fit, Linear, Problem, gram, slices, solve};

/// Amplitude that a torque must have beside those before it, over its own: of torques that are nearly alike a difference as
/// large as nothing makes them takes what no torque does.
const APART: f64 = 0.05;
/// A torque that is a function of nothing, and up to where sensors may agree on one: slower than the loop [Hz].
const AT_RANDOM: &str = "a torque at random that several sensors show";
const AGREED_HZ: f64 = 8.0;
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
    let gain = |torques: Vec<Vec<f32>>| -> f64 {
        let mut others = fit.sensitivities.clone();
        others.extend(torques);
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
    let base = gain(Vec::new());
    let mut strangers: Vec<Stranger> = groups(problem, fit)
        .into_par_iter()
        .map(|group| {
            let columns = apart(group.columns(problem, fit));
            let torques = columns.len();
            Stranger { of: group.of, gain: gain(columns) - base, torques, choice: group.choice }
        })
        .collect();
    let agreement = problem.path.agreement(&problem.whitener, &fit.residual, AGREED_HZ).max(0.0);
    strangers.push(Stranger { of: AT_RANDOM, gain: agreement.powi(2), torques: 1, choice: 0.0 });
    strangers.sort_by(|a, b| b.nats().total_cmp(&a.nats()));
    strangers
}

/// Columns without those that the ones before them nearly make.
fn apart(columns: Vec<Vec<f32>>) -> Vec<Vec<f32>> {
    let rows = columns.first().map_or(0, Vec::len);
    let gram = gram(&slices(&columns), 0..rows);
    let mut kept: Vec<usize> = Vec::new();
    for place in 0..columns.len() {
        let own = gram[(place, place)];
        let with = DVector::from_fn(kept.len(), |i, _| gram[(kept[i], place)]);
        let among = DMatrix::from_fn(kept.len(), kept.len(), |i, j| gram[(kept[i], kept[j])]);
        let made = among.cholesky().map_or(0.0, |among| with.dot(&among.solve(&with)));
        if own - made > APART * APART * own {
            kept.push(place);
        }
    }
    columns.into_iter().enumerate().filter(|(place, _)| kept.contains(place)).map(|(_, column)| column).collect()
}

#[cfg(test)]
mod tests {
    use super::apart;

    #[test]
    fn columns_that_others_make_are_left_out() {
        let wave = |rate: f32| -> Vec<f32> { (0..500_u16).map(|k| (rate * f32::from(k)).sin()).collect() };
        let sum: Vec<f32> = wave(0.1).iter().zip(wave(0.3)).map(|(a, b)| 2.0 * a - b).collect();
        let zero = vec![0.0; 500];
        let kept = apart(vec![wave(0.1), zero, wave(0.1), wave(0.3), sum, wave(0.31)]);
        assert_eq!(kept, [wave(0.1), wave(0.3), wave(0.31)]);
    }
}
