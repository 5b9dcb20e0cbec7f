//! Whether the specific force stands still, as on a table that is tilted once: what the log has of it beside its mean is then its
//! sensor's noise, which no filter tells from a force that hardly changes. An unbalance is rid of that by being smaller.
//!
//! ```text
//! r = B b + c d        d what is predicted with the force at its mean less what is predicted        c = 1 at rest, 0 as logged
//! ```

use crate::fit::{Fit, Linear, Problem, Search, difference, linear_beside, narrow};
use crate::record::{deviation, is_constant, mean};
use crate::simulate::{Inputs, predict};

/// What the force of a table may wander by within the log, over parts of so many seconds [m/s2].
const WANDERS_MPS2: f64 = 0.05;
const PART_S: f64 = 0.5;
/// How much likelier a force at rest must be than the logged one [nats], and how far off its share may be [standard errors].
const SURE_NATS: f64 = 12.0;
const OFF: f64 = 4.0;

/// The inputs with the force at its mean where the outputs show that it stands still; none where they do not, or where none of it
/// may.
pub(crate) fn at_rest(problem: &Problem, fit: &Fit) -> Option<Inputs> {
    let (record, physics) = (problem.record, &fit.physics);
    let part = record.inputs.rows_of(PART_S).max(1);
    let mut inputs = record.inputs.clone();
    let may_stand = |axis: &&mut Vec<f64>| !is_constant(axis) && wanders_mps2(axis, part) < WANDERS_MPS2;
    let held = inputs.accel_mps2.iter_mut().filter(may_stand).map(|axis| *axis = vec![mean(axis); axis.len()]).count();
    if held == 0 {
        return None;
    }
    inputs.complete(&problem.base.config.bearing, record.inputs.turned_rad[0]);
    let held = predict(physics, &inputs, &fit.begin, record.rows());
    let column = narrow(&problem.whiten(difference(record, &held, &fit.prediction, 1.0)));
    // the force at its mean is all that a constant torque may hide of it
    let constant = problem.torque_column(&vec![1.0; record.rows()]);
    let solution = linear_beside(problem, &Linear::of(problem), fit, &[constant, column])?;
    let place = solution.coefficients.len() - 1;
    let (share, error) = (solution.coefficients[place], solution.covariance[(place, place)].sqrt());
    let nats = (share - 0.5) / (error * error);
    (nats > SURE_NATS && (share - 1.0).abs() < OFF * error).then_some(inputs)
}

/// The fit that leaves least of those whose unbalance is the nominal one: another is rid of the noise already.
pub(crate) fn closest_as_balanced(search: &Search) -> &Fit {
    let balanced = search.fits.iter().filter(|fit| !fit.effects.contains(&"mass_unbalance"));
    balanced.fold(&search.null, |best, fit| if fit.square < best.square { fit } else { best })
}

/// Standard deviation of the means of parts.
fn wanders_mps2(values: &[f64], part: usize) -> f64 {
    let means: Vec<f64> = values.chunks_exact(part).map(mean).collect();
    deviation(&means)
}
