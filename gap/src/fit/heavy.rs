//! An appendage so heavy that the loop's own poles move: equations that are linear in its inertia do not lead there, so
//! it is tried at a few values first. Nominal parameters may take nearly all that it does, each a little beyond its
//! tolerance, and no try leaves less than they do; the fit that starts there does.

use super::hypothesis::{Point, left};
use super::walk::Effort;
use super::{Fit, Problem, Set, refine};
use crate::library::MODE_DAMPING;

/// The nominal parameters leave so many times the noise from where on this is worth the time.
const WORTH: f64 = 1.03;
/// Shares of the gimbal's inertia and frequencies that are tried [Hz].
const SHARES: [f64; 2] = [0.08, 0.25];
const FROM_HZ: f64 = 20.0;
const TO_HZ: f64 = 250.0;
const STEP: f64 = 1.12;

/// The fit of an appendage that starts with the best heavy one, where the nominal parameters leave more than noise or are
/// beyond their tolerances.
pub(crate) fn heavy(problem: &Problem, null: &Fit) -> Option<Fit> {
    if null.square < WORTH * problem.whitener.count() as f64 && !null.is_strained(problem) {
        return None;
    }
    let candidate = problem.candidates.iter().position(|candidate| candidate.effect == "flexible_mode")?;
    let set = Set(vec![candidate]);
    let frequencies = std::iter::successors(Some(FROM_HZ), |hz| Some(hz * STEP)).take_while(|hz| *hz < TO_HZ);
    let at = |share: f64, hz: f64| Point { values: vec![vec![share, hz, MODE_DAMPING]], ..null.point(problem) };
    let tries: Vec<(Set, Point)> =
        frequencies.flat_map(|hz| SHARES.map(|share| (set.clone(), at(share, hz)))).collect();
    let squares = left(problem, &tries);
    let (square, (_, point)) = squares.iter().zip(&tries).min_by(|a, b| a.0.total_cmp(b.0))?;
    let effort = if *square < null.square { Effort::Thorough } else { Effort::Quick };
    Some(refine(problem, &set, &point.values, Some(null), effort))
}
