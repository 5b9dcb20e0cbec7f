//! Names of what a set holds: its effects, and the nominal parameters that it leaves beyond what is known of them.

use gimbal_model_file::AxisModel;

use crate::axis::balance::Balance;
use crate::axis::library::{NOMINAL, Shape, rms};
use crate::axis::motion::Motion;
use crate::axis::plain::{nominal, tolerated_shifts};
use crate::axis::search::Candidate;

/// A nominal parameter is an effect from this many tolerances on.
pub(in crate::axis) const BEYOND: f64 = 1.15;
/// Beside effects that take most of what is named it is none up to so many tolerances, with less than this share of their
/// power: what their formulation leaves shifts parameters, and looks like effects of reversals.
const BESIDE: f64 = 3.0;
const CRUMB: f64 = 0.06;

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
    let (columns, amplitudes) = balance.fit(members);
    let of = |column: &usize| columns.iter().position(|own| own == column).map_or(0.0, |place| amplitudes[place]);
    let more = of_the_motor(balance, members, &of);
    let named = named_power(balance, members, &of);
    let tolerated = tolerated_shifts(model);
    let outside = |index: usize| {
        let unsure = errors[index] + more * nominal(model)[index];
        let crumb = shifts[index].powi(2) * grams.power(index) < CRUMB * named;
        shifts[index].abs() - unsure > if crumb { BESIDE } else { BEYOND } * tolerated[index]
    };
    (0..3).filter(|&index| worth(index) && outside(index)).collect()
}

/// What the effects of a set that are no parameters put into the balance, each by itself, squared and summed; `of` is the
/// amplitude of a column.
fn named_power(balance: &Balance, members: &[usize], of: &impl Fn(&usize) -> f64) -> f64 {
    let candidates = members.iter().map(|&member| &balance.problem.candidates[member]);
    candidates
        .filter(|candidate| !NOMINAL.contains(&candidate.shape))
        .map(|candidate| power(balance, candidate, of))
        .sum()
}

fn power(balance: &Balance, candidate: &Candidate, of: &impl Fn(&usize) -> f64) -> f64 {
    let sizes: Vec<f64> = candidate.columns.iter().map(of).collect();
    balance.problem.grams.powers(&candidate.columns, &sizes)[1]
}

/// What the formulation of a set's effects may leave: members that are never quite as they are formulated, with a small share of
/// the power of all, and of the parameters beyond what is known of them. They are fitted, and not named.
pub(super) fn crumbs(balance: &Balance, members: &[usize], beyond: &[usize]) -> Vec<usize> {
    let (columns, amplitudes) = balance.fit(members);
    let of = |column: &usize| columns.iter().position(|own| own == column).map_or(0.0, |place| amplitudes[place]);
    let shifts = balance.shifts(members, &columns, &amplitudes);
    let shifted = beyond.iter().map(|&index| shifts[index].powi(2) * balance.problem.grams.power(index));
    let least = CRUMB * (named_power(balance, members, &of) + shifted.sum::<f64>());
    let is_crumb = |&member: &usize| {
        let candidate = &balance.problem.candidates[member];
        candidate.shape.is_rough() && power(balance, candidate, &of) < least
    };
    members.iter().copied().filter(is_crumb).collect()
}

/// By how much a motor whose constant goes up and down needs more, whatever for:
///
/// ```text
/// mean of 1 / (1 + r cos x) = 1 + r^2 / 2 + ...
/// ```
fn of_the_motor(balance: &Balance, members: &[usize], of: &impl Fn(&usize) -> f64) -> f64 {
    let candidates = members.iter().map(|&member| &balance.problem.candidates[member]);
    let ripples = candidates.filter(|candidate| matches!(candidate.shape, Shape::MotorRipple { .. }));
    ripples.flat_map(|candidate| &candidate.columns).map(|column| 0.5 * of(column).powi(2)).sum()
}

/// Names of a set's effects, each once.
pub(super) fn names(balance: &Balance, members: &[usize], model: &AxisModel) -> Vec<String> {
    let (columns, amplitudes) = balance.fit(members);
    let shifts = balance.shifts(members, &columns, &amplitudes);
    let beyond = beyond(balance, model, members, shifts, balance.of_noise());
    let crumbs = crumbs(balance, members, &beyond);
    let told = members.iter().filter(|member| !crumbs.contains(member));
    let mut names: Vec<String> = told
        .map(|&member| &balance.problem.candidates[member].shape)
        .filter(|shape| !NOMINAL.contains(shape))
        .map(|shape| label(shape, &balance.motion))
        .chain(beyond.into_iter().map(|index| NOMINAL[index].effect().to_owned()))
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
    let allowed: f64 = tolerated_shifts(model).iter().zip(sizes).map(|(shift, size)| (shift * size).powi(2)).sum();
    let rest = rms(&balance.residual(&[]));
    rest.powi(2) < allowed.max(2.0 * motion.floor.powi(2))
}
