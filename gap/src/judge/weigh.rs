//! What every set of effects is worth: its evidence, less what speaks against it.

use gimbal_model_file::Tolerance;
use gimbal_plant::{Bound, Effect, Parameter};

use super::stretch::carried_alone;
use crate::fit::{Fit, Glimpse, Problem, Search, first_of_each, glimpses_beside};
use crate::library::{NAMED, releases};

/// Evidence that a nominal parameter beyond its tolerance must bring to be named [nats].
pub(crate) const COST_OF_SHIFT: f64 = 15.0;
/// How much more where the bearing turns around most of the time: its friction is as good as unknown there.
const TURNING: f64 = 2.0;
/// The same after a stop: what follows one hangs on it by more than a line.
const AFTER_STOP: f64 = 1.25;
/// Evidence from which on an effect is likelier than not, from logs with open answers [nats].
const RARE: f64 = 7.5;
pub(crate) const RARE_SHIFT: f64 = 5.0;
/// The same for every effect beside the first, on top.
const RARE_BESIDE: f64 = 4.0;
/// A parameter at the end of its range [nats].
const BOUND_HIT: f64 = 20.0;
/// From this many times beyond its range on a shape is no realistic one: it is ruled out.
const FAR_BEYOND: f64 = 10.0;
/// How far the noise of the logged rate goes in a row, times this: what builds up within it may be what friction makes of that
/// noise.
const BLURRED: f64 = 15.0;
/// Share of its least realistic value below which a size hits the end of its range.
const FAR_BELOW: f64 = 0.03;
/// A nominal parameter is an effect from this many tolerances on.
pub(super) const BEYOND: f64 = 1.15;
/// Least share of the gap that an effect takes away: less may be what another formulation of the others is.
const LEAST_SHARE: f64 = 0.003;
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
/// What an effect must take away to be there when its size is not known to be more than zero [nats].
pub(crate) const HELPS: f64 = 12.0;
/// What an effect that was not worth a fit brings at most [nats].
const HIDDEN: f64 = 3.0;
/// What rules a set out; and what does so whatever it takes away [nats].
pub(crate) const NEVER: f64 = 1e3;
const RULED_OUT: f64 = 1e12;

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
    let mut all: Vec<Weighed> = search
        .fits
        .iter()
        .enumerate()
        .map(|(index, fit)| {
            let evidence = fit.evidence(temper) - search.null.evidence(temper) - alone(search, fit) / temper;
            let (cost, rare) = costs(problem, &fit.set.0);
            let nats = evidence - against(problem, search, fit, tolerance);
            Weighed { effects: names(fit), fit: Some(index), nats, cost, rare }
        })
        .collect();
    best_of_each(&mut all);
    let excess = (search.null.square - closest.square).max(1.0);
    let left: Vec<f64> = all.iter().map(|set| set.fit.map_or(f64::NAN, |fit| search.fits[fit].cost())).collect();
    worth_their_more(&mut all, excess, |place| left[place]);
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
/// other's formulation may leave is less than that one is. `left` is what each of the sets leaves, by its place.
pub(crate) fn worth_their_more(sets: &mut [Weighed], excess: f64, left: impl Fn(usize) -> f64) {
    for index in 0..sets.len() {
        for other in 0..sets.len() {
            let exact = sets[other].effects.iter().all(|effect| EXACT.contains(effect));
            let least = if exact { 0.0 } else { LEAST_SHARE * excess };
            let worthless = is_part(&sets[other].effects, &sets[index].effects) && left(other) - left(index) < least;
            let most = sets[other].nats - sets[other].cost + sets[index].cost - 1.0;
            if worthless && sets[index].nats > most {
                sets[index].nats = most;
            }
        }
    }
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

/// Evidence of an effect by itself, from its fit or else from the linear equations [nats].
fn alone_worth(problem: &Problem, search: &Search, effect: &str, temper: f64) -> Option<f64> {
    let fitted = search.fits.iter().filter(|fit| fit.effects == [effect]);
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

/// Whether a set holds all of another one.
pub(crate) fn holds(larger: &[&str], smaller: &[&str]) -> bool {
    smaller.iter().all(|effect| larger.contains(effect))
}

/// The same, and more.
pub(crate) fn is_part(smaller: &[&str], larger: &[&str]) -> bool {
    smaller.len() < larger.len() && holds(larger, smaller)
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

/// What speaks against a set: an effect of no size, a shape beyond its range, a parameter inside its tolerance.
fn against(problem: &Problem, search: &Search, fit: &Fit, tolerance: &Tolerance) -> f64 {
    let record = problem.record;
    let shortest_rad = BLURRED * record.rate_noise.rms_radps * record.inputs.period_s;
    let of = |(place, &index): (usize, &usize)| {
        let candidate = &problem.candidates[index];
        let (values, errors) = (&fit.values[place], &fit.errors[place]);
        let idle = if fit.is_idle(place) && !helps(search, fit, place) { NEVER } else { 0.0 };
        idle + if candidate.effect == "cable_hysteresis" && fit.effects.contains(&"presliding") {
            beside_presliding(at_a_bound(candidate.effect, values, errors))
        } else if candidate.effect == "presliding" && values[0] < shortest_rad {
            NEVER
        } else if candidate.releases.is_empty() {
            at_a_bound(candidate.effect, values, errors)
        } else if beyond(problem, tolerance, candidate.effect, values, errors) {
            0.0
        } else {
            NEVER
        }
    };
    fit.set.0.iter().enumerate().map(of).sum()
}

/// What a bound of a cable's loop costs where friction builds up over a displacement: one that yields as soon as that does is the
/// same in another formulation [nats].
fn beside_presliding(at_a_bound: f64) -> f64 {
    if at_a_bound > 0.0 { RULED_OUT } else { 0.0 }
}

/// Whether a fit is worth more with an effect than without it, though size and shape stand for each other.
fn helps(search: &Search, fit: &Fit, place: usize) -> bool {
    let without = |other: &&Fit| {
        other.set.0.len() + 1 == fit.set.0.len()
            && is_part(&other.effects, &fit.effects)
            && !other.effects.contains(&fit.effects[place])
    };
    let alone = fit.set.0.len() == 1;
    let mut smaller = search.fits.iter().filter(without).chain(alone.then_some(&search.null)).peekable();
    smaller.peek().is_some() && smaller.all(|smaller| smaller.square - fit.square > 2.0 * HELPS)
}

/// What a shape beyond its realistic range by more than its error costs: a cable's loop as long as the motion is a
/// spring; a size that has a least one, far below it: how soon friction builds up is then what the law is at zero rate; and
/// one beyond all that are realistic that may as well be none: a mode of all the inertia is a hump of the noise.
pub(crate) fn at_a_bound(effect: &str, values: &[f64], errors: &[f64]) -> f64 {
    let Some(effect) = Effect::from_name(effect) else { return 0.0 };
    let shapes = effect.parameters().iter().zip(values.iter().zip(errors)).skip(effect.sizes());
    let outside = |(parameter, (value, error)): (&Parameter, (&f64, &f64)), times: f64| {
        let factor = times * (2.0 * error / value.abs().max(1e-30)).min(2.0).exp();
        parameter.bound != Bound::Any && (value * factor < parameter.low || value / factor > parameter.high)
    };
    let sizes = effect.parameters().iter().zip(values.iter().zip(errors)).take(effect.sizes());
    let too_small_or_unknown = |(parameter, (value, error)): (&Parameter, (&f64, &f64))| {
        let unknown = *value > parameter.high && 2.0 * error > *value;
        parameter.bound == Bound::NotNegative && (*value < FAR_BELOW * parameter.low || unknown)
    };
    if shapes.clone().any(|shape| outside(shape, FAR_BEYOND)) {
        NEVER
    } else if shapes.clone().any(|shape| outside(shape, 1.0)) || sizes.into_iter().any(too_small_or_unknown) {
        BOUND_HIT
    } else {
        0.0
    }
}

/// Whether a nominal parameter is beyond its tolerance by more than its own error.
pub(crate) fn beyond(problem: &Problem, tolerance: &Tolerance, effect: &str, values: &[f64], errors: &[f64]) -> bool {
    let scale = if effect == "mass_unbalance" {
        let unbalance = &problem.base.config.unbalance;
        unbalance.x_kg_m.hypot(unbalance.y_kg_m).max(1e-6)
    } else {
        1.0
    };
    values.iter().zip(errors).any(|(value, error)| value.abs() - error > BEYOND * tolerance.of(effect) * scale)
}

#[cfg(test)]
mod tests {
    use super::{BOUND_HIT, NEVER, Weighed, against_each_other, at_a_bound, worth_their_more};

    fn set(effects: &[&'static str], nats: f64) -> Weighed {
        Weighed { effects: effects.to_vec(), fit: None, nats, cost: 18.0 * effects.len() as f64, rare: 8.0 }
    }

    #[test]
    fn closed_form_what_a_formulation_may_leave_is_no_effect_but_an_exact_effect_leaves_nothing() {
        // 400 of a gap of a million
        let left = [600.0, 200.0];
        for (first, stays) in [("cable_hysteresis", false), ("constant_torque", true)] {
            let mut sets = [set(&[first], 1e5), set(&[first, "viscous_friction"], 1e5 + 180.0)];
            worth_their_more(&mut sets, 1e6, |index| left[index]);
            assert_eq!(sets[1].nats - sets[1].cost > sets[0].nats - sets[0].cost, stays, "beside {first}");
        }
    }

    #[test]
    fn closed_form_a_size_beyond_all_realistic_ones_is_none_unless_it_is_known() {
        for (error, costs) in [(1.1, BOUND_HIT), (0.1, 0.0)] {
            let cost = at_a_bound("flexible_mode", &[0.92, 46.0, 0.1], &[error, 2.0, 0.05]);
            assert_eq!(cost.to_bits(), costs.to_bits(), "+- {error}");
        }
    }

    #[test]
    fn closed_form_a_shape_far_beyond_its_range_is_ruled_out() {
        // a rate of 5e-3 rad/s is the least realistic one
        for (rate_radps, costs) in [(5e-3, 0.0), (2e-3, BOUND_HIT), (4e-4, NEVER)] {
            let cost = at_a_bound("stribeck", &[5e-4, rate_radps], &[5e-5, 1e-5]);
            assert_eq!(cost.to_bits(), costs.to_bits(), "{rate_radps} rad/s");
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
