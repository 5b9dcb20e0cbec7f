//! What every set of effects is worth: its evidence, less what speaks against it.

use gimbal_model_file::Tolerance;

use super::against::{BEYOND, against};
use super::at_rest::{as_constant, is_realistic};
use super::left_over::steady;
use super::set::is_part;
use super::stretch::carried_alone;
use super::turned::at_turns_alone;
use crate::fit::{Fit, Glimpse, Problem, Search, closed_at, first_of_each, glimpses_beside};
use crate::library::{NAMED, releases};

/// Evidence that a nominal parameter beyond its tolerance must bring to be named [nats].
pub(crate) const COST_OF_SHIFT: f64 = 15.0;
/// How much more where the bearing turns around most of the time: its friction is as good as unknown there; and for an effect
/// that is seen at turns alone.
const TURNING: f64 = 2.0;
/// The same after a stop: what follows one hangs on it by more than a line.
const AFTER_STOP: f64 = 1.25;
/// Evidence from which on an effect is likelier than not, from logs with open answers [nats].
const RARE: f64 = 7.5;
pub(crate) const RARE_SHIFT: f64 = 5.0;
/// The same for every effect beside the first, on top.
const RARE_BESIDE: f64 = 4.0;
/// Least share of the gap that an effect takes away: less may be what another formulation of the others is.
const LEAST_SHARE: f64 = 0.003;
/// The same where it closes a gap of which the others leave so many times the noise: that one effect takes all that another
/// formulation is off by is rare.
const LEAST_CLOSING: f64 = 0.001;
const OPEN: f64 = 1.1;
/// Effects of one formulation: a constant, a factor, a product of what is logged. Whoever has them leaves nothing of them.
const EXACT: [&str; 15] = [
    "constant_torque",
    "torque_bias",
    "pickoff_bias",
    "torque_scale",
    "pickoff_scale",
    "mass_unbalance",
    "anisoelasticity",
    "cross_axis_coupling",
    "float_torque",
    "g_sensitive_float_torque",
    "gimbal_inertia",
    "loop_gain",
    "motor_lag",
    "gyro_damping",
    "angular_momentum",
];
/// Share of what a set is worth that the best of its effects is worth alone, times their number.
const ALONE: f64 = 0.4;
/// How much worse than without its effect a fit is that has lost its way.
const LOST: f64 = 10.0;
/// What an effect that was not worth a fit brings at most [nats].
const HIDDEN: f64 = 3.0;
/// A set of effects.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Weighed {
    /// Names, in alphabetical order.
    pub(crate) effects: Vec<&'static str>,
    /// Its fit; none where only the linear equations were looked at.
    pub(crate) fit: Option<usize>,
    /// Evidence over the nominal parameters, less what speaks against it [nats].
    pub(crate) nats: f64,
    /// What it must bring to be named [nats].
    pub(crate) cost: f64,
    /// Evidence from which on it is likelier than not, all its effects together [nats].
    pub(crate) rare: f64,
}

impl Weighed {
    /// Whether it holds a torque on the float, which a bias of the logged rate seems to be too.
    pub(crate) fn acts_on_float(&self) -> bool {
        self.effects.iter().any(|effect| ["float_torque", "g_sensitive_float_torque"].contains(effect))
    }
}

