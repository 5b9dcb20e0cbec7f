//! What speaks against a set of effects, whatever it takes away.

use gimbal_model_file::Tolerance;
use gimbal_plant::{Bound, Effect, Parameter};

use super::set::with_one_less;
use crate::fit::{Fit, Problem, Search};
use crate::library::PURE_DELAY;

/// A parameter at the end of its range [nats].
const BOUND_HIT: f64 = 20.0;
/// From this many times beyond its range on a shape is no realistic one: it is ruled out.
const FAR_BEYOND: f64 = 10.0;
/// How far the noise of the logged rate goes in a row, times this: what builds up within it may be what friction makes of that
/// noise.
const BLURRED: f64 = 15.0;
/// Effects that take energy, or that there are more of at low rate: less than none of them there is not.
const NEVER_NEGATIVE: [&str; 2] = ["cable_hysteresis", "stribeck"];
/// Share of the gimbal's inertia from which on an appendage is none.
const MOST_OF_IT: f64 = 0.5;
/// Damping ratio from which on a mode hardly rings, and is a bend of the loop.
const HARDLY_RINGS: f64 = 0.5;
/// Share of its least realistic value below which a size hits the end of its range.
const FAR_BELOW: f64 = 0.03;
/// Share of the motor's delay up to which it may be more or less pure beside an effect that shifts that delay.
const MORE_OR_LESS_PURE: f64 = 0.05;
/// Nominal parameters that may stand at the end of their tolerance, and what each one more costs: they stand for something that
/// the set has not [nats].
const HELD: usize = 3;
const HELD_COSTS: f64 = 10.0;
/// A nominal parameter is an effect from this many tolerances on.
pub(super) const BEYOND: f64 = 1.15;
/// What an effect must take away to be there when its size is not known to be more than zero [nats].
pub(crate) const HELPS: f64 = 12.0;
/// What rules a set out; and what does so whatever it takes away [nats].
pub(crate) const NEVER: f64 = 1e3;
const RULED_OUT: f64 = 1e12;

/// What speaks against a set: an effect of no size, a shape beyond its range, a parameter inside its tolerance.
pub(super) fn against(problem: &Problem, search: &Search, fit: &Fit, tolerance: &Tolerance) -> f64 {
    let record = problem.record;
    let shortest_rad = BLURRED * record.rate_noise.rms_radps * record.inputs.period_s;
    let of = |(place, &index): (usize, &usize)| {
        let candidate = &problem.candidates[index];
        let (values, errors) = (&fit.values[place], &fit.errors[place]);
        let idle = if fit.is_idle(place) && !helps(search, fit, place) { NEVER } else { 0.0 };
        let values = if candidate.effect == "cable_hysteresis" && fit.effects.contains(&"presliding") {
            beside_presliding(at_a_bound(candidate.effect, values, errors))
        } else if candidate.effect == "presliding" && values[0] < shortest_rad {
            NEVER
        } else if candidate.effect == "flexible_mode" && is_aliased(record.inputs.period_s, values, errors) {
            RULED_OUT
        } else if candidate.releases.is_empty() {
            at_a_bound(candidate.effect, values, errors)
        } else if beyond(problem, tolerance, candidate.effect, values, errors) {
            0.0
        } else {
            NEVER
        };
        idle + traded(problem, fit, candidate.effect) + values
    };
    let strained = HELD_COSTS * fit.held(problem).saturating_sub(HELD) as f64;
    fit.set.0.iter().enumerate().map(of).sum::<f64>() + strained
}

/// Whether a mode rings faster than rows can show, by more than its error: it is a bend of the loop.
fn is_aliased(period_s: f64, values: &[f64], errors: &[f64]) -> bool {
    values[1] - errors[1] > 0.5 / period_s
}

/// What speaks against a longer lag of which a part is pure, which a delay more is by itself; and against a delay more that
/// leaves the motor less pure than a lag, which a longer lag is [nats].
fn traded(problem: &Problem, fit: &Fit, effect: &str) -> f64 {
    let pure = problem.nuisance(PURE_DELAY).map_or(0.0, |place| fit.shifts[place]);
    let traded = match effect {
        "motor_lag" => pure,
        "loop_delay" => (-pure).max(0.0),
        _ => 0.0,
    };
    2.0 * (0.5 * (traded / MORE_OR_LESS_PURE).powi(2)).ln_1p()
}

/// What a bound of a cable's loop costs where friction builds up over a displacement: one that yields as soon as that does is the
/// same in another formulation [nats].
fn beside_presliding(at_a_bound: f64) -> f64 {
    if at_a_bound > 0.0 { RULED_OUT } else { 0.0 }
}

/// Whether a fit is worth more with an effect than without it, though size and shape stand for each other.
fn helps(search: &Search, fit: &Fit, place: usize) -> bool {
    let mut smaller = with_one_less(search, fit, fit.effects[place]).peekable();
    smaller.peek().is_some() && smaller.all(|smaller| smaller.square - fit.square > 2.0 * HELPS)
}

/// What a shape beyond its realistic range by more than its error costs: a cable's loop as long as the motion is a
/// spring; a size that has a least one, far below it: how soon friction builds up is then what the law is at zero rate; and
/// one beyond all that are realistic that may as well be none: a mode of all the inertia is a hump of the noise.
pub(crate) fn at_a_bound(effect: &str, values: &[f64], errors: &[f64]) -> f64 {
    let Some(effect) = Effect::from_name(effect) else { return 0.0 };
    if NEVER_NEGATIVE.contains(&effect.name()) && values[0] < 0.0 {
        return RULED_OUT;
    }
    let mode = effect.name() == "flexible_mode";
    if mode && (values[0] - errors[0] > MOST_OF_IT || values[2] - errors[2] > HARDLY_RINGS) {
        return RULED_OUT;
    }
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
        RULED_OUT
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
    use super::{BOUND_HIT, RULED_OUT, at_a_bound};

    #[test]
    fn closed_form_a_size_beyond_all_realistic_ones_is_none_unless_it_is_known() {
        for (share, error, costs) in [(0.92, 1.1, BOUND_HIT), (0.4, 0.1, 0.0), (0.92, 0.1, RULED_OUT)] {
            let cost = at_a_bound("flexible_mode", &[share, 46.0, 0.1], &[error, 2.0, 0.05]);
            assert_eq!(cost.to_bits(), costs.to_bits(), "{share} +- {error}");
        }
    }

    #[test]
    fn closed_form_a_shape_far_beyond_its_range_and_less_than_no_excess_are_ruled_out() {
        // a rate of 5e-3 rad/s is the least realistic one
        for (rate_radps, costs) in [(5e-3, 0.0), (2e-3, BOUND_HIT), (4e-4, RULED_OUT)] {
            let cost = at_a_bound("stribeck", &[5e-4, rate_radps], &[5e-5, 1e-5]);
            assert_eq!(cost.to_bits(), costs.to_bits(), "{rate_radps} rad/s");
        }
        assert_eq!(at_a_bound("stribeck", &[-5e-4, 5e-2], &[5e-5, 1e-3]).to_bits(), RULED_OUT.to_bits());
    }
}
