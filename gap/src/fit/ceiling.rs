//! A ceiling of the torque: it changes everything where it is reached, and equations that are linear below it do not lead
//! there.

use super::hypothesis::{Point, left};
use super::signals::peak;
use super::walk::Effort;
use super::{Fit, Problem, Set, refine};
use crate::library::PROMISE;

/// A predicted torque that comes so near the highest that was measured, over it, may have met a ceiling.
const NEAR: f64 = 0.98;
/// A fit leaves so many times the noise from where on a ceiling is worth the time, beside effects or without a sensor that
/// shows it.
const WORTH: f64 = 1.02;
/// Ceilings over what a sensor shows, whose noise is in the highest that it held for some rows.
const SHARES_SHOWN: [f64; 6] = [1.0, 0.99, 0.98, 0.97, 0.95, 0.92];
/// Ceilings that no sensor shows, over the highest torque that is predicted.
const SHARES: [f64; 12] = [0.99, 0.97, 0.94, 0.9, 0.85, 0.8, 0.74, 0.68, 0.6, 0.5, 0.4, 0.3];

/// A fit with a ceiling more, where that leaves less.
pub(super) fn saturated(problem: &Problem, from: &Fit) -> Option<Fit> {
    let effect = "torque_saturation";
    let index = problem.candidates.iter().position(|candidate| candidate.effect == effect)?;
    let leaves_noise = from.square < WORTH * problem.whitener.count() as f64;
    // a prediction that is as it should be comes as near to the highest torque as a ceiling
    if from.effects.contains(&effect) || leaves_noise && !(from.effects.is_empty() && problem.ceiling_nm.is_some()) {
        return None;
    }
    let (mut set, mut values) = (from.set.clone(), from.values.clone());
    set.0.push(index);
    values.push(vec![ceiling_nm(problem, from, &set)?]);
    let fit = refine(problem, &set, &values, Some(from), Effort::Quick);
    Some(fit).filter(|fit| fit.square < from.square - PROMISE)
}

/// Where the ceiling would be: as the sensor shows it, or where it leaves least.
fn ceiling_nm(problem: &Problem, from: &Fit, set: &Set) -> Option<f64> {
    let sensor = from.physics.measurement.torque_factor;
    let highest_nm = peak(&from.prediction.motor_torque_nm) / sensor;
    let ceilings_nm: Vec<f64> = match problem.ceiling_nm.map(|shown_nm| shown_nm / sensor) {
        Some(shown_nm) if highest_nm > NEAR * shown_nm => SHARES_SHOWN.iter().map(|share| share * shown_nm).collect(),
        Some(_) => return None,
        None => SHARES.iter().map(|share| share * highest_nm).collect(),
    };
    let at = |ceiling_nm: &f64| {
        let mut values = from.values.clone();
        values.push(vec![*ceiling_nm]);
        (set.clone(), Point { values, ..from.point(problem) })
    };
    let squares = left(problem, &ceilings_nm.iter().map(at).collect::<Vec<_>>());
    let (square, ceiling_nm) = squares.iter().zip(&ceilings_nm).min_by(|a, b| a.0.total_cmp(b.0))?;
    (problem.ceiling_nm.is_some() || *square < from.square).then_some(*ceiling_nm)
}
