//! One candidate more in a fit, by the linear equations there: what it would add.

use nalgebra::DVector;
use rayon::prelude::*;

use super::normal::{Solution, drive, of_any_scale, slices, solve};
use super::pull::Pull;
use super::{Fit, Problem};

/// How often walls are looked for anew.
const MOST_TURNS: usize = 6;

/// What an effect would add, without a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glimpse {
    /// Its candidate.
    pub index: usize,
    /// Linear evidence over what it is added to [nats].
    pub gain: f64,
}

/// One candidate more.
#[derive(Debug, Clone)]
pub(super) struct Extension {
    /// The candidate.
    pub(super) index: usize,
    /// Linear evidence over the fit that it extends [nats].
    pub(super) gain: f64,
    /// What the linear fit makes of its columns.
    pub(super) amplitudes: Vec<f64>,
}

/// Every candidate more, at a fit.
pub(super) fn extensions(problem: &Problem, fit: &Fit) -> Vec<Extension> {
    let drive = drive(&slices(&problem.whitened), &fit.residual);
    let alone =
        between_walls(problem, fit, &drive, &fit.set.0).map_or(0.0, |(solution, pull)| evidence(&solution, &pull));
    (0..problem.candidates.len())
        .into_par_iter()
        .map(|index| extension(problem, fit, &drive, index, alone).unwrap_or_else(|| Extension::of(index)))
        .collect()
}

/// One candidate more than a fit whose equations have some evidence alone; none where they say nothing of it.
fn extension(problem: &Problem, fit: &Fit, drive: &DVector<f64>, index: usize, alone: f64) -> Option<Extension> {
    let candidate = &problem.candidates[index];
    if fit.effects.contains(&candidate.effect) {
        return None;
    }
    let set: Vec<usize> = fit.set.0.iter().copied().chain([index]).collect();
    let (solution, pull) = between_walls(problem, fit, drive, &set)?;
    let own = solution.coefficients.len() - candidate.probes.len()..solution.coefficients.len();
    let amplitudes: Vec<f64> = if candidate.releases.is_empty() {
        own.clone().map(|place| solution.coefficients[place]).collect()
    } else {
        vec![0.0; candidate.releases.len()]
    };
    // there is no inertia below zero
    let below_zero = candidate.effect == "flexible_mode" && amplitudes.first().is_none_or(|own| *own <= 0.0);
    if below_zero || !candidate.holds_at(&amplitudes) {
        return None;
    }
    let error = |place: usize| solution.covariance[(place, place)].sqrt();
    let scale_free: f64 = own.zip(&candidate.prior).map(|(place, (_, sigma))| of_any_scale(*sigma, error(place))).sum();
    let gain = evidence(&solution, &pull) + scale_free - alone - (candidate.siblings as f64).ln();
    Some(Extension { index, gain, amplitudes })
}

/// The equations of a set at a fit, with the walls of the tolerances that their solution ends at: solved until those stand.
fn between_walls(problem: &Problem, fit: &Fit, drive: &DVector<f64>, set: &[usize]) -> Option<(Solution, Pull)> {
    let (chosen, natural) = problem.chosen_at(set, &fit.values);
    let (begin, shifts) = (problem.columns.begin, &fit.shifts);
    let mut ahead = shifts.clone();
    let mut found = None;
    for _ in 0..MOST_TURNS {
        let pull = Pull::ahead(problem, &natural, shifts, &ahead);
        let (mut drive, mut precision) = (drive.clone(), natural.clone());
        for (place, slope) in pull.slope.iter().enumerate() {
            drive[begin + place] -= slope;
            precision[begin + place] = pull.curvature[place];
        }
        let solution = solve(&problem.gram, &drive, &chosen, &precision)?;
        let next: Vec<f64> =
            shifts.iter().enumerate().map(|(place, shift)| shift + solution.coefficients[begin + place]).collect();
        let stand = next
            .iter()
            .zip(&ahead)
            .zip(&problem.nuisances)
            .all(|((next, ahead), own)| own.is_beyond(*next) == own.is_beyond(*ahead));
        found = Some((solution, pull));
        if stand {
            break;
        }
        ahead = next;
    }
    found
}

/// Evidence of a solution, up to what all at one fit share; a wall is no knowledge of its parameter.
fn evidence(solution: &Solution, pull: &Pull) -> f64 {
    solution.evidence - pull.walls - 0.5 * pull.cost
}

impl Extension {
    /// A candidate of which the linear equations say nothing.
    pub(super) fn of(index: usize) -> Self {
        Self { index, gain: f64::NEG_INFINITY, amplitudes: Vec::new() }
    }
}

/// The best candidate of each effect, the best effects first.
pub(super) fn best_by_effect(problem: &Problem, mut order: Vec<Extension>, count: usize) -> Vec<Extension> {
    order.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    first_of_each(&mut order, |extension| problem.candidates[extension.index].effect);
    order.retain(|extension| extension.gain.is_finite());
    order.truncate(count);
    order
}

/// Keeps the first of each kind.
pub(crate) fn first_of_each<T, K: PartialEq>(all: &mut Vec<T>, kind: impl Fn(&T) -> K) {
    let mut seen: Vec<K> = Vec::new();
    all.retain(|one| {
        let own = kind(one);
        let new = !seen.contains(&own);
        if new {
            seen.push(own);
        }
        new
    });
}

/// What every effect that a fit does not have would add to it.
pub(crate) fn glimpses_beside(problem: &Problem, fit: &Fit) -> Vec<Glimpse> {
    seen(&best_by_effect(problem, extensions(problem, fit), usize::MAX))
}

/// As they are told.
pub(super) fn seen(extensions: &[Extension]) -> Vec<Glimpse> {
    extensions.iter().map(|extension| Glimpse { index: extension.index, gain: extension.gain }).collect()
}

/// Whether it is worth a fit.
pub(super) fn promising(problem: &Problem, extension: &Extension) -> bool {
    problem.candidates[extension.index].is_promised(extension.gain)
}
