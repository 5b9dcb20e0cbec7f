//! What hangs on a specific force that stands still: a constant, in another name.

use gimbal_plant::Effect;

use super::weigh::Weighed;
use crate::fit::Fit;

/// What an effect is where the specific force stands still.
const CONSTANT_AT_REST: [(&str, &[&str]); 4] = [
    ("mass_unbalance", &["constant_torque", "torque_bias"]),
    ("anisoelasticity", &["constant_torque", "torque_bias"]),
    ("g_sensitive_float_torque", &["float_torque"]),
    ("load_dependence", &["friction_level"]),
];

/// What hangs on a force that stands still is a constant, of more numbers than one or of another size: worth no more than that,
/// and nothing where it would have to be larger than any.
pub(super) fn as_constant(sets: &mut [Weighed], is_realistic: impl Fn(usize, &str) -> bool) {
    for index in 0..sets.len() {
        for (own, constants) in CONSTANT_AT_REST {
            let Some(place) = sets[index].effects.iter().position(|effect| *effect == own) else { continue };
            let instead = |constant: &&'static str| {
                let mut effects = sets[index].effects.clone();
                effects[place] = constant;
                effects.sort_unstable();
                sets.iter().find(|set| set.effects == effects).map(|set| (set.nats, set.cost, set.rare))
            };
            let best = constants.iter().filter_map(instead).max_by(|a, b| a.0.total_cmp(&b.0));
            let is_realistic = sets[index].fit.is_none_or(|fit| is_realistic(fit, own));
            let set = &mut sets[index];
            if !is_realistic {
                set.nats = set.nats.min(0.0);
            } else if let Some((nats, cost, rare)) = best {
                (set.nats, set.cost, set.rare) = (set.nats.min(nats), cost, rare);
            }
        }
    }
}

/// Whether a fit has an effect of a size that there is.
pub(super) fn is_realistic(fit: &Fit, effect: &str) -> bool {
    let place = fit.effects.iter().position(|own| *own == effect);
    let Some((place, entry)) = place.zip(Effect::from_name(effect)) else { return true };
    let sizes = fit.values[place].iter().zip(&fit.errors[place]).zip(entry.parameters()).take(entry.sizes());
    sizes.into_iter().all(|((value, error), own)| value.abs() - 2.0 * error < own.low.abs().max(own.high.abs()))
}

#[cfg(test)]
mod tests {
    use super::{Weighed, as_constant};

    #[test]
    fn closed_form_at_rest_what_hangs_on_the_force_is_worth_what_a_constant_is() {
        let set = |effects: &[&'static str], nats: f64, cost: f64, fit: Option<usize>| Weighed {
            effects: effects.to_vec(),
            fit,
            nats,
            cost,
            rare: 16.5,
        };
        let sets = [
            set(&["stribeck", "torque_bias"], 90.0, 36.0, Some(1)),
            set(&["mass_unbalance", "stribeck"], 97.0, 33.0, Some(0)),
        ];
        for (is_realistic, worth) in [(true, 90.0), (false, 0.0)] {
            let mut sets = sets.clone();
            as_constant(&mut sets, |_, _| is_realistic);
            assert_eq!(sets.map(|set| set.nats.to_bits()), [90.0, worth].map(f64::to_bits));
        }
    }
}
