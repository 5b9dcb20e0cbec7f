//! Friction about zero rate, from elsewhere: how sharp it is there and how soon it follows have valleys of their own, and
//! sensitivities lead from one to no other. What a fit cannot close is fitted again from a few places of both.

use rayon::prelude::*;

use super::extension::Extension;
use super::formulations::extend;
use super::refine::{Effort, STILL};
use super::search::is_closed;
use super::{Fit, Problem, refine};
use crate::library::{DAMPING, DISPLACEMENT, SHARPNESS};

/// Sharpness and displacement [rad] of the clamp where fits begin, and the time constant of its damping there [s].
const BEGINS: [(f64, f64); 2] = [(0.5, 1e-6), (0.0, 2e-6)];
const DAMPED_S: f64 = 1e-3;
/// Share of its tolerance from which on the displacement of the clamp is far.
const FAR: f64 = 0.5;

/// The same effects from other friction about zero rate, beside the other nominal parameters as they are and as they should be;
/// none where that leaves no less.
pub(super) fn elsewhere(problem: &Problem, fit: &Fit, effort: Effort) -> Option<Fit> {
    let sharpness = problem.nuisance(SHARPNESS)?;
    let displacement = problem.nuisance(DISPLACEMENT)?;
    let damping = problem.nuisance(DAMPING)?;
    let from = |((sharper, follows_rad), nominal): ((f64, f64), bool)| {
        let mut begin = fit.clone();
        if nominal {
            begin.shifts.fill(0.0);
        }
        begin.shifts[sharpness] = sharper;
        begin.shifts[displacement] = follows_rad;
        begin.shifts[damping] = DAMPED_S;
        refine(problem, &fit.set, &fit.values, Some(&begin), effort)
    };
    let begins: Vec<_> = BEGINS.into_iter().flat_map(|begin| [(begin, false), (begin, true)]).collect();
    let fitted = begins.into_par_iter().map(from).filter(|other| other.volume.is_finite());
    fitted.min_by(|a, b| a.cost().total_cmp(&b.cost())).filter(|other| fit.cost() - other.cost() > STILL)
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
