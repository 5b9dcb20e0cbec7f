//! Units of the columns: what they measure, and their size in the unit of the model.

use serde::Deserialize;

/// How the axis moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Along a line: m, m/s.
    Linear,
    /// About an axis: rad, rad/s.
    Rotary,
}

/// What a column measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Time [s].
    Time,
    /// Position [m or rad].
    Position,
    /// Rate [m/s or rad/s].
    Rate,
    /// Effort, in the unit of the model.
    Effort,
    /// Anything.
    Any,
}

use std::f64::consts::{PI, TAU};

const TIME: &[(&str, f64)] = &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9), ("min", 60.0)];
const LINEAR: &[(&str, f64)] = &[("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("cm", 1e-2), ("in", 0.0254)];
const ROTARY: &[(&str, f64)] =
    &[("rad", 1.0), ("mrad", 1e-3), ("deg", PI / 180.0), ("rev", TAU), ("arcsec", PI / 648_000.0)];
const LINEAR_RATE: &[(&str, f64)] = &[("m/s", 1.0), ("mm/s", 1e-3), ("um/s", 1e-6), ("mm/min", 1e-3 / 60.0)];
const ROTARY_RATE: &[(&str, f64)] =
    &[("rad/s", 1.0), ("mrad/s", 1e-3), ("deg/s", PI / 180.0), ("rpm", TAU / 60.0), ("rev/s", TAU)];
const EFFORT: &[(&str, &str, f64)] = &[
    ("N", "N", 1.0),
    ("N", "kN", 1e3),
    ("N", "mN", 1e-3),
    ("N m", "N m", 1.0),
    ("N m", "mN m", 1e-3),
    ("A", "A", 1.0),
    ("A", "mA", 1e-3),
    ("V", "V", 1.0),
    ("V", "mV", 1e-3),
];

impl Quantity {
    /// Units of this quantity and their sizes.
    fn units(self, motion: Motion, effort_unit: &str) -> Vec<(&'static str, f64)> {
        match (self, motion) {
            (Self::Time, _) => TIME.to_vec(),
            (Self::Position, Motion::Linear) => LINEAR.to_vec(),
            (Self::Position, Motion::Rotary) => ROTARY.to_vec(),
            (Self::Rate, Motion::Linear) => LINEAR_RATE.to_vec(),
            (Self::Rate, Motion::Rotary) => ROTARY_RATE.to_vec(),
            (Self::Effort, _) => {
                EFFORT.iter().filter(|entry| entry.0 == effort_unit).map(|entry| (entry.1, entry.2)).collect()
            }
            (Self::Any, _) => Vec::new(),
        }
    }

    /// Size of a unit; the known ones where it is none of them.
    pub(super) fn size(self, unit: &str, motion: Motion, effort_unit: &str) -> Result<f64, String> {
        let units = self.units(motion, effort_unit);
        if self == Self::Any || self == Self::Effort && unit == effort_unit {
            return Ok(1.0);
        }
        let known = || units.iter().map(|(name, _)| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
        units.iter().find(|(name, _)| *name == unit).map(|(_, size)| *size).ok_or_else(|| {
            if units.is_empty() {
                format!("write \"{effort_unit}\", the axis' own `effort_unit`, and a `scale` beside it")
            } else {
                format!("write one of {} (and a `scale` where none of them fits)", known())
            }
        })
    }
}

impl Motion {
    /// Unit of the position.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Linear => "m",
            Self::Rotary => "rad",
        }
    }
}
