//! How well the values of a fit are known: the covariance of all that is fitted.
//!
//! ```text
//! C = (J' J / t + P)^-1        t = max(1, |r|^2 / n), P the precision of every prior as wide as its tolerance
//! ```
//!
//! A fit leads a nominal parameter to the end of its tolerance and holds it there; it is not known any better for that, so
//! the walls that held it are no part of P.

use gimbal_plant::{Bound, Effect};
use nalgebra::DMatrix;

use super::decide::Found;
use crate::fit::{Fit, Linear, Problem, solve};

/// How far apart the values lie that other formulations of an effect mean by the same parameter, relative: where a yield
/// ends, what a loop encloses, when a slow change is over; and how far off a line leads from a ceiling, on which all that
/// follows hangs.
const MEANINGS: [(&str, &str, f64); 6] = [
    ("presliding", "displacement_rad", 0.1),
    ("cable_hysteresis", "displacement_rad", 0.2),
    ("cable_hysteresis", "torque_nm", 0.1),
    ("friction_drift", "time_constant_s", 0.15),
    ("friction_drift", "ratio", 0.05),
    ("torque_saturation", "limit_nm", 0.01),
];

/// The covariance of a fit: of the beginning, of the nominal parameters, of the values of its effects.
#[derive(Debug)]
pub struct Spread {
    /// What each row is.
    pub(super) names: Vec<String>,
    /// Row of the first nominal parameter.
    pub(super) begin: usize,
    /// Rows of the values of each effect.
    pub(super) own: Vec<Vec<usize>>,
    pub(super) covariance: DMatrix<f64>,
}

impl Spread {
    /// Of a fit; none where its equations have no solution.
    #[must_use]
    pub fn new(problem: &Problem, fit: &Fit) -> Option<Self> {
        let begin = problem.columns.begin;
        let fixed = begin + problem.columns.nuisances;
        let mut names: Vec<String> = (0..begin).map(|_| "the beginning".to_owned()).collect();
        names.extend(problem.nuisances.iter().map(|own| own.name.to_owned()));
        let (_, precision) = problem.chosen(&fit.set.0);
        let mut weights = precision[..fixed].to_vec();
        let mut own: Vec<Vec<usize>> = Vec::new();
        for (place, &index) in fit.set.0.iter().enumerate() {
            let candidate = &problem.candidates[index];
            let released = candidate.releases.iter().filter_map(|release| problem.nuisance(release));
            own.push(released.map(|at| begin + at).collect());
            let Some(entry) = Effect::from_name(candidate.effect).filter(|_| candidate.releases.is_empty()) else {
                continue;
            };
            for (value, parameter) in entry.parameters().iter().enumerate() {
                own[place].push(names.len());
                names.push(format!("{} {}", candidate.effect, parameter.name));
                let spread = 0.5 * parameter.low.abs().max(parameter.high.abs());
                weights.push(if in_logarithm(parameter.bound, fit.values[place][value]) {
                    1.0
                } else {
                    spread.powi(-2)
                });
            }
        }
        if names.len() != fixed + fit.sensitivities.len() {
            return None;
        }
        let (mut gram, mut drive) = Linear::of(problem).joined(&fit.sensitivities, &fit.residual);
        let temper = (fit.square / problem.whitener.count() as f64).max(1.0);
        gram /= temper;
        drive /= temper;
        let chosen: Vec<usize> = (0..drive.len()).collect();
        let covariance = solve(&gram, &drive, &chosen, &weights)?.covariance;
        Some(Self { names, begin, own, covariance })
    }

    /// Widens the errors of what was found to what is known of each value, and to what its parameter means.
    pub(crate) fn widen(&self, problem: &Problem, fit: &Fit, found: &mut [Found]) {
        for ((found, rows), &index) in found.iter_mut().zip(&self.own).zip(&fit.set.0) {
            let Some(entry) = Effect::from_name(found.effect) else { continue };
            let releases = problem.candidates[index].releases;
            for (place, (error, &row)) in found.errors.iter_mut().zip(rows).enumerate() {
                let sigma = self.covariance[(row, row)].max(0.0).sqrt();
                let (value, parameter) = (found.values[place], entry.parameters()[place]);
                let own = match releases.get(place).and_then(|release| problem.nuisance(release)) {
                    Some(nuisance) => {
                        let change =
                            |by: f64| problem.nuisances[nuisance].change(&problem.base, fit.shifts[nuisance] + by);
                        change(sigma) - change(0.0)
                    }
                    None if in_logarithm(parameter.bound, value) => sigma * value.abs(),
                    None => sigma,
                };
                let meaning = MEANINGS.iter().find(|own| (own.0, own.1) == (found.effect, parameter.name));
                *error = error.max(own.abs()).hypot(meaning.map_or(0.0, |own| own.2 * value));
            }
        }
    }
}

fn in_logarithm(bound: Bound, value: f64) -> bool {
    bound != Bound::Any && value > 0.0
}
