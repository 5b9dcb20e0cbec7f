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
/// The same of what yields beside what else yields: the first may yield at other displacements than it is formulated with.
const CRUMB_OF_YIELDING: f64 = 0.15;

/// A set with what its columns and the nominal parameters are fitted to.
pub(super) struct Sizes<'a> {
    pub(super) members: &'a [usize],
    pub(super) columns: Vec<usize>,
    pub(super) amplitudes: Vec<f64>,
    /// Shifts of the nominal parameters.
    pub(super) shifts: [f64; 3],
}

impl<'a> Sizes<'a> {
    pub(super) fn new(balance: &Balance, members: &'a [usize]) -> Self {
        let (columns, amplitudes) = balance.fit(members);
        let shifts = balance.shifts(members, &columns, &amplitudes);
        Self { members, columns, amplitudes, shifts }
    }

    /// Amplitude of a column.
    fn of(&self, column: usize) -> f64 {
        self.columns.iter().position(|own| *own == column).map_or(0.0, |place| self.amplitudes[place])
    }

    /// What a candidate puts into the balance, squared and summed.
    fn power(&self, balance: &Balance, candidate: &Candidate) -> f64 {
        let sizes: Vec<f64> = candidate.columns.iter().map(|&column| self.of(column)).collect();
        balance.problem.grams.powers(&candidate.columns, &sizes)[1]
    }

    /// The same of the shift of a nominal parameter.
    fn shift_power(&self, balance: &Balance, index: usize) -> f64 {
        self.shifts[index].powi(2) * balance.problem.grams.power(index)
    }

    /// The same of all effects that are no parameters, each by itself.
    fn named_power(&self, balance: &Balance) -> f64 {
        let candidates = self.members.iter().map(|&member| &balance.problem.candidates[member]);
        let named = candidates.filter(|candidate| !NOMINAL.contains(&candidate.shape));
        named.map(|candidate| self.power(balance, candidate)).sum()
    }
}

/// Nominal parameters beyond what is known of them, by their places.
pub(super) fn beyond(balance: &Balance, model: &AxisModel, set: &Sizes, errors: [f64; 3]) -> Vec<usize> {
    // and worth the price of an effect
    let worth = |index: usize| set.shift_power(balance, index) > balance.problem.price();
    let more = of_the_motor(balance, set);
    let named = set.named_power(balance);
    let tolerated = tolerated_shifts(model);
    let outside = |index: usize| {
        let unsure = errors[index] + more * nominal(model)[index];
        let crumb = set.shift_power(balance, index) < CRUMB * named;
        set.shifts[index].abs() - unsure > if crumb { BESIDE } else { BEYOND } * tolerated[index]
    };
    (0..3).filter(|&index| worth(index) && outside(index)).collect()
}

/// What the formulation of a set's effects may leave: members that are never quite as they are formulated, with a small share of
/// the power of all, and of the parameters beyond what is known of them. They are fitted, and not named.
pub(super) fn crumbs(balance: &Balance, set: &Sizes, beyond: &[usize]) -> Vec<usize> {
    let shifted: f64 = beyond.iter().map(|&index| set.shift_power(balance, index)).sum();
    let all = set.named_power(balance) + shifted;
    let yielding = set.members.iter().filter(|&&member| balance.problem.candidates[member].shape.yields()).count();
    let is_crumb = |&member: &usize| {
        let candidate = &balance.problem.candidates[member];
        let least = if candidate.shape.yields() && yielding > 1 { CRUMB_OF_YIELDING } else { CRUMB };
        candidate.shape.is_rough() && set.power(balance, candidate) < least * all
    };
    set.members.iter().copied().filter(is_crumb).collect()
}

/// By how much a motor whose constant goes up and down needs more, whatever for:
///
/// ```text
/// mean of 1 / (1 + r cos x) = 1 + r^2 / 2 + ...
/// ```
fn of_the_motor(balance: &Balance, set: &Sizes) -> f64 {
    let candidates = set.members.iter().map(|&member| &balance.problem.candidates[member]);
    let ripples = candidates.filter(|candidate| matches!(candidate.shape, Shape::MotorRipple { .. }));
    ripples.flat_map(|candidate| &candidate.columns).map(|&column| 0.5 * set.of(column).powi(2)).sum()
}

/// Names of a set's effects, each once.
pub(super) fn names(balance: &Balance, members: &[usize], model: &AxisModel) -> Vec<String> {
    let set = Sizes::new(balance, members);
    let beyond = beyond(balance, model, &set, balance.of_noise());
    let crumbs = crumbs(balance, &set, &beyond);
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
