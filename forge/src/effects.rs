//! Effects by name: those of the contract's table, each in a formulation of the forge's own, and those beyond it.

mod beyond;
mod library;

use serde::{Deserialize, Serialize};

use crate::draw::{Draw, Seed};
use crate::sensors::Sensors;
use crate::truth::Truth;

/// The true platform and the instruments on it.
#[derive(Debug, Clone)]
pub struct World {
    /// The platform.
    pub truth: Truth,
    /// The instruments.
    pub sensors: Sensors,
}

/// What the sizes and shapes of effects are scaled by: the run without any effect.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// Largest motor torque [N m].
    pub torque_nm: f64,
    /// Largest relative angle [rad].
    pub relative_rad: f64,
    /// Largest relative rate [rad/s].
    pub rate_radps: f64,
    /// Length of the record [s].
    pub length_s: f64,
    /// Rows of the track, those before the record included.
    pub rows: usize,
    /// Rows before the record.
    pub before: usize,
    /// Time between rows [s].
    pub period_s: f64,
}

/// A number that an effect has.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Name; what is compared is the place in the list, sizes first, in the order of the contract.
    pub name: String,
    /// In SI units.
    pub value: f64,
    /// SI unit.
    pub unit: String,
}

/// How an effect's size is found and limited.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    /// The smallest size that makes sense: what is less is there in every platform.
    pub small: f64,
    /// The largest size that still makes sense.
    pub largest: f64,
}

/// One effect with everything but its size.
#[derive(Debug, Clone)]
pub struct Effect {
    /// Its name.
    pub name: &'static str,
    sign: f64,
    shape: [f64; 4],
    seed: Seed,
}

/// Effects of the contract's table, by block.
pub const LIBRARY: [(&str, &[&str]); 6] = [
    (
        "friction",
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
    (
        "disturbance",
        &[
            "mass_unbalance",
            "anisoelasticity",
            "cable_spring",
            "cable_hysteresis",
            "torque_ripple",
            "constant_torque",
            "cross_axis_coupling",
        ],
    ),
    ("servo", &["loop_gain", "loop_delay", "motor_lag", "torque_saturation", "dead_zone", "pickoff_quantisation"]),
    ("gyro", &["gyro_damping", "angular_momentum", "stop_angle", "float_torque", "g_sensitive_float_torque"]),
    ("structure", &["gimbal_inertia", "flexible_mode"]),
    ("measurement", &["pickoff_scale", "pickoff_bias", "torque_scale", "torque_bias", "time_skew"]),
];

/// Effects that the table does not have, each of another nature.
pub const BEYOND: [&str; 14] = [
    "position_dependent_friction",
    "coloured_torque",
    "torque_pulses",
    "bistable_spring",
    "intermittent_contact",
    "stick_slip_chatter",
    "motor_heating",
    "backlash",
    "wheel_hunting",
    "cable_creep",
    "servo_dropout",
    "float_restraint",
    "torque_asymmetry",
    "rate_squared_torque",
];

/// All names of the contract's table.
pub fn library_names() -> impl Iterator<Item = &'static str> {
    LIBRARY.iter().flat_map(|(_, names)| names.iter().copied())
}

/// The block of an effect; `beyond` for those that the table does not have.
#[must_use]
pub fn block_of(name: &str) -> &'static str {
    LIBRARY.iter().find(|(_, names)| names.contains(&name)).map_or("beyond", |(block, _)| block)
}

impl Effect {
    /// Draws sign and shape.
    #[must_use]
    pub fn draw(name: &'static str, draw: &mut Draw) -> Self {
        let mut own = draw.fork();
        let sign = own.sign();
        let shape = core::array::from_fn(|_| own.unit());
        let mut seed = [0; 32];
        for byte in seed.chunks_mut(8) {
            byte.copy_from_slice(&own.unit().to_bits().to_le_bytes());
        }
        Self { name, sign, shape, seed }
    }

    /// A plain shape in the middle of every range.
    #[must_use]
    pub fn plain(name: &'static str) -> Self {
        Self { name, sign: 1.0, shape: [0.5; 4], seed: [0; 32] }
    }

    /// Whether the table of the contract has it.
    #[must_use]
    pub fn in_library(&self) -> bool {
        block_of(self.name) != "beyond"
    }

    /// Sizes that make sense.
    #[must_use]
    pub fn range(&self) -> Range {
        let (small, largest) = library::range(self).or_else(|| beyond::range(self)).unwrap_or((1e-3, 1.0));
        Range { small, largest }
    }

    /// Puts the effect into a world.
    pub fn apply(&self, size: f64, scale: &Scale, world: &mut World) {
        if self.in_library() {
            library::apply(self, size, scale, world);
        } else {
            beyond::apply(self, size, scale, world);
        }
    }

    /// Its parameters at a size, in the order of the contract.
    #[must_use]
    pub fn parameters(&self, size: f64, scale: &Scale) -> Vec<Parameter> {
        let list = if self.in_library() { library::parameters(self, size, scale) } else { vec![("size", size, "1")] };
        list.into_iter()
            .map(|(name, value, unit)| Parameter { name: name.to_owned(), value, unit: unit.to_owned() })
            .collect()
    }

    fn between(&self, place: usize, from: f64, to: f64) -> f64 {
        from + (to - from) * self.shape[place]
    }

    fn between_logs(&self, place: usize, from: f64, to: f64) -> f64 {
        libm::exp(self.between(place, libm::log(from), libm::log(to)))
    }
}