/// Every set that was fitted, in their order, then every effect that was only glimpsed.
pub(crate) fn weigh(problem: &Problem, search: &Search, tolerance: &Tolerance) -> Vec<Weighed> {
    let closest = search.closest();
    let temper = search.temper(problem);
    let away = steady(problem);
    let mut all: Vec<Weighed> = search
        .fits
        .iter()
        .enumerate()
        .map(|(index, fit)| {
            let evidence = fit.evidence(temper) - search.null.evidence(temper) - alone(search, fit) / temper;
            let (cost, rare) = costs(problem, &fit.set.0);
            let shifting = (TURNING - 1.0) * at_turns_alone(search, fit, &away) as f64;
            let (cost, rare) = (cost + shifting * NAMED, rare + shifting * RARE);
            let nats = evidence - against(problem, search, fit, tolerance);
            Weighed { effects: names(fit), fit: Some(index), nats, cost, rare }
        })
        .collect();
    best_of_each(&mut all);
    if problem.record.is_still() {
        as_constant(&mut all, |fit, effect| is_realistic(&search.fits[fit], effect));
    }
    let fits: Vec<&Fit> = all.iter().filter_map(|set| set.fit.map(|fit| &search.fits[fit])).collect();
    let squares = [search.null.square, closest.square, closed_at(problem)];
    let strains = |fit: usize, other: usize| strains(problem, fits[fit], fits[other]);
    worth_their_more(&mut all, squares, |place| fits[place].cost(), strains);
    against_each_other(&mut all, |effect| alone_worth(problem, search, effect, temper));
    for glimpse in &search.glimpses {
        let effect = problem.candidates[glimpse.index].effect;
        if !all.iter().any(|set| set.effects == [effect]) {
            let (cost, rare) = costs(problem, &[glimpse.index]);
            all.push(Weighed { effects: vec![effect], fit: None, nats: glimpse.gain / temper, cost, rare });
        }
    }
    all
}

/// A set with each effect more that was not worth a fit beside it: one may hide there as well as where nothing is named, and
/// as seldom.
pub(crate) fn hidden_beside(problem: &Problem, search: &Search, sets: &[Weighed], best: &Weighed) -> Vec<Weighed> {
    let Some(fit) = best.fit.map(|index| &search.fits[index]) else { return Vec::new() };
    let temper = search.temper(problem);
    let with = |glimpse: Glimpse| {
        let mut effects = best.effects.clone();
        effects.push(problem.candidates[glimpse.index].effect);
        effects.sort_unstable();
        let (cost, rare) = costs(problem, &[glimpse.index]);
        let nats = best.nats + (glimpse.gain / temper).min(HIDDEN);
        Weighed { effects, fit: None, nats, cost: best.cost + cost, rare: best.rare + rare }
    };
    let all = glimpses_beside(problem, fit).into_iter().map(with);
    all.filter(|set| !sets.iter().any(|other| other.effects == set.effects)).collect()
}

/// Of fits of the same effects, which began elsewhere and stand still elsewhere, the one that is worth most.
fn best_of_each(all: &mut Vec<Weighed>) {
    all.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    first_of_each(all, |set| set.effects.clone());
}

/// The set that was fitted and has most of something, of those that have any.
pub(crate) fn best(sets: &[Weighed], of: impl Fn(&Weighed) -> f64) -> Option<&Weighed> {
    let fitted = sets.iter().filter(|set| set.fit.is_some() && of(set) > 0.0);
    fitted.max_by(|a, b| of(a).total_cmp(&of(b)))
}

/// What a set has more than a smaller one must be worth it: one that takes less of what a gap has beyond the noise than the
/// other's formulation may leave is less than that one is; and by odds too, where it leaves more than `noise` itself. `left`
/// is what each of the sets leaves, by its place, and `strains` whether one has a nominal parameter beyond its tolerance that
/// another has as an effect: no formulation explains that.
pub(crate) fn worth_their_more(
    sets: &mut [Weighed],
    [nominal, closest, noise]: [f64; 3],
    left: impl Fn(usize) -> f64,
    strains: impl Fn(usize, usize) -> bool,
) {
    let is_exact = |set: &Weighed| set.effects.iter().all(|effect| EXACT.contains(effect));
    // what effects of one formulation take is none of what others may leave
    let inexact = |other: &Weighed| {
        let parts =
            (0..sets.len()).filter(|&part| is_exact(&sets[part]) && is_part(&sets[part].effects, &other.effects));
        (parts.map(&left).fold(nominal, f64::min) - closest).max(1.0)
    };
    let excess: Vec<f64> = sets.iter().map(|set| if is_exact(set) { 0.0 } else { inexact(set) }).collect();
    for index in 0..sets.len() {
        for other in 0..sets.len() {
            let closes = left(index) <= noise && left(other) > OPEN * noise;
            let least = if closes { LEAST_CLOSING } else { LEAST_SHARE } * excess[other];
            let worthless = is_part(&sets[other].effects, &sets[index].effects)
                && left(other) - left(index) < least
                && !strains(other, index);
            let needs = |set: &Weighed| if left(index) > noise { set.rare } else { set.cost };
            let most = sets[other].nats - needs(&sets[other]) + needs(&sets[index]) - 1.0;
            if worthless && sets[index].nats > most {
                sets[index].nats = most;
            }
        }
    }
}

