//! What the logs share and what is each run's own: everything is shared until the logs speak against it.
//!
//! ```text
//! worth = evidence - 15 for every nominal parameter, - 5 for every effect that is each log's own        [nats]
//! ```
//!
//! A nominal parameter belongs to the platform: that it changes from run to run is a finding as heavy as its name.

use super::climb::{Fitted, climb, hypotheses, placed};
use super::joint::{Joint, solve};
use super::material::Material;
use super::parameters::{Parameter, Unit};
use super::set::Effects;
use crate::fit::Point;
use crate::judge::{COST_OF_SHIFT, RARE_SHIFT};

/// How often something may be set free, or taken together again.
const CHANGES: usize = 6;
/// What a change must promise to be tried [nats].
const PROMISE: f64 = 1.0;

/// What it costs that something is each log's own [nats].
fn cost(unit: Unit) -> f64 {
    match unit {
        Unit::Nominal(_) => COST_OF_SHIFT,
        Unit::Effect(_) => RARE_SHIFT,
        Unit::Beginning => 0.0,
    }
}

/// Everything that is shared as one.
fn units(parameters: &[Parameter]) -> Vec<Unit> {
    let mut units: Vec<Unit> = Vec::new();
    for parameter in parameters {
        if parameter.unit != Unit::Beginning && !units.contains(&parameter.unit) {
            units.push(parameter.unit);
        }
    }
    units
}

/// The same sharing with one unit the other way round.
pub(super) fn toggled(parameters: &[Parameter], own: &[bool], unit: Unit) -> Vec<bool> {
    parameters.iter().zip(own).map(|(parameter, own)| (parameter.unit == unit) != *own).collect()
}

impl Fitted {
    /// Whether something is each log's own.
    pub(super) fn is_own(&self, unit: Unit) -> bool {
        self.parameters.iter().zip(&self.own).any(|(parameter, own)| *own && parameter.unit == unit)
    }

    /// What it costs that some things are each log's own [nats].
    fn apart(&self) -> f64 {
        units(&self.parameters).into_iter().filter(|unit| self.is_own(*unit)).map(cost).sum()
    }

    /// Evidence less what is each log's own [nats].
    pub(super) fn worth(&self) -> f64 {
        self.evidence - self.apart()
    }

    /// What the parabolas promise of another sharing, over this one [nats].
    fn promised(&self, own: &[bool], logs: usize) -> Option<(f64, Joint)> {
        let joint = solve(&self.locals, &self.parameters, own)?;
        let of = |joint: &Joint, own: &[bool]| {
            joint.volume - 0.5 * joint.cost - self.effects.searched(own, &self.parameters, logs)
        };
        Some((of(&joint, own) - of(&self.joint, &self.own), joint))
    }

    /// Whether something that is shared would be likelier as each log's own, by the parabolas; if too little to be set free.
    pub(super) fn likelier_own(&self, unit: Unit) -> bool {
        let own = toggled(&self.parameters, &self.own, unit);
        !self.is_own(unit) && self.promised(&own, self.points.len()).is_some_and(|(gain, _)| gain > 0.0)
    }

    /// The same set with one unit shared that was each log's own, or the other way round.
    pub(super) fn with_toggled(&self, materials: &[Material], unit: Unit, starts: &[Vec<Point>]) -> Option<Self> {
        let own = toggled(&self.parameters, &self.own, unit);
        let mut from = if self.is_own(unit) {
            // what is shared from now on begins with one value
            let joint = solve(&self.locals, &self.parameters, &own)?;
            let hypotheses = hypotheses(materials, &self.effects);
            let points = hypotheses.iter().zip(&self.points).zip(&joint.x);
            vec![points.map(|((hypothesis, point), x)| placed(hypothesis, point, x)).collect()]
        } else {
            vec![self.points.clone()]
        };
        if !self.is_own(unit) {
            from.extend(starts.iter().cloned());
        }
        climb(materials, &self.effects, &own, from)
    }
}

/// Fits a set with everything shared, then sets free what the logs do not share. `apart` are points to begin with where
/// the effects are each log's own.
pub(super) fn fitted(
    materials: &[Material],
    effects: &Effects,
    starts: Vec<Vec<Point>>,
    apart: &[Vec<Point>],
) -> Option<Fitted> {
    let all = hypotheses(materials, effects).first().map(super::parameters::parameters)?;
    let shared: Vec<bool> = all.iter().map(|parameter| parameter.unit == Unit::Beginning).collect();
    let mut best = climb(materials, effects, &shared, starts)?;
    let mut failed: Vec<Unit> = Vec::new();
    for _ in 0..CHANGES {
        let change = |unit: Unit| {
            let own = toggled(&best.parameters, &best.own, unit);
            let (gain, _) = best.promised(&own, materials.len())?;
            Some((unit, gain + if best.is_own(unit) { cost(unit) } else { -cost(unit) }))
        };
        let promising = units(&best.parameters).into_iter().filter(|unit| !failed.contains(unit)).filter_map(change);
        let Some((unit, _)) = promising.filter(|(_, gain)| *gain > PROMISE).max_by(|a, b| a.1.total_cmp(&b.1)) else {
            break;
        };
        // the values that a log's own fit found serve the effects
        let starts = if matches!(unit, Unit::Effect(_)) && effects.names.len() == 1 { apart } else { &[] };
        match best.with_toggled(materials, unit, starts) {
            Some(next) if next.worth() > best.worth() => best = next,
            _ => failed.push(unit),
        }
    }
    Some(best)
}
