//! An appendage so heavy that the loop's own poles move: equations that are linear in its inertia do not lead there, so
//! it is tried at a few values first.

use super::hypothesis::{Point, left};
use super::refine::Effort;
use super::{Fit, Problem, Set, refine};
use crate::library::MODE_DAMPING;

/// The nominal parameters leave so many times the noise from where on this is worth the time.
const WORTH: f64 = 1.03;
/// Share of the gimbal's inertia and frequencies that are tried [Hz].
const SHARE: f64 = 0.08;
const FROM_HZ: f64 = 20.0;
const TO_HZ: f64 = 250.0;
const STEP: f64 = 1.12;

/// The fit of an appendage that starts with the best heavy one, if that leaves less than the nominal parameters do.
pub(crate) fn heavy(problem: &Problem, null: &Fit) -> Option<Fit> {
    if null.square < WORTH * problem.whitener.count() as f64 {
        return None;
    }
    let candidate = problem.candidates.iter().position(|candidate| candidate.effect == "flexible_mode")?;
    let set = Set(vec![candidate]);
    let frequencies = std::iter::successors(Some(FROM_HZ), |hz| Some(hz * STEP)).take_while(|hz| *hz < TO_HZ);
    let at = |hz: f64| Point { values: vec![vec![SHARE, hz, MODE_DAMPING]], ..null.point(problem) };
    let tries: Vec<(Set, Point)> = frequencies.map(|hz| (set.clone(), at(hz))).collect();
    let squares = left(problem, &tries);
    let (square, (_, point)) = squares.iter().zip(&tries).min_by(|a, b| a.0.total_cmp(b.0))?;
    (*square < null.square).then(|| refine(problem, &set, &point.values, Some(null), Effort::Thorough))
}