/// Whether a fit has a nominal parameter beyond its tolerance that another has as an effect.
fn strains(problem: &Problem, fit: &Fit, other: &Fit) -> bool {
    let released = other.set.0.iter().filter(|index| !fit.set.0.contains(index));
    let released = released.flat_map(|&index| problem.candidates[index].releases);
    let mut places = released.filter_map(|name| problem.nuisance(name));
    places.any(|place| fit.shifts[place].abs() > BEYOND * problem.nuisances[place].tolerance)
}

/// Effects that together take much and each alone next to nothing stand against each other: of a motion that the logged
/// inputs have and the platform has not, noise for one, an unbalance is rid of by being smaller, and a constant torque puts
/// its mean back. `alone` is what an effect is worth by itself, where that is known [nats].
fn against_each_other(sets: &mut [Weighed], alone: impl Fn(&str) -> Option<f64>) {
    for set in sets.iter_mut().filter(|set| set.effects.len() > 1) {
        let most = set.effects.iter().filter_map(|effect| alone(effect)).reduce(f64::max).unwrap_or(set.nats);
        if most < ALONE / set.effects.len() as f64 * set.nats {
            set.nats = set.nats.min(most.max(0.0));
        }
    }
}

/// Evidence of an effect by itself, from its fit or else from the linear equations [nats]. A fit that is worse than the
/// nominal parameters alone, which it has too, has not found its way.
fn alone_worth(problem: &Problem, search: &Search, effect: &str, temper: f64) -> Option<f64> {
    let found = |fit: &&Fit| fit.effects == [effect] && fit.cost() < search.null.cost() + temper * LOST;
    let fitted = search.fits.iter().filter(found);
    let fitted = fitted.map(|fit| fit.evidence(temper) - search.null.evidence(temper)).reduce(f64::max);
    let own = |glimpse: &&Glimpse| problem.candidates[glimpse.index].effect == effect;
    fitted.or_else(|| search.glimpses.iter().find(own).map(|glimpse| glimpse.gain / temper))
}

/// Names of a fit's effects, in order.
pub(crate) fn names(fit: &Fit) -> Vec<&'static str> {
    let mut names = fit.effects.clone();
    names.sort_unstable();
    names
}

fn costs(problem: &Problem, set: &[usize]) -> (f64, f64) {
    let effects: Vec<&str> = set.iter().map(|&index| problem.candidates[index].effect).collect();
    costs_of(&effects, caution(problem))
}

/// Whether the platform neither rests, its bearing turning around most of the time, nor comes near a stop.
pub(crate) fn moves_freely(problem: &Problem) -> bool {
    !problem.turns_mostly && !problem.record.comes_near_a_stop()
}

/// How much more an effect must bring in this log than where the platform moves freely.
pub(crate) fn caution(problem: &Problem) -> f64 {
    if moves_freely(problem) {
        1.0
    } else if problem.turns_mostly {
        TURNING
    } else {
        AFTER_STOP
    }
}

