//! An effect more in a fit, in the formulation of it that leaves least.

use std::cmp::Ordering;

use rayon::prelude::*;

use super::extension::{Extension, first_of_each};
use super::hypothesis::{Point, left};
use super::walk::Effort;
use super::{Fit, Problem, Set, refine};
use crate::library::NAMED;

/// Formulations of an effect that are fitted.
const FORMULATIONS: usize = 2;
/// Values over that of a grid that are tried about it.
const FINER: [f64; 5] = [0.6, 0.77, 1.0, 1.3, 1.7];
/// The other formulations of an effect: what says so, and its second value over that of the first formulation where the two
/// come nearest to each other (least squares over a loop's outer branch; half of the excess).
const OTHERS: [(&str, &[(f64, f64)]); 2] =
    [("cable_hysteresis", &[(1.0, 0.8), (2.0, 0.9), (3.0, 1.15)]), ("stribeck", &[(1.0, 1.2), (2.0, 0.83)])];

/// Place of the value that says which.
const WAY: usize = 2;

/// A fit with one candidate more, in the formulation that leaves least.
pub(super) fn extend(problem: &Problem, from: &Fit, extension: &Extension) -> Option<Fit> {
    Some(otherwise(problem, from, extension, first(problem, from, extension)?))
}

/// A fit with one candidate more in its first formulation.
pub(super) fn first(problem: &Problem, from: &Fit, extension: &Extension) -> Option<Fit> {
    let candidate = &problem.candidates[extension.index];
    // a chord of pre-sliding misleads: its settings are tried as they are, and before a fit its formulations are hardly
    // told apart
    let starts = if candidate.effect == "presliding" {
        settings(problem, from, candidate.effect)
    } else {
        vec![(extension.index, candidate.values(&extension.amplitudes))]
    };
    starts.into_par_iter().map(|(index, own)| with(problem, from, index, own)).min_by(closer)
}

/// The same in another formulation where that leaves less. They are tried where the first could be named, from the same place: a
/// prior is about where a fit begins.
pub(super) fn otherwise(problem: &Problem, from: &Fit, extension: &Extension, first: Fit) -> Fit {
    if from.cost() - first.cost() < 2.0 * NAMED {
        return first;
    }
    let other = |(way, ratio): &(f64, f64)| {
        let mut own = problem.candidates[extension.index].values(&extension.amplitudes);
        own[1] *= ratio;
        own.resize(own.len().max(WAY + 1), 0.0);
        own[WAY] = *way;
        with(problem, from, extension.index, own)
    };
    let other = others(problem, extension).par_iter().map(other).min_by(closer);
    match other {
        Some(other) if other.cost() < first.cost() => other,
        _ => first,
    }
}

/// The other formulations of an effect.
fn others(problem: &Problem, extension: &Extension) -> &'static [(f64, f64)] {
    let effect = problem.candidates[extension.index].effect;
    OTHERS.iter().find(|(own, _)| *own == effect).map_or(&[], |(_, others)| others)
}

/// Which of two fits leaves less, what its shifts cost counted.
pub(super) fn closer(a: &Fit, b: &Fit) -> Ordering {
    a.cost().total_cmp(&b.cost())
}

/// A fit with one candidate more, from values of it.
fn with(problem: &Problem, from: &Fit, index: usize, own: Vec<f64>) -> Fit {
    let (set, values) = extended(from, index, own);
    let fit = refine(problem, &set, &values, Some(from), Effort::Quick);
    if from.set.0.is_empty() && fit.is_held(problem) {
        // it began where nominal parameters went that far for want of the effect, and the walls that hold them let it go
        // back by small steps alone
        let anew = refine(problem, &set, &fit.values, None, Effort::Quick);
        return std::cmp::min_by(fit, anew, closer);
    }
    fit
}

/// Of the formulations of an effect the ones that leave least beside a fit, each with the setting that does, looked for
/// once more about the best of its grid; where walls hold the fit's nominal parameters, which went there for want of the
/// effect, or beside the nominal model.
fn settings(problem: &Problem, from: &Fit, effect: &str) -> Vec<(usize, Vec<f64>)> {
    let of_effect = problem.candidates.iter().enumerate().filter(|(_, candidate)| candidate.effect == effect);
    let grid: Vec<(usize, Vec<f64>)> =
        of_effect.map(|(index, candidate)| (index, candidate.probes[0].0.clone())).collect();
    let best = best_of_each(problem, from, grid);
    let finer = |(index, own): &(usize, Vec<f64>)| {
        let (index, own) = (*index, own.clone());
        FINER.map(|share| (index, [&[share * own[0]], &own[1..]].concat()))
    };
    let mut all = best_of_each(problem, from, best.iter().flat_map(finer).collect());
    all.truncate(FORMULATIONS);
    all
}

/// The setting of each formulation that leaves least, the best first.
fn best_of_each(problem: &Problem, from: &Fit, places: Vec<(usize, Vec<f64>)>) -> Vec<(usize, Vec<f64>)> {
    let point = from.point(problem);
    let beside = |shifts: &[f64]| {
        let tried = |(index, own): &(usize, Vec<f64>)| {
            let (set, values) = extended(from, *index, own.clone());
            (set, Point { values, shifts: shifts.to_vec(), ..point.clone() })
        };
        left(problem, &places.iter().map(tried).collect::<Vec<_>>())
    };
    let mut least = beside(&point.shifts);
    if from.is_held(problem) {
        let of_nominal = beside(&vec![0.0; point.shifts.len()]);
        least.iter_mut().zip(of_nominal).for_each(|(least, own)| *least = least.min(own));
    }
    let mut all: Vec<(f64, (usize, Vec<f64>))> = least.into_iter().zip(places).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    first_of_each(&mut all, |(_, (_, own))| own.get(1).copied());
    all.into_iter().map(|(_, setting)| setting).collect()
}

/// A fit's set and values with one candidate more.
fn extended(from: &Fit, index: usize, own: Vec<f64>) -> (Set, Vec<Vec<f64>>) {
    let (mut set, mut values) = (from.set.clone(), from.values.clone());
    set.0.push(index);
    values.push(own);
    (set, values)
}
