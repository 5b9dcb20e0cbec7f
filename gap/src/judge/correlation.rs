//! Which fitted values move together, and which stand at the end of their range.

use gimbal_plant::{Bound, Effect};

use super::spread::Spread;
use crate::fit::{Fit, Problem};

/// Correlations are told from this size on.
const TOLD: f64 = 0.3;
/// How near the end of its range a value stands at it, relative.
const AT_END: f64 = 0.02;

/// A fitted value and another one that moves with it.
#[derive(Debug, Clone, PartialEq)]
pub struct Correlation {
    /// Effect and parameter.
    pub value: String,
    /// Another one, or a nominal parameter.
    pub other: String,
    /// Of their errors, -1 to 1.
    pub correlation: f64,
}

/// Correlations of the values of a fit, the strongest three of each.
#[must_use]
pub fn correlations(spread: &Spread) -> Vec<Correlation> {
    let Spread { names, begin, own, covariance, .. } = spread;
    let of = |a: usize, b: usize| covariance[(a, b)] / (covariance[(a, a)] * covariance[(b, b)]).max(1e-300).sqrt();
    own.iter()
        .flat_map(|&value| {
            let mut all: Vec<(usize, f64)> = (*begin..names.len())
                .filter(|other| *other != value)
                .map(|other| (other, of(value, other)))
                .filter(|(_, correlation)| correlation.abs() > TOLD)
                .collect();
            all.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
            all.truncate(3);
            all.into_iter().map(move |(other, correlation)| (value, other, correlation))
        })
        .map(|(value, other, correlation)| Correlation {
            value: names[value].clone(),
            other: names[other].clone(),
            correlation,
        })
        .collect()
}

/// Values at the end of their range: of an effect's shape, or a nominal parameter's at its tolerance.
#[must_use]
pub fn bounds_hit(problem: &Problem, fit: &Fit) -> Vec<String> {
    let mut told = Vec::new();
    for (place, effect) in fit.effects.iter().enumerate() {
        let Some(entry) = Effect::from_name(effect) else { continue };
        for (parameter, value) in entry.parameters().iter().zip(&fit.values[place]).skip(entry.sizes()) {
            let end = if *value <= parameter.low * (1.0 + AT_END) { parameter.low } else { parameter.high };
            let beyond = *value <= parameter.low * (1.0 + AT_END) || *value >= parameter.high * (1.0 - AT_END);
            if beyond && parameter.bound != Bound::Any {
                told.push(format!("{effect} {} is {value:.2e}, its range ends at {end:.2e}", parameter.name));
            }
        }
    }
    let released: Vec<&str> = fit.set.0.iter().flat_map(|&index| problem.candidates[index].releases).copied().collect();
    for (nuisance, shift) in problem.nuisances.iter().zip(&fit.shifts) {
        if shift.abs() >= (1.0 - AT_END) * nuisance.tolerance && !released.contains(&nuisance.name) {
            told.push(format!("{} is at the end of its tolerance", nuisance.name));
        }
    }
    told
}
