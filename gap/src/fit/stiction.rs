//! Friction about zero rate, from elsewhere: how sharp it is there and how soon it follows have valleys of their own, and
//! sensitivities lead from one to no other. What a fit cannot close is fitted again from a few places of both.

use rayon::prelude::*;

use super::extension::Extension;
use super::formulations::{closer, extend};
use super::hypothesis::{Hypothesis, Point};
use super::linear::Linear;
use super::normal::solve;
use super::search::{is_closed, is_near};
use super::walk::{Effort, STILL};
use super::{Fit, Problem, refine};
use crate::library::{DAMPING, DISPLACEMENT, SHARPNESS};

/// Sharpness and displacement [rad] of the clamp where fits begin, and the time constant of its damping there [s].
const BEGINS: [(f64, f64); 2] = [(0.5, 1e-6), (0.0, 2e-6)];
const DAMPED_S: f64 = 1e-3;
/// Share of its tolerance from which on the displacement of the clamp is far.
const FAR: f64 = 0.5;
/// Share of what a fit leaves beyond the noise that goes along with other friction about zero rate where that may be the cause.
const IN_REACH: f64 = 0.02;

/// The same effects from other friction about zero rate, beside the other nominal parameters as they are and as they should be;
/// none where that leaves no less.
pub(super) fn elsewhere(problem: &Problem, fit: &Fit, effort: Effort) -> Option<Fit> {
    let places = [SHARPNESS, DISPLACEMENT, DAMPING].map(|name| problem.nuisance(name));
    let [Some(sharpness), Some(displacement), Some(damping)] = places else { return None };
    let with = |shifts: &[f64], (sharper, follows_rad): (f64, f64)| {
        let mut shifts = shifts.to_vec();
        shifts[sharpness] = sharper;
        shifts[displacement] = follows_rad;
        shifts[damping] = DAMPED_S;
        shifts
    };
    // near the noise a few nats decide, and no line leads from one valley to the next
    if !is_near(problem, fit) && !is_in_reach(problem, fit, &BEGINS.map(|begin| with(&fit.shifts, begin))) {
        return None;
    }
    let nominal = vec![0.0; fit.shifts.len()];
    let begins = BEGINS.into_iter().flat_map(|begin| [with(&fit.shifts, begin), with(&nominal, begin)]);
    let from = |shifts| refine(problem, &fit.set, &fit.values, Some(&Fit { shifts, ..fit.clone() }), effort);
    let fitted = begins.collect::<Vec<_>>().into_par_iter().map(from).filter(|other| other.volume.is_finite());
    fitted.min_by(closer).filter(|other| fit.cost() - other.cost() > STILL)
}

/// Whether what a fit leaves goes along with what nominal parameters elsewhere would change, beside what they change where they
/// are.
fn is_in_reach(problem: &Problem, fit: &Fit, elsewhere: &[Vec<f64>]) -> bool {
    let hypothesis = Hypothesis::new(problem, &fit.set, &fit.values);
    let moved = |shifts: &Vec<f64>| {
        let point = Point { shifts: shifts.clone(), ..fit.point(problem) };
        (hypothesis.variant(&point, usize::MAX), 1.0)
    };
    let mut columns = fit.sensitivities.clone();
    columns.extend(hypothesis.slopes(elsewhere.iter().map(moved).collect(), &fit.prediction));
    let (gram, drive) = Linear::of(problem).joined(&columns, &fit.residual);
    let gain = |more: usize| {
        let chosen: Vec<usize> = (0..drive.len() - elsewhere.len() + more).collect();
        let anything = vec![1.0; chosen.len() - hypothesis.fixed()];
        let precision: Vec<f64> = hypothesis.precision.iter().chain(&anything).copied().collect();
        solve(&gram, &drive, &chosen, &precision).map_or(0.0, |solution| solution.gain)
    };
    let beyond_noise = fit.square - problem.whitener.count() as f64;
    gain(elsewhere.len()) - gain(0) > IN_REACH * beyond_noise
}

/// The fit with friction that builds up over more than a nominal displacement, where that goes far and is too little: beside
/// nominal parameters that went there for want of it, the effect seems to bring nothing.
pub(super) fn built_up(problem: &Problem, null: &Fit) -> Option<Fit> {
    let displacement = problem.nuisance(DISPLACEMENT)?;
    if null.shifts[displacement] < FAR * problem.nuisances[displacement].tolerance || is_closed(problem, null) {
        return None;
    }
    let index = problem.candidates.iter().position(|candidate| candidate.effect == "presliding")?;
    extend(problem, null, &Extension::of(index))
}
