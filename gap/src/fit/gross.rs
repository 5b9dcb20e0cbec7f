//! A nominal parameter that is off by tens of percent: equations that are linear at its nominal value do not lead there,
//! so it is tried at a few values first.

use rayon::prelude::*;

use super::hypothesis::{Point, left};
use super::walk::Effort;
use super::{Fit, Problem, Set, refine};

/// A fit of the nominal parameters leaves so many times the noise from where on this is worth the time.
const GROSS: f64 = 2.0;
/// Relative changes that are tried.
const CHANGES: [f64; 6] = [-0.75, -0.5, -0.25, 0.3, 0.6, 1.0];
/// Parameters that are fitted from their best change.
const FITTED: usize = 3;

/// A parameter at its best change.
struct Start {
    candidate: usize,
    place: usize,
    shift: f64,
    square: f64,
}

/// Fits of single nominal parameters that start far from nominal.
pub(crate) fn gross(problem: &Problem, null: &Fit) -> Vec<Fit> {
    if null.square < GROSS * problem.whitener.count() as f64 {
        return Vec::new();
    }
    let mut starts = starts(problem);
    starts.sort_by(|a, b| a.square.total_cmp(&b.square));
    starts.truncate(FITTED);
    let fit = |start: &Start| {
        let mut from = null.clone();
        from.begin = problem.begin.clone();
        from.shifts.fill(0.0);
        from.shifts[start.place] = start.shift;
        refine(problem, &Set(vec![start.candidate]), &[vec![0.0]], Some(&from), Effort::Thorough)
    };
    starts.par_iter().map(fit).filter(|fit| fit.square < null.square).collect()
}

/// Every parameter at the change that leaves least, all else nominal.
fn starts(problem: &Problem) -> Vec<Start> {
    let place = |candidate: usize| {
        let [release] = problem.candidates[candidate].releases else { return None };
        let place = problem.nuisance(release).filter(|&place| !problem.nuisances[place].absolute)?;
        Some((candidate, place))
    };
    let places: Vec<(usize, usize)> = (0..problem.candidates.len()).filter_map(place).collect();
    let changed = |&(candidate, place): &(usize, usize)| {
        CHANGES.map(|change| {
            let mut point = Point::nominal(problem, vec![vec![0.0]]);
            point.shifts[place] = change.ln_1p();
            (Set(vec![candidate]), point)
        })
    };
    let tries: Vec<(Set, Point)> = places.iter().flat_map(changed).collect();
    let squares = left(problem, &tries);
    let least = |(&(candidate, place), squares): (&(usize, usize), &[f64])| {
        let start = |(change, &square): (&f64, &f64)| Start { candidate, place, shift: change.ln_1p(), square };
        let finite = CHANGES.iter().zip(squares).map(start).filter(|start| start.square.is_finite());
        finite.min_by(|a, b| a.square.total_cmp(&b.square))
    };
    places.iter().zip(squares.chunks(CHANGES.len())).filter_map(least).collect()
}
