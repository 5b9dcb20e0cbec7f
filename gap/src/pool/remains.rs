//! What the logs keep when all of them are fitted together: whether it goes with something that no effect of the
//! library is asked for, in one log or in all of them.
//!
//! A log's remains count as in its own diagnosis; that it is the strangest of n takes ln n nats off. What torques of no
//! effect take is added up over the logs too: of n logs without one, chance adds up to the root of n times what it makes of
//! one.

use super::climb::Fitted;
use super::material::Material;
use crate::fit::stand;
use crate::judge::{Limits, UNSEEN, left_over, past, strangeness, strangers, unknown};

/// Over all logs.
#[derive(Debug, Clone)]
pub(super) struct Remains {
    /// Probability that no effect of the library is it.
    pub(super) unknown: f64,
    /// Whether something is left that would be told of.
    pub(super) tells: bool,
    /// What it goes with, and how many nats beyond chance.
    pub(super) goes_with: Option<(&'static str, f64)>,
}

/// What one log keeps.
struct Left {
    limits: Limits,
    /// Standard deviations that stand out under the nominal parameters, and under the fit.
    stands_out: [f64; 2],
    /// Torques of no effect, and the nats that they take beyond chance; the most first.
    strange: Vec<(&'static str, f64)>,
}

impl Left {
    fn of(log: usize, material: &Material, null: &Fitted, fitted: &Fitted) -> Self {
        let problem = &material.problem;
        let at = |fitted: &Fitted| stand(problem, &fitted.effects.sets[log], fitted.points[log].clone());
        let (before, after) = rayon::join(|| at(null), || at(fitted));
        Self {
            limits: Limits::of(problem),
            stands_out: [&before, &after].map(|fit| left_over(problem, &fit.residual)),
            strange: strangers(problem, &after).iter().map(|own| (own.of, own.nats())).collect(),
        }
    }

    fn strangest(&self) -> f64 {
        self.strange.first().map_or(0.0, |(_, nats)| *nats)
    }

    fn tells(&self) -> bool {
        self.limits.are_passed(self.stands_out[1], self.strangest())
    }
}

/// Of a fit, beside that of the nominal parameters alone. Where nothing is named, a log that an effect of its own explains
/// (`explained`) keeps nothing.
pub(super) fn remains(materials: &[Material], null: &Fitted, fitted: &Fitted, explained: &[usize]) -> Remains {
    let found = !fitted.effects.names.is_empty();
    let taken = 0.5 * (null.squares.iter().sum::<f64>() - fitted.squares.iter().sum::<f64>());
    // one log at a time: each asks for a library of torques
    let asked = materials.iter().enumerate().filter(|(_, material)| found || !explained.contains(&material.log));
    let mut each: Vec<Left> = asked.map(|(log, material)| Left::of(log, material, null, fitted)).collect();
    let choice = (each.len().max(1) as f64).ln();
    for left in &mut each {
        left.limits.strange += choice;
    }
    let of_strange = |nats: f64, shown: f64| unknown(shown, nats / (nats + taken).max(1e-9), found);
    let of_log = |left: &Left| {
        let (limits, [before, after]) = (&left.limits, left.stands_out);
        let share = after / before.max(after).max(1e-9);
        let left_over = past(after, limits.left_over, limits.left_over_scale);
        let strange = left.strangest();
        let strangers = of_strange(strange, past(strange, limits.strange, limits.strange_scale));
        unknown(left_over, share, found).max(strangers)
    };
    let root = (each.len() as f64).sqrt();
    let highest = |of: fn(&Limits) -> f64| root * each.iter().map(|left| of(&left.limits)).fold(0.0, f64::max);
    let (limit, scale) = (highest(|limits| limits.strange), highest(|limits| limits.strange_scale));
    let most = summed(&each).into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let strange = most.map_or(0.0, |(_, nats)| nats);
    // what is small is told by all logs together, not by the one that shows most of it by chance
    let of_all = of_strange(strange, strangeness(strange, limit, scale));
    Remains {
        unknown: each.iter().map(of_log).fold(UNSEEN.max(of_all), f64::max),
        tells: each.iter().any(Left::tells) || strange > limit + scale,
        goes_with: most.filter(|(_, nats)| *nats > limit),
    }
}

/// What each group takes in all logs.
fn summed(each: &[Left]) -> Vec<(&'static str, f64)> {
    let mut sums: Vec<(&'static str, f64)> = Vec::new();
    for (of, nats) in each.iter().flat_map(|left| &left.strange) {
        match sums.iter_mut().find(|(other, _)| other == of) {
            Some((_, sum)) => *sum += nats,
            None => sums.push((of, *nats)),
        }
    }
    sums
}
