//! How well the values of a fit are known: the covariance of all that is fitted.
//!
//! ```text
//! C = (J' J / t + P)^-1        t = max(1, |r|^2 / n), P the precision of every prior as wide as its tolerance
//! ```
//!
//! A fit leads a nominal parameter to the end of its tolerance and holds it there; it is not known any better for that, so
//! the walls that held it are no part of P. J is taken where the fit stands: how far a lag, a delay and how much of it is pure
//! stand for each other is another matter there than at the nominal model. It says nothing along scales that no log tells.

use gimbal_plant::Effect;
use nalgebra::DMatrix;

use super::decide::Found;
use super::scale::silent;
use crate::fit::{Fit, Hypothesis, Linear, Problem, solve, standard_errors};

/// How far apart the values lie that other formulations of an effect mean by the same parameter, relative: with which power
/// of the rate an excess dies away (1.5 to 2.5), where a yield ends, what a loop encloses, when a slow change is over, whether
/// a spring hardens; and how far off a line leads from a ceiling, on which all that follows hangs.
const MEANINGS: [(&str, &str, f64); 9] = [
    ("stribeck", "excess_nm", 0.1),
    ("stribeck", "rate_radps", 0.05),
    ("cable_spring", "stiffness_nm_per_rad", 0.02),
    ("presliding", "displacement_rad", 0.1),
    ("cable_hysteresis", "displacement_rad", 0.15),
    ("cable_hysteresis", "torque_nm", 0.15),
    ("friction_drift", "time_constant_s", 0.25),
    ("friction_drift", "ratio", 0.08),
    ("torque_saturation", "limit_nm", 0.01),
];

/// The covariance of a fit: of the beginning, of the nominal parameters, of the values of its effects.
#[derive(Debug)]
pub struct Spread {
    /// What each row is.
    pub(super) names: Vec<String>,
    /// Row of the first nominal parameter.
    pub(super) begin: usize,
    /// Rows of the values of the effects.
    pub(super) own: Vec<usize>,
    pub(super) covariance: DMatrix<f64>,
    /// Standard errors of the values of each effect.
    pub errors: Vec<Vec<f64>>,
}

impl Spread {
    /// Of a fit; none where it has no effect, or its equations have no solution.
    #[must_use]
    pub fn new(problem: &Problem, fit: &Fit) -> Option<Self> {
        let hypothesis = Hypothesis::new(problem, &fit.set, &fit.values);
        let (begin, fixed) = (problem.columns.begin, hypothesis.fixed());
        if fit.set.0.is_empty() {
            return None;
        }
        let mut names: Vec<String> = (0..begin).map(|_| "the beginning".to_owned()).collect();
        names.extend(problem.nuisances.iter().map(|own| own.name.to_owned()));
        let mut weights = hypothesis.precision.clone();
        let mut own = Vec::new();
        for (effect, &index) in fit.set.0.iter().enumerate() {
            let candidate = &problem.candidates[index];
            let released = candidate.releases.iter().filter_map(|release| problem.nuisance(release));
            own.extend(released.map(|at| begin + at));
            let parameters = Effect::from_name(candidate.effect).map_or(&[][..], |entry| entry.parameters());
            for (place, free) in hypothesis.free.iter().enumerate().filter(|(_, free)| free.effect == effect) {
                let Some(parameter) = parameters.get(free.value) else {
                    names.push("the beginning".to_owned());
                    weights.push(free.precision());
                    continue;
                };
                own.push(fixed + place);
                names.push(format!("{} {}", candidate.effect, parameter.name));
                let spread = 0.5 * parameter.low.abs().max(parameter.high.abs());
                weights.push(if free.log { 1.0 } else { spread.powi(-2) });
            }
        }
        let (point, now) = (fit.point(problem), &fit.prediction);
        let linear = Linear::fresh(&hypothesis, &point, now);
        let (mut gram, mut drive) = linear.joined(&hypothesis.sensitivities(&point, now), &fit.residual);
        let temper = (fit.square / problem.whitener.count() as f64).max(1.0);
        gram = silent(gram / temper, &weights, problem, &hypothesis, fit);
        drive /= temper;
        let chosen: Vec<usize> = (0..drive.len()).collect();
        let covariance = solve(&gram, &drive, &chosen, &weights)?.covariance;
        let errors = standard_errors(&hypothesis, &fit.values, &fit.shifts, &covariance);
        Some(Self { names, begin, own, covariance, errors })
    }

    /// Widens the errors of what was found to what is known of each value, and to what its parameter means.
    pub(crate) fn widen(&self, found: &mut [Found]) {
        for (found, errors) in found.iter_mut().zip(&self.errors) {
            let Some(entry) = Effect::from_name(found.effect) else { continue };
            let own = found.errors.iter_mut().zip(&found.values).zip(errors);
            for (((error, value), wide), parameter) in own.zip(entry.parameters()) {
                let meaning = MEANINGS.iter().find(|own| (own.0, own.1) == (found.effect, parameter.name));
                *error = error.max(wide.abs()).hypot(meaning.map_or(0.0, |own| own.2 * value));
            }
        }
    }
}
