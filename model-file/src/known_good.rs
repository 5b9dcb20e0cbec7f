//! `[known_good]`: parts that are known to do what the model says, a calibrated sensor for one.

use gimbal_plant::Effect;
use toml::de::{DeTable, DeValue};

use crate::error::Problem;
use crate::fields::nearest;
use crate::merge::Wrong;

/// Parts, and the effects that would be theirs.
pub const PARTS: [(&str, &[&str]); 11] = [
    ("torque_sensor", &["torque_scale", "torque_bias"]),
    ("pickoff", &["pickoff_scale", "pickoff_bias", "pickoff_quantisation"]),
    ("gyro", &["gyro_damping", "angular_momentum", "stop_angle", "float_torque", "g_sensitive_float_torque"]),
    ("servo", &["loop_gain", "loop_delay"]),
    ("motor", &["motor_lag", "torque_saturation", "dead_zone", "torque_ripple"]),
    (
        "bearing",
        &[
            "friction_level",
            "viscous_friction",
            "stribeck",
            "presliding",
            "load_dependence",
            "direction_asymmetry",
            "quadratic_drag",
            "friction_drift",
        ],
    ),
    ("balance", &["mass_unbalance", "anisoelasticity"]),
    ("cable", &["cable_spring", "cable_hysteresis"]),
    ("structure", &["gimbal_inertia", "flexible_mode"]),
    ("accelerometers", &[]),
    ("clock", &["time_skew"]),
];

/// The name as it stands in the lists.
///
/// # Errors
/// What would be right, for a name that is neither a part nor an effect.
pub fn part(name: &str) -> Result<&'static str, String> {
    let part = PARTS.iter().map(|(part, _)| *part).find(|part| *part == name);
    part.or_else(|| Effect::from_name(name).map(Effect::name)).ok_or_else(|| {
        let parts: Vec<&str> = PARTS.iter().map(|(part, _)| *part).collect();
        let near = nearest(name, parts.iter().copied().chain(Effect::all().map(Effect::name)));
        format!(
            "`{name}` is not a part that can be known to be good; the nearest known one is `{near}`; parts: {}; \
             or the name of an effect",
            parts.join(", ")
        )
    })
}

/// Effects of parts and names.
#[must_use]
pub fn effects_of(known_good: &[&str]) -> Vec<&'static str> {
    let mut effects: Vec<&'static str> = Vec::new();
    for name in known_good {
        match PARTS.iter().find(|(part, _)| part == name) {
            Some((_, own)) => effects.extend(*own),
            None => effects.extend(Effect::from_name(name).map(Effect::name)),
        }
    }
    effects
}

/// Reads `parts = [...]`.
pub(crate) fn read(table: &DeTable) -> Result<Vec<&'static str>, Wrong> {
    let mut known = Vec::new();
    for (key, value) in table {
        let name = key.get_ref().as_ref();
        if name != "parts" {
            let (table, nearest) = ("known_good".to_owned(), "parts".to_owned());
            return Err((key.span(), Problem::UnknownKey { table, name: name.to_owned(), nearest }));
        }
        let wrong = |span, found: &str| {
            let (name, expected) =
                ("known_good.parts".to_owned(), "an array of names such as \"torque_sensor\"".to_owned());
            (span, Problem::WrongType { name, found: found.to_owned(), expected })
        };
        let DeValue::Array(entries) = value.get_ref() else { return Err(wrong(value.span(), "no array")) };
        for entry in entries {
            let DeValue::String(text) = entry.get_ref() else {
                return Err(wrong(entry.span(), "an array of other things"));
            };
            known.push(part(text).map_err(|message| (entry.span(), Problem::Impossible(message)))?);
        }
    }
    Ok(known)
}
