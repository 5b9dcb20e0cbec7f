//! What the samples show by themselves, whatever fits: a stop that is elsewhere, and the steps of a converter.

use gimbal_model_file::Tolerance;

use super::against::BEYOND;
use super::comb;
use super::grid;
use super::in_loop::{loop_sees, loop_sees_hidden};
use crate::fit::{Fit, Problem};
use crate::record::{Channel, Signal};

/// Effects that they show.
pub(crate) const READ_OFF: [&str; 2] = ["stop_angle", "pickoff_quantisation"];

/// Steps over the noise that hides them, from which on the torque is asked for them.
const FINEST: f64 = 0.5;

/// How far the stop is from where it should be, as a pick-off of this scale shows it, and the error of that: where the float
/// stands still, or as far as it went past where it should have.
pub(super) fn stop_change(problem: &Problem, pickoff: f64, tolerance: &Tolerance) -> Option<(f64, f64)> {
    let plateau = problem.record.plateau_rad;
    let reached_rad = plateau.or_else(|| problem.record.channel(Signal::GyroAngle).map(Channel::held_peak))?;
    let change = reached_rad / (problem.stop_rad * pickoff) - 1.0;
    // the pick-off that shows it has a scale of its own
    let scale = problem.nuisance("pickoff_scale").map_or(0.0, |place| problem.nuisances[place].sigma);
    let error = (1.0 + change) * scale.hypot(problem.noise[0] / reached_rad);
    let beyond = if plateau.is_some() { change.abs() } else { change };
    (beyond > least_stop_change(tolerance)).then_some((change, error))
}

/// Relative change of the stop, as the pick-off reads it, that no tolerance accounts for.
pub(super) fn least_stop_change(tolerance: &Tolerance) -> f64 {
    BEYOND * (tolerance.stop_angle + tolerance.pickoff_scale)
}

/// Steps on which the samples of the pick-off lie [rad].
#[derive(Debug, Clone, Copy)]
pub(super) struct Steps {
    pub(super) step_rad: f64,
    /// Whether they are the pick-off's, and not of what writes the log.
    pub(super) of_pickoff: bool,
}

/// The steps of the samples, where they show some.
pub(super) fn steps(problem: &Problem, fit: &Fit) -> Option<Steps> {
    let theta = problem.record.channel(Signal::GyroAngle)?;
    let (angles, noise_rad) = (&theta.values, problem.noise[0]);
    let by_comb = comb::step_rad(angles, &fit.prediction.gyro_angle_rad, &theta.valid, noise_rad);
    let step_rad = by_comb.or_else(|| grid::multiples_of(angles, &theta.valid, noise_rad))?;
    if by_comb.is_none() && !grid::adds_to_noise(step_rad, &theta.valid, noise_rad) {
        let seen = step_rad > FINEST * noise_rad && loop_sees_hidden(problem, fit, step_rad);
        return seen.then_some(Steps { step_rad, of_pickoff: true });
    }
    let by_log = || problem.record.is_rounded || grid::is_the_logs(step_rad, noise_rad);
    let of_pickoff = loop_sees(problem, fit, step_rad).unwrap_or_else(|| !by_log());
    Some(Steps { step_rad, of_pickoff })
}
