//! What a fit leaves, tried on torques and errors of sensors that no effect of the library is asked for: smooth functions
//! of what the platform does. A gap of a kind that the library lacks still depends on something.
//!
//! ```text
//! gain = max over c of |r|^2 - |r - B b - W G sum c_i d_i|^2        d_i(t) a group's torques, B all that is fitted
//! ```
//!
//! Of n torques, chance gives a gain of n, with a scatter of sqrt(2 n).
//!
//! A torque at random depends on nothing; that all sensors show the same one tells it from their noise, whatever the
//! spectra of that are: its gain is the square of their agreement, away from where the bearing turns around, as noise of
//! the rate is a torque there. One sensor alone shows it by its power over frequency, which is that of a torque behind the
//! loop, where that is more than the noise of the logged inputs makes.

use std::fmt;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::group::On;
use super::input_noise::random_torque;
use super::left_over::steady;
use super::torques::groups;
use super::turned::Change;
use crate::fit::{Fit, Linear, Problem, Solution, gram, linear_beside, slices};

/// Amplitude that a torque must have beside those before it, over its own: of torques that are nearly alike a difference as
/// large as nothing makes them takes what no torque does.
const APART: f64 = 0.05;
/// A torque that is a function of nothing, and up to where sensors may agree on one [Hz].
const AT_RANDOM: &str = "a torque at random that several sensors show";
const LIKE_NOISE: &str = "a torque at random, more than the noise of the logged inputs makes";
const AGREED_HZ: f64 = 32.0;
/// How many times the torque that it seems to make the noise of the logged inputs may be taken for.
const INPUTS_KNOWN: f64 = 2.0;
/// What one nat of it counts where the bearing seldom turns around: no effect in another formulation leaves it.
const AGREED_COUNTS: f64 = 2.0;
/// The same of the power of one sensor, whose own noise may have a spectrum not unlike it.
const LIKE_NOISE_COUNTS: f64 = 0.5;
/// What of a torque on the float is to be seen where the bearing does not turn around, and what its choice costs where it is not
/// [nats]: at turns the rate's noise shifts them, as a drift of the float does. Of one that is next to nothing elsewhere, what is
/// told there alone counts.
const SEEN_AWAY: f64 = 8.0;
const ELSEWHERE_NATS: f64 = 40.0;
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
    /// What one of its nats counts beside those of functions of the state.
    pub counts: f64,
}

impl Stranger {
    /// Beyond chance, as they count [nats].
    #[must_use]
    pub fn nats(&self) -> f64 {
        self.counts * (0.5 * (self.gain - self.torques as f64) - self.choice)
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
    let solved = |others: &[Vec<f32>]| linear_beside(problem, &linear, fit, others);
    let base = solved(&fit.sensitivities);
    let left = less(&fit.residual, base.as_ref(), &linear, &fit.sensitivities);
    let away = steady(problem);
    let mut strangers: Vec<Stranger> = groups(problem, fit)
        .into_par_iter()
        .map(|group| {
            let columns = apart(group.columns(problem, fit));
            let torques = columns.len();
            let mut others = fit.sensitivities.clone();
            others.extend(columns);
            let with = solved(&others);
            let gain = [&with, &base].map(|solution| solution.as_ref().map_or(0.0, |solution| solution.gain));
            let mut own =
                Stranger { of: group.of, gain: gain[0] - gain[1], torques, choice: group.choice, counts: 1.0 };
            if group.on == On::Float && own.nats() > SEEN_AWAY {
                let then = less(&fit.residual, with.as_ref(), &linear, &others);
                let seen = Change::new(&left, &then, &away);
                if seen.is_at_turns() {
                    own.gain = own.gain.min(torques as f64 + 2.0 * seen.told());
                }
                if seen.told() < SEEN_AWAY {
                    own.choice += ELSEWHERE_NATS;
                }
            }
            own
        })
        .collect();
    let counts = if problem.turns_mostly { 1.0 } else { AGREED_COUNTS };
    let inputs_nm = random_torque(problem, fit, &away);
    let gain = agreement(problem, fit, &away, inputs_nm).powi(2);
    strangers.push(Stranger { of: AT_RANDOM, gain, torques: 1, choice: 0.0, counts });
    if !problem.turns_mostly {
        let gain = 2.0 * problem.torque_at_random(&fit.residual, &away, INPUTS_KNOWN * inputs_nm);
        strangers.push(Stranger { of: LIKE_NOISE, gain, torques: 1, choice: 0.0, counts: LIKE_NOISE_COUNTS });
    }
    strangers.sort_by(|a, b| b.nats().total_cmp(&a.nats()));
    strangers
}

/// What a solution leaves of a residual.
fn less(residual: &[f64], solution: Option<&Solution>, fixed: &Linear, others: &[Vec<f32>]) -> Vec<f64> {
    let mut left = residual.to_vec();
    let coefficients = solution.iter().flat_map(|solution| solution.coefficients.iter());
    for (coefficient, column) in coefficients.zip(fixed.columns().into_iter().chain(slices(others))) {
        left.iter_mut().zip(column).for_each(|(left, own)| *left -= coefficient * f64::from(*own));
    }
    left
}

/// How far the channels agree on a torque, in standard deviations, beyond what noise of the logged inputs is to the
/// gimbal; none of it where the bearing turns around.
fn agreement(problem: &Problem, fit: &Fit, steady: &[bool], inputs_nm: f64) -> f64 {
    let mut residual = fit.residual.clone();
    let rows = residual.chunks_exact_mut(problem.record.channels.len());
    for (row, _) in rows.zip(steady).filter(|(_, steady)| !**steady) {
        row.fill(0.0);
    }
    problem.path.agreement(&problem.whitener, &residual, AGREED_HZ, inputs_nm).max(0.0)
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
