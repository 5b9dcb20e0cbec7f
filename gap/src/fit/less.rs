//! Backwards from the best sets: without one of their members, or with one in its place that is simpler or much like it.

use gimbal_plant::Effect;
use rayon::prelude::*;

use super::extension::{Extension, best_by_effect, extensions, promising};
use super::formulations::extend;
use super::search::{AS_MUCH, polish, same};
use super::walk::Effort;
use super::{Fit, Problem, Set, refine};
use crate::simulate::GRAVITY_MPS2;

/// Sets that are looked at.
const LOOKED_AT: usize = 3;
/// What a set may cost over the best one to be fitted to its end.
const NEAR: f64 = 1.02;
/// Effects that are tried in the place of one.
const OTHERS: usize = 2;

/// Sets near the best that are less than one that was fitted start where that one ended.
pub(super) fn with_less(problem: &Problem, fits: &mut Vec<Fit>) {
    let least = fits.first().map_or(0.0, Fit::cost);
    let less: Vec<Fit> = fits
        .iter()
        .enumerate()
        .take(LOOKED_AT)
        .flat_map(|(index, fit)| {
            let others = [straightened, levelled, as_constant].into_iter().filter_map(|of| of(problem, fit));
            let near = lesser(fit, index == 0).chain(others).map(move |less| (fit, less, false));
            near.chain(late_otherwise(problem, fit).map(move |less| (fit, less, true)))
        })
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|(from, (set, values), is_far)| {
            let from = beginning(problem, from, &set, &values);
            let quick = || refine(problem, &set, &values, Some(&from), Effort::Quick);
            let mut fit = if is_far { from_afar(problem, &set, &values, &from) } else { quick() };
            if fit.cost() < NEAR * least {
                polish(problem, &mut fit);
            }
            fit
        })
        .collect();
    for fit in less {
        take_in(problem, fits, fit);
    }
}

/// Sets with another effect in the place of one of the best set's, where the others lead to one that may come to as much: a
/// set grows by what is best at the time.
pub(super) fn with_another(problem: &Problem, null: &Fit, fits: &mut Vec<Fit>) {
    let Some(best) = fits.first().filter(|best| best.set.0.len() > 1) else { return };
    let temper = problem.formulation(best, null);
    let is_less = |fit: &&Fit| {
        fit.set.0.len() + 1 == best.set.0.len() && fit.effects.iter().all(|effect| best.effects.contains(effect))
    };
    let less: Vec<&Fit> = fits.iter().filter(is_less).collect();
    let others: Vec<Fit> = less
        .into_par_iter()
        .flat_map(|less| {
            let behind = best.evidence(temper) - less.evidence(temper);
            let leads = |extension: &Extension| {
                let effect = problem.candidates[extension.index].effect;
                promising(problem, extension) && !best.effects.contains(&effect) && extension.gain > AS_MUCH * behind
            };
            let mut next = best_by_effect(problem, extensions(problem, less), usize::MAX);
            next.retain(leads);
            next.truncate(OTHERS);
            next.into_par_iter().filter_map(|extension| {
                let mut fit = extend(problem, less, &extension)?;
                if fit.cost() < NEAR * best.cost() {
                    polish(problem, &mut fit);
                }
                Some(fit)
            })
        })
        .collect();
    for fit in others {
        take_in(problem, fits, fit);
    }
}

/// With one fit more, in the place of those of the same effects that leave more.
fn take_in(problem: &Problem, fits: &mut Vec<Fit>, fit: Fit) {
    fits.retain(|other| !same(problem, &other.set, &fit.set) || other.cost() < fit.cost());
    if !fits.iter().any(|other| same(problem, &other.set, &fit.set)) {
        fits.push(fit);
    }
}

/// The better of two fits to their ends, from a beginning and from the same with the nominal parameters as they should be: where
/// these have made up for the rest, few steps do not lead back.
fn from_afar(problem: &Problem, set: &Set, values: &[Vec<f64>], from: &Fit) -> Fit {
    let mut nominal = from.clone();
    nominal.shifts.fill(0.0);
    let [fit, other] = [from, &nominal].map(|from| refine(problem, set, values, Some(from), Effort::Thorough));
    if other.volume.is_finite() && other.cost() < fit.cost() { other } else { fit }
}

/// A fit with nominal parameters that another set does not release inside of their tolerances, and with those that it
/// releases where its values have them.
fn beginning(problem: &Problem, fit: &Fit, set: &Set, values: &[Vec<f64>]) -> Fit {
    let mut from = fit.clone();
    for index in fit.set.0.iter().filter(|index| !set.0.contains(index)) {
        for place in problem.candidates[*index].releases.iter().filter_map(|name| problem.nuisance(name)) {
            from.shifts[place] = problem.nuisances[place].within(from.shifts[place]);
        }
    }
    for (index, values) in set.0.iter().zip(values).filter(|(index, _)| !fit.set.0.contains(index)) {
        for (place, shift) in problem.released(*index, values) {
            from.shifts[place] += shift;
        }
    }
    from
}

