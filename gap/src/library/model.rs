//! What the model file says beside the nominal parameters: effects that are known, parts that are known to be good.

use gimbal_model_file::{ModelFile, known_good};

use super::{Nuisance, PURE_DELAY, apply};
use crate::simulate::Physics;

/// Effects of which a platform has one: a second would take its place, so a change of it is not looked for.
const ONE_OF_A_KIND: [&str; 8] = [
    "stribeck",
    "presliding",
    "friction_drift",
    "cable_hysteresis",
    "torque_ripple",
    "torque_saturation",
    "pickoff_quantisation",
    "flexible_mode",
];
/// Nominal parameters of parts, by their names among the nuisances.
const NOMINAL: [(&str, &[&str]); 10] = [
    ("gyro", &["gyro_damping", "angular_momentum", "float inertia"]),
    ("servo", &["loop_gain", "T1", "T2", "T3", "T4", "T5", "T6", "T7", "T8", "T9"]),
    ("motor", &["motor_lag", PURE_DELAY]),
    ("torque_sensor", &["torque read late"]),
    (
        "bearing",
        &[
            "friction_level",
            "bearing viscosity",
            "slip rate",
            "roundness of the clamp",
            "roundness of half its width",
            "roundness of its corners alone",
            "displacement of the clamp",
        ],
    ),
    ("balance", &["unbalance x", "unbalance y"]),
    ("mass_unbalance", &["unbalance x", "unbalance y"]),
    ("structure", &["gimbal_inertia"]),
    ("accelerometers", &["accelerometers about x", "accelerometers about y", "accelerometers about z"]),
    ("viscous_friction", &["bearing viscosity"]),
];
/// Of its tolerance: how far a parameter of a known part may move.
const HELD: f64 = 1e-3;

/// The platform that a model file describes.
#[must_use]
pub fn platform(model: &ModelFile) -> Physics {
    let mut physics = Physics::nominal(&model.config);
    for entry in &model.effects {
        apply(entry.effect.name(), &entry.values, &mut physics);
    }
    physics
}

/// Effects that are not looked for under a model file.
#[must_use]
pub fn not_looked_for(model: &ModelFile) -> Vec<&'static str> {
    let known = model.effects.iter().map(|entry| entry.effect.name()).filter(|name| ONE_OF_A_KIND.contains(name));
    known_good::effects_of(&model.known_good).into_iter().chain(known).collect()
}

/// Holds the nominal parameters of parts that are known to be good.
pub fn hold(nuisances: &mut [Nuisance], known: &[&str]) {
    let effects = known_good::effects_of(known);
    let of_part = |name: &str| {
        NOMINAL.iter().any(|(part, own)| (known.contains(part) || effects.contains(part)) && own.contains(&name))
    };
    for nuisance in nuisances.iter_mut().filter(|own| effects.contains(&own.name) || of_part(own.name)) {
        nuisance.hold(HELD);
    }
}
