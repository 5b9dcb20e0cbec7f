//! Names of what a set holds: its effects, and the nominal parameters that it leaves beyond what is known of them.

use gimbal_model_file::AxisModel;

use crate::axis::balance::Balance;
use crate::axis::library::{NOMINAL, Shape, rms};
use crate::axis::motion::Motion;
use crate::axis::plain::nominal;
use crate::axis::search::Candidate;

/// A nominal parameter is an effect from this many tolerances on.
pub(in crate::axis) const BEYOND: f64 = 1.15;

/// Nominal parameters beyond what is known of them, by their places.
pub(super) fn beyond(
    balance: &Balance,
    model: &AxisModel,
    members: &[usize],
    shifts: [f64; 3],
    errors: [f64; 3],
) -> Vec<usize> {
    // and worth the price of an effect
    let grams = &balance.problem.grams;
    let worth = |index: usize| shifts[index].powi(2) * grams.power(index) > balance.problem.price();
    let more = of_the_motor(balance, members);
    let outside = |index: usize, shift: f64| {
        let unsure = errors[index] + more * nominal(model)[index];
        !within(model, index, shift, unsure)
    };
    (0..3).filter(|&index| worth(index) && outside(index, shifts[index])).collect()
}

/// By how much a motor whose constant goes up and down needs more, whatever for:
///
/// ```text
/// mean of 1 / (1 + r cos x) = 1 + r^2 / 2 + ...
/// ```
fn of_the_motor(balance: &Balance, members: &[usize]) -> f64 {
    let candidates = members.iter().map(|&member| &balance.problem.candidates[member]);
    let ripples: Vec<&Candidate> =
        candidates.filter(|candidate| matches!(candidate.shape, Shape::MotorRipple { .. })).collect();
    if ripples.is_empty() {
        return 0.0;
    }
    let (columns, amplitudes) = balance.fit(members);
    let of = |column: &usize| columns.iter().position(|own| own == column).map_or(0.0, |place| amplitudes[place]);
    ripples.iter().flat_map(|candidate| &candidate.columns).map(|column| 0.5 * of(column).powi(2)).sum()
}

/// Names of a set's effects, each once.
pub(super) fn names(balance: &Balance, members: &[usize], model: &AxisModel) -> Vec<String> {
    let (columns, amplitudes) = balance.fit(members);
    let shifts = balance.shifts(members, &columns, &amplitudes);
    let shapes = members.iter().map(|&m| &balance.problem.candidates[m].shape);
    let mut names: Vec<String> = shapes
        .filter(|shape| !NOMINAL.contains(shape))
        .map(|shape| label(shape, &balance.motion))
        .chain(
            beyond(balance, model, members, shifts, balance.of_noise())
                .into_iter()
                .map(|index| NOMINAL[index].effect().to_owned()),
        )
        .collect();
    names.sort();
    names.dedup();
    names
}

/// Name of an effect; channels have theirs beside it.
pub(in crate::axis) fn label(shape: &Shape, motion: &Motion) -> String {
    match shape {
        Shape::Load { channel }
        | Shape::LoadFriction { channel }
        | Shape::LoadGain { channel }
        | Shape::LoadRipple { channel, .. } => {
            format!("{}:{}", shape.effect(), motion.auxiliary[*channel].0)
        }
        _ => shape.effect().to_owned(),
    }
}

/// Whether what is left is small beside what the tolerance of the parameters alone allows.
pub(super) fn tolerated(balance: &Balance, model: &AxisModel) -> bool {
    let motion = &balance.motion;
    let sizes = [&motion.a, &motion.v, &motion.s].map(|values| rms(&motion.pick(values)));
    let tolerance = [model.tolerance.inertia, model.tolerance.viscous, model.tolerance.coulomb];
    let allowed: f64 = (0..3).map(|p| (tolerance[p] * nominal(model)[p] * sizes[p]).powi(2)).sum();
    let rest = rms(&balance.residual(&[]));
    rest.powi(2) < allowed.max(2.0 * motion.floor.powi(2))
}

/// Whether a shift lies within what is known of the parameter.
fn within(model: &AxisModel, index: usize, shift: f64, error: f64) -> bool {
    let tolerance = [model.tolerance.inertia, model.tolerance.viscous, model.tolerance.coulomb][index];
    shift.abs() - error <= BEYOND * tolerance * nominal(model)[index]
}