/// What effects must bring to be named, and from where on they are likelier than not; `caution` times what they
/// must anywhere.
pub(crate) fn costs_of(effects: &[&str], caution: f64) -> (f64, f64) {
    let shifts = effects.iter().filter(|effect| !releases(effect).is_empty()).count() as f64;
    let added = effects.len() as f64 - shifts;
    let beside = RARE_BESIDE * (effects.len() as f64 - 1.0).max(0.0);
    let (cost, rare) = (NAMED * added + COST_OF_SHIFT * shifts, RARE * added + RARE_SHIFT * shifts + beside);
    (caution * cost, caution * rare)
}

/// What one stretch of the log carries alone, against the nominal parameters and against all but one of the effects.
/// A motor meets its ceiling in one stretch by nature.
fn alone(search: &Search, fit: &Fit) -> f64 {
    let smaller = search
        .fits
        .iter()
        .filter(|other| is_part(&other.effects, &fit.effects) && other.set.0.len() + 1 == fit.set.0.len());
    let has = |fit: &Fit| fit.effects.contains(&"torque_saturation");
    let steady = smaller.chain([&search.null]).filter(|smaller| has(smaller) == has(fit));
    steady.map(|smaller| carried_alone(smaller, fit)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::{Weighed, against_each_other, worth_their_more};

    fn set(effects: &[&'static str], nats: f64) -> Weighed {
        let more = effects.len() as f64;
        Weighed { effects: effects.to_vec(), fit: None, nats, cost: 18.0 * more, rare: 8.0 * more }
    }

    #[test]
    fn closed_form_what_a_formulation_may_leave_is_no_effect_but_an_exact_effect_leaves_nothing() {
        // 400 of a gap of a million
        let left = [600.0, 200.0];
        for (first, noise, stays, likelier) in [
            ("cable_hysteresis", 100.0, false, false),
            ("cable_hysteresis", 200.0, false, true),
            ("constant_torque", 100.0, true, true),
        ] {
            let mut sets = [set(&[first], 1e5), set(&[first, "viscous_friction"], 1e5 + 180.0)];
            worth_their_more(&mut sets, [1e6, 0.0, noise], |index| left[index], |_, _| false);
            assert_eq!(sets[1].nats - sets[1].cost > sets[0].nats - sets[0].cost, stays, "beside {first}");
            assert_eq!(sets[1].nats - sets[1].rare > sets[0].nats - sets[0].rare, likelier, "beside {first}, by odds");
        }
    }

    #[test]
    fn closed_form_what_an_exact_effect_takes_and_a_tolerance_that_is_left_are_no_formulations() {
        // beside the bias, which takes nearly all, the cable takes 2e4 and leaves 400 more than both with a drag
        let left = [2e4, 600.0, 200.0];
        for (strains, left_alone, stays) in [(false, 2e4, true), (false, 1e6, false), (true, 1e6, true)] {
            let mut sets = [
                set(&["pickoff_bias"], 4.9e5),
                set(&["cable_hysteresis", "pickoff_bias"], 5e5),
                set(&["cable_hysteresis", "pickoff_bias", "viscous_friction"], 5e5 + 180.0),
            ];
            let left = [left_alone, left[1], left[2]];
            worth_their_more(&mut sets, [1e6, 0.0, 300.0], |index| left[index], |_, _| strains);
            assert_eq!(sets[2].nats - sets[2].cost > sets[1].nats - sets[1].cost, stays, "{strains}, {left_alone}");
        }
    }

    #[test]
    fn closed_form_effects_that_take_next_to_nothing_alone_are_worth_no_more_together() {
        for (constant_torque, together) in [(10.0, 10.0), (120.0, 200.0)] {
            let mut sets = [set(&["constant_torque", "mass_unbalance"], 200.0), set(&["stribeck"], 5.0)];
            let alone = |effect: &str| Some(if effect == "constant_torque" { constant_torque } else { -6.0 });
            against_each_other(&mut sets, alone);
            assert_eq!(sets.map(|set| set.nats.to_bits()), [together, 5.0].map(f64::to_bits));
        }
    }
}