/// A set without one of its members: one that is zero within its error was only the better way down, and each of the best
/// may be one more.
fn lesser(fit: &Fit, best: bool) -> impl Iterator<Item = (Set, Vec<Vec<f64>>)> {
    let members = if fit.set.0.len() > 1 { fit.set.0.len() } else { 0 };
    (0..members).filter(move |&place| best || fit.is_idle(place)).map(|place| {
        let (mut set, mut values) = (fit.set.clone(), fit.values.clone());
        set.0.remove(place);
        values.remove(place);
        (set, values)
    })
}

/// A set whose cable has a loop longer than any is, with a spring in its place.
fn straightened(problem: &Problem, fit: &Fit) -> Option<(Set, Vec<Vec<f64>>)> {
    let place = at(fit, "cable_hysteresis")?;
    let longest_rad = Effect::from_name("cable_hysteresis")?.parameters()[1].high;
    let &[torque_nm, displacement_rad, ..] = fit.values[place].as_slice() else { return None };
    if displacement_rad < longest_rad {
        return None;
    }
    exchanged(problem, fit, place, "cable_spring", torque_nm / displacement_rad)
}

/// A set whose motor lags more than it should, with a delay of as long in its place, or the other way round: the one hides the other
/// where nominal parameters make up for the rest.
fn late_otherwise(problem: &Problem, fit: &Fit) -> Option<(Set, Vec<Vec<f64>>)> {
    let lag_s = problem.base.config.servo.motor_lag_s;
    let (place, instead, value) = match (at(fit, "motor_lag"), at(fit, "loop_delay")) {
        (Some(place), None) => (place, "loop_delay", fit.values[place][0] * lag_s),
        (None, Some(place)) => (place, "motor_lag", fit.values[place][0] / lag_s),
        _ => return None,
    };
    if value > 0.0 { exchanged(problem, fit, place, instead, value) } else { None }
}

/// A set whose friction is higher at whatever rate or load the log has, with a level of as much in that place: from the nominal
/// one that is a long way, which the excess or the load's share may have found shorter.
fn levelled(problem: &Problem, fit: &Fit) -> Option<(Set, Vec<Vec<f64>>)> {
    let (inputs, rows) = (&problem.record.inputs, problem.record.rows());
    let mean = |of: &dyn Fn(usize) -> f64| (0..rows).map(of).sum::<f64>() / rows as f64;
    let [x_mps2, y_mps2, _] = &inputs.accel_mps2;
    let (place, more) = match (at(fit, "stribeck"), at(fit, "load_dependence")) {
        (Some(place), None) => (place, fit.values[place][0] / mean(&|row| inputs.load_nm[row])),
        (None, Some(place)) => {
            (place, fit.values[place][0] * mean(&|row| x_mps2[row].hypot(y_mps2[row])) / GRAVITY_MPS2)
        }
        _ => return None,
    };
    if more > 0.0 && more.is_finite() { exchanged(problem, fit, place, "friction_level", more) } else { None }
}

/// A set with a constant torque in the place of a torque sensor's bias, or the other way round: a platform that has come to rest
/// under one reads as under the other, and a set that grew by the one never met the other.
fn as_constant(problem: &Problem, fit: &Fit) -> Option<(Set, Vec<Vec<f64>>)> {
    let (place, instead) = match (at(fit, "torque_bias"), at(fit, "constant_torque")) {
        (Some(place), None) => (place, "constant_torque"),
        (None, Some(place)) => (place, "torque_bias"),
        _ => return None,
    };
    exchanged(problem, fit, place, instead, fit.values[place][0])
}

/// Place of an effect in a fit.
fn at(fit: &Fit, effect: &str) -> Option<usize> {
    fit.effects.iter().position(|own| *own == effect)
}

/// A set with another effect in the place of one, of such a size; none where it has that one, too.
fn exchanged(problem: &Problem, fit: &Fit, place: usize, instead: &str, size: f64) -> Option<(Set, Vec<Vec<f64>>)> {
    if fit.effects.contains(&instead) {
        return None;
    }
    let (mut set, mut values) = (fit.set.clone(), fit.values.clone());
    set.0[place] = problem.candidates.iter().position(|candidate| candidate.effect == instead)?;
    values[place] = vec![size];
    Some((set, values))
}
