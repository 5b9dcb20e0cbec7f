//! The effects of a fitted set: what each is, how large, what it takes away.

use gimbal_model_file::AxisModel;

use super::beyond::{Sizes, beyond, crumbs, label};
use super::{Found, Parameter, Ranked, deviation, parameters};
use crate::axis::balance::Balance;
use crate::axis::library::{NOMINAL, Shape};
use crate::axis::regress::Draws;
use crate::axis::search::Set;

/// Draws of the bootstrap.
const DRAWS: usize = 200;

/// A set as it was fitted, on all of the log and on blocks drawn anew.
pub(super) struct Fitted<'a> {
    set: Sizes<'a>,
    /// Amplitudes of each draw.
    pub(super) drawn: Vec<Vec<f64>>,
    /// How often each draw has each block.
    pub(super) times: Vec<Vec<f64>>,
    /// Shifts of the nominal parameters of each draw.
    shifted: Vec<Vec<f64>>,
}

impl<'a> Fitted<'a> {
    pub(super) fn new(balance: &Balance, best: &'a Set) -> Self {
        let grams = &balance.problem.grams;
        let set = Sizes::new(balance, &best.members);
        let mut draws = Draws::new();
        let times: Vec<Vec<f64>> = (0..DRAWS).map(|_| draws.draw(&grams.counts)).collect();
        let drawn: Vec<Vec<f64>> = times.iter().filter_map(|draw| grams.fit_drawn(&set.columns, draw)).collect();
        let shifted = drawn.iter().map(|own| balance.shifts(set.members, &set.columns, own).to_vec()).collect();
        Self { set, drawn, times, shifted }
    }

    /// Standard errors of the shifts.
    fn errors(&self) -> [f64; 3] {
        [0, 1, 2].map(|index| deviation(&self.shifted, index))
    }

    /// Places of a member's columns among those that are fitted.
    fn places(&self, balance: &Balance, member: usize) -> Vec<usize> {
        let own = balance.problem.candidates[member].columns.iter();
        own.filter_map(|column| self.set.columns.iter().position(|fitted| fitted == column)).collect()
    }

    /// What a member puts into the balance, squared and summed.
    fn power(&self, balance: &Balance, member: usize) -> f64 {
        let own: Vec<(&[f64], f64)> = self
            .places(balance, member)
            .into_iter()
            .map(|place| (&balance.columns[self.set.columns[place]][..], self.set.amplitudes[place]))
            .collect();
        squares(balance, &own)
    }

    /// The same of the shift of a nominal parameter.
    fn shift_power(&self, balance: &Balance, index: usize) -> f64 {
        squares(balance, &[(&balance.columns[index][..], self.set.shifts[index])])
    }
}

/// Of a sum of columns times amplitudes.
fn squares(balance: &Balance, own: &[(&[f64], f64)]) -> f64 {
    let at = |row: usize| own.iter().map(|(column, amplitude)| amplitude * column[row]).sum::<f64>();
    (0..balance.target.len()).map(|row| at(row).powi(2)).sum()
}

/// The effects of a set that closes so much of the gap, the one that takes most first; what frees a nominal parameter is
/// told as the parameter. And what is fitted beside them, but not named.
pub(super) fn found(
    balance: &Balance,
    fitted: &Fitted,
    model: &AxisModel,
    ranking: &[Ranked],
    reduction_percent: f64,
) -> (Vec<Found>, Vec<Found>) {
    let of_noise = balance.of_noise();
    let errors = fitted.errors();
    let unsure = std::array::from_fn(|index| errors[index] + of_noise[index]);
    let beyond = beyond(balance, model, &fitted.set, unsure);
    let crumbs = crumbs(balance, &fitted.set, &beyond);
    let added = fitted.set.members.iter().map(|&member| (member, &balance.problem.candidates[member].shape));
    let added: Vec<(Shape, String, f64, Vec<Parameter>)> = added
        .filter(|(_, shape)| !NOMINAL.contains(shape))
        .map(|(member, shape)| {
            let places = fitted.places(balance, member);
            let of = |amplitudes: &[f64]| -> Vec<f64> { places.iter().map(|&place| amplitudes[place]).collect() };
            let samples: Vec<Vec<f64>> = fitted.drawn.iter().map(|own| of(own)).collect();
            let told = parameters(shape, &of(&fitted.set.amplitudes), &samples, model, &balance.motion);
            (shape.clone(), label(shape, &balance.motion), fitted.power(balance, member), told)
        })
        .collect();
    let shifted = beyond.into_iter().map(|index| {
        let shape = NOMINAL[index].clone();
        let samples: Vec<Vec<f64>> = fitted.shifted.iter().map(|shifts| vec![shifts[index]]).collect();
        let told = parameters(&shape, &[fitted.set.shifts[index]], &samples, model, &balance.motion);
        let (effect, power) = (shape.effect().to_owned(), fitted.shift_power(balance, index));
        (shape, effect, power, told)
    });
    let all: Vec<(Shape, String, f64, Vec<Parameter>)> = added.into_iter().chain(shifted).collect();
    let power: f64 = all.iter().map(|(_, _, power, _)| power).sum::<f64>().max(1e-300);
    let gone = (reduction_percent / 100.0).clamp(0.0, 1.0);
    let marginal = |effect: &String| -> f64 {
        let with = ranking.iter().filter(|set| set.effects.contains(effect));
        with.map(|set| set.probability).sum::<f64>().clamp(0.0, 1.0)
    };
    let one = |(shape, effect, own, parameters): (Shape, String, f64, Vec<Parameter>)| Found {
        block: shape.block(),
        probability: marginal(&effect),
        effect,
        parameters,
        removes: (own / power * gone).clamp(0.0, 1.0),
        shows_in: "effort",
    };
    let is_crumb = |shape: &Shape| crumbs.iter().any(|&crumb| balance.problem.candidates[crumb].shape == *shape);
    let (crumbs, all): (Vec<_>, Vec<_>) = all.into_iter().partition(|(shape, ..)| is_crumb(shape));
    // what no likely set holds is not told
    let mut found: Vec<Found> = all.into_iter().map(one).filter(|found| found.probability > 0.0).collect();
    found.sort_by(|a, b| b.removes.total_cmp(&a.removes));
    (found, crumbs.into_iter().map(one).collect())
}
