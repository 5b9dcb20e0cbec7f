//! What is fitted in several logs at once: nominal parameters, then the values of effects, in one list for all logs.

use crate::fit::{Goes, Hypothesis};
use crate::library::Nuisance;

/// What is known of a parameter before any log.
#[derive(Debug, Clone)]
pub(super) enum Prior {
    /// A normal distribution.
    Around { center: f64, precision: f64 },
    /// Of a nominal parameter: flat inside its tolerance, a wall beyond it.
    Nominal(Nuisance),
}

impl Prior {
    /// Half the curvature of the cost, and half its slope at zero with the other sign, of the parabola that holds at
    /// `ahead`.
    pub(super) fn parabola(&self, ahead: f64) -> (f64, f64) {
        match self {
            Self::Around { center, precision } => (*precision, precision * center),
            Self::Nominal(nuisance) => {
                let (slope, curvature, _) = nuisance.prior(0.0, ahead);
                (curvature, -slope)
            }
        }
    }

    /// What a value costs.
    pub(super) fn cost(&self, value: f64) -> f64 {
        match self {
            Self::Around { center, precision } => precision * (value - center).powi(2),
            Self::Nominal(nuisance) => nuisance.prior(value, value).2,
        }
    }

    /// Its precision inside the walls.
    pub(super) fn flat(&self) -> f64 {
        match self {
            Self::Around { precision, .. } => *precision,
            Self::Nominal(nuisance) => nuisance.sigma.powi(-2),
        }
    }

    /// Whether a value is behind a wall.
    pub(super) fn is_beyond(&self, value: f64) -> bool {
        matches!(self, Self::Nominal(nuisance) if nuisance.is_beyond(value))
    }
}

/// What is shared as one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unit {
    /// A nominal parameter.
    Nominal(usize),
    /// All values of an effect of the set.
    Effect(usize),
    /// How an effect begins: each log's own in any case.
    Beginning,
}

/// One coordinate.
#[derive(Debug, Clone)]
pub(super) struct Parameter {
    pub(super) prior: Prior,
    /// Standard deviation of the prior of a size that has no scale of its own.
    pub(super) any_scale: Option<f64>,
    pub(super) unit: Unit,
}

/// The coordinates of a hypothesis, in its order: shifts of the nominal parameters, then free values.
pub(super) fn parameters(hypothesis: &Hypothesis) -> Vec<Parameter> {
    let problem = hypothesis.problem;
    let released = |name: &str| {
        let of = |&index: &usize| problem.candidates[index].releases.contains(&name);
        hypothesis.set.0.iter().position(of)
    };
    let nominal = problem.nuisances.iter().enumerate().map(|(place, nuisance)| {
        let precision = hypothesis.precision[problem.columns.begin + place];
        let freed = released(nuisance.name);
        let prior = match freed {
            Some(_) => Prior::Around { center: 0.0, precision },
            None => Prior::Nominal(*nuisance),
        };
        Parameter { prior, any_scale: None, unit: freed.map_or(Unit::Nominal(place), Unit::Effect) }
    });
    let values = hypothesis.free.iter().map(|free| Parameter {
        prior: Prior::Around { center: free.center, precision: free.precision() },
        any_scale: free.any_scale.then_some(free.sigma),
        unit: if free.goes == Goes::Within { Unit::Beginning } else { Unit::Effect(free.effect) },
    });
    nominal.chain(values).collect()
}
