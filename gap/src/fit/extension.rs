//! One candidate more in a fit, by the linear equations there: what it would add.

use rayon::prelude::*;

use super::normal::{drive, of_any_scale, slices, solve};
use super::pull::Pull;
use super::{Fit, Problem};

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
    let columns = slices(&problem.whitened);
    let mut drive = drive(&columns, &fit.residual);
    // priors pull the shifts that the fit has already
    let (chosen, mut precision) = problem.chosen_at(&fit.set.0, &fit.values);
    let begin = problem.columns.begin;
    let pull = Pull::new(problem, &precision, &fit.shifts);
    for (place, slope) in pull.slope.iter().enumerate() {
        drive[begin + place] -= slope;
        precision[begin + place] = pull.curvature[place];
    }
    let base = solve(&problem.gram, &drive, &chosen, &precision).map_or(0.0, |solution| solution.evidence);
    (0..problem.candidates.len())
        .into_par_iter()
        .map(|index| {
            if fit.set.0.iter().any(|&has| problem.candidates[has].effect == problem.candidates[index].effect) {
                return Extension::of(index);
            }
            let mut set = fit.set.0.clone();
            set.push(index);
            let (wide, mut wide_precision) = problem.chosen_at(&set, &fit.values);
            let mut drive = drive.clone();
            // a released parameter is no longer pulled back
            let wide_pull = Pull::new(problem, &wide_precision, &fit.shifts);
            for place in 0..fit.shifts.len() {
                drive[begin + place] += pull.slope[place] - wide_pull.slope[place];
            }
            wide_precision[begin..begin + fit.shifts.len()].copy_from_slice(&wide_pull.curvature);
            let released = wide_pull.walls - pull.walls - 0.5 * (pull.cost - wide_pull.cost);
            let candidate = &problem.candidates[index];
            let Some(solution) = solve(&problem.gram, &drive, &wide, &wide_precision) else {
                return Extension::of(index);
            };
            let amplitudes: Vec<f64> = if candidate.releases.is_empty() {
                let from = wide.len() - candidate.probes.len();
                (from..wide.len()).map(|place| solution.coefficients[place]).collect()
            } else {
                vec![0.0; candidate.releases.len()]
            };
            // there is no inertia below zero
            let below_zero = candidate.effect == "flexible_mode" && amplitudes.first().is_none_or(|own| *own <= 0.0);
            let sane = candidate.holds_at(&amplitudes) && !below_zero;
            let sizes = (wide.len() - candidate.probes.len()..wide.len()).zip(&candidate.prior);
            let scale_free: f64 =
                sizes.map(|(place, (_, sigma))| of_any_scale(*sigma, solution.covariance[(place, place)].sqrt())).sum();
            let gain = if sane {
                solution.evidence + scale_free - base - released - (candidate.siblings as f64).ln()
            } else {
                f64::NEG_INFINITY
            };
            Extension { index, gain, amplitudes }
        })
        .collect()
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
