//! What every set is worth to all logs together, by the rules for one log: the same costs, the same reasons against it.

use gimbal_model_file::Tolerance;

use super::climb::Fitted;
use super::extend::Promise;
use super::material::Material;
use super::parameters::Unit;
use crate::fit::{closed_at, is_idle};
use crate::judge::{
    HELPS, NEVER, Weighed, at_a_bound, beyond, carried_by_one_log, carried_by_one_stretch, caution, costs_of, is_part,
    worth_their_more,
};

/// Sets in the order of their fits, then effects that were only looked at.
pub(super) fn weigh(
    materials: &[Material],
    null: &Fitted,
    fits: &[Fitted],
    promises: &[Promise],
    tolerance: &Tolerance,
) -> Vec<Weighed> {
    let caution = materials.iter().map(|material| caution(&material.problem)).fold(f64::INFINITY, f64::min);
    let of = |(index, fitted): (usize, &Fitted)| {
        let (cost, rare) = costs_of(&fitted.effects.names, caution);
        let nats = fitted.worth()
            - null.worth()
            - alone(null, fits, fitted)
            - against(materials, null, fits, fitted, tolerance);
        Weighed { effects: fitted.effects.names.clone(), fit: Some(index), nats, cost, rare }
    };
    let mut all: Vec<Weighed> = fits.iter().enumerate().map(of).collect();
    // what a set has more than a smaller one must be worth it: a nominal parameter that is each log's own may take the
    // place of an effect, and its prior tells how far it goes
    let left = |fitted: &Fitted| fitted.squares.iter().sum::<f64>() + fitted.prior;
    let closest = fits.iter().chain([null]).map(left).fold(f64::MAX, f64::min);
    let noise: f64 = materials.iter().map(|material| closed_at(&material.problem)).sum();
    worth_their_more(&mut all, [left(null), closest, noise], |index| left(&fits[index]), |_, _| false);
    for promise in promises {
        let effects = vec![promise.candidate.effect];
        if !all.iter().any(|set| set.effects == effects) {
            let (cost, rare) = costs_of(&effects, caution);
            all.push(Weighed { effects, fit: None, nats: promise.gain, cost, rare });
        }
    }
    all
}

/// What one stretch of one log carries alone, and where effects are each log's own or are likelier so, what one log carries:
/// of a value that all share, the other logs say themselves whether it is theirs too.
fn alone(null: &Fitted, fits: &[Fitted], fitted: &Fitted) -> f64 {
    let names = &fitted.effects.names;
    let smaller = fits
        .iter()
        .filter(|other| is_part(&other.effects.names, names) && other.effects.names.len() + 1 == names.len());
    let has = |fitted: &Fitted| fitted.effects.names.contains(&"torque_saturation");
    let apart = (0..names.len()).map(Unit::Effect).any(|effect| fitted.is_own(effect) || fitted.likelier_own(effect));
    let carried = |from: &Fitted| {
        let gains: Vec<Vec<f64>> = from
            .pieces
            .iter()
            .zip(&fitted.pieces)
            .map(|(from, to)| from.iter().zip(to).map(|(from, to)| from - to).collect())
            .collect();
        let stretch = if has(from) == has(fitted) { carried_by_one_stretch(&gains) } else { 0.0 };
        if apart { stretch.max(carried_by_one_log(&gains)) } else { stretch }
    };
    smaller.chain([null]).map(carried).fold(0.0, f64::max)
}

/// What speaks against a set: an effect of no size, a shape beyond its range, a parameter inside its tolerance.
fn against(materials: &[Material], null: &Fitted, fits: &[Fitted], fitted: &Fitted, tolerance: &Tolerance) -> f64 {
    let of = |(effect, name): (usize, &&'static str)| {
        let known = fitted.known(materials, effect);
        let idle = known.iter().all(|(values, errors)| is_idle(name, values, errors));
        let idle = if idle && !helps(null, fits, fitted, name) { NEVER } else { 0.0 };
        let all = |of: &dyn Fn(&[f64], &[f64]) -> f64| {
            known.iter().map(|(values, errors)| of(values, errors)).fold(f64::MAX, f64::min)
        };
        let released = !crate::library::releases(name).is_empty();
        let problem = &materials[0].problem;
        idle + if !released {
            all(&|values, errors| at_a_bound(name, values, errors))
        } else if known.iter().any(|(values, errors)| beyond(problem, tolerance, name, values, errors)) {
            0.0
        } else {
            NEVER
        }
    };
    fitted.effects.names.iter().enumerate().map(of).sum()
}

/// Whether a set is worth more with an effect than without it, though size and shape stand for each other.
fn helps(null: &Fitted, fits: &[Fitted], fitted: &Fitted, effect: &str) -> bool {
    let names = &fitted.effects.names;
    let left = |fitted: &Fitted| fitted.squares.iter().sum::<f64>();
    let without = |other: &&Fitted| {
        let others = &other.effects.names;
        others.len() + 1 == names.len() && is_part(others, names) && !others.contains(&effect)
    };
    let mut smaller = fits.iter().filter(without).chain((names.len() == 1).then_some(null)).peekable();
    smaller.peek().is_some() && smaller.all(|smaller| left(smaller) - left(fitted) > 2.0 * HELPS)
}
