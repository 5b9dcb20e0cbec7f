//! `[axis]`: a plain servo axis without a gyro, and where its signals stand in a foreign log.
//!
//! ```text
//! effort = inertia * d2(position)/dt2 + viscous * d(position)/dt + coulomb * sgn(d(position)/dt)
//! ```
//!
//! Effort is what drives the axis, in the unit in which it is logged: force, torque or motor current. Parameters are
//! in that unit per unit of motion, so that a log in ampere needs no torque constant.

mod effects;
mod read;
mod unit;

use std::collections::BTreeMap;

use serde::Deserialize;

pub use effects::EFFECTS;
pub use unit::{Motion, Quantity};

/// A single-axis servo and its log.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisModel {
    /// `"linear"` (position in m) or `"rotary"` (position in rad).
    pub motion: Motion,
    /// Unit of the effort, and so of every parameter: `"N"`, `"N m"`, `"A"`, `"V"`.
    pub effort_unit: String,
    /// Effort per acceleration [effort s2/position], above zero.
    pub inertia: f64,
    /// Effort per rate [effort s/position].
    #[serde(default)]
    pub viscous: f64,
    /// Effort that friction takes at any rate.
    #[serde(default)]
    pub coulomb: f64,
    /// Largest effort of the drive.
    pub effort_limit: Option<f64>,
    /// Whether the logged effort holds from one row to the next (a command), or is a sample (a measurement).
    #[serde(default)]
    pub effort_held: bool,
    /// Sign with which a load channel adds to the effort that the axis needs: 1 or -1.
    #[serde(default = "one")]
    pub load_direction: f64,
    /// Upper edge of the band in which the balance is made [Hz]; chosen from the data where it is not given.
    pub band_hz: Option<f64>,
    /// Effects that cannot be, because the part is known to be good: names of [`EFFECTS`].
    #[serde(default)]
    pub known_good: Vec<String>,
    /// Where the signals stand.
    pub columns: Columns,
    /// The control law, where it is known.
    pub controller: Option<Controller>,
    /// How well the nominal parameters are known.
    #[serde(default)]
    pub tolerance: AxisTolerance,
}

/// Names and units of the columns.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Columns {
    /// Time.
    pub time: Source,
    /// Position as measured.
    pub position: Option<Source>,
    /// Rate as measured.
    pub velocity: Option<Source>,
    /// What the loop wants the position to be.
    pub position_reference: Option<Source>,
    /// What the loop wants the rate to be.
    pub velocity_reference: Option<Source>,
    /// Effort.
    pub effort: Source,
    /// Output of the controller, where it is logged beside the effort.
    pub command: Option<Source>,
    /// Channels of which a load, a gain or a switch may hang, by the name that the report shall use.
    #[serde(default)]
    pub auxiliary: BTreeMap<String, Source>,
}

/// One column.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    /// Its name in the header.
    pub name: String,
    /// Its unit; `command` and auxiliary channels need none.
    #[serde(default)]
    pub unit: String,
    /// Factor on its values, for units that have no name.
    #[serde(default = "one")]
    pub scale: f64,
}

/// `output = position_gain * (reference - position) + velocity_gain * (velocity reference - velocity)`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Controller {
    /// What the law gives: `"command"` or `"effort"`.
    pub output: Output,
    /// Output per position [output/position].
    #[serde(default)]
    pub position_gain: f64,
    /// Output per rate [output s/position].
    #[serde(default)]
    pub velocity_gain: f64,
    /// Largest output.
    pub limit: Option<f64>,
    /// Effort per unit of the command.
    #[serde(default = "one")]
    pub effort_per_command: f64,
    /// How well the gains are known, relative.
    #[serde(default = "three_percent")]
    pub tolerance: f64,
}

/// Where the control law ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Output {
    /// In the column `command`.
    Command,
    /// In the column `effort`.
    Effort,
}

/// Relative standard uncertainty of each nominal parameter, and the absolute one of what is nominally zero.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AxisTolerance {
    /// Inertia.
    pub inertia: f64,
    /// Viscous friction.
    pub viscous: f64,
    /// Coulomb friction.
    pub coulomb: f64,
}

impl Default for AxisTolerance {
    fn default() -> Self {
        Self { inertia: 0.03, viscous: 0.03, coulomb: 0.15 }
    }
}

fn one() -> f64 {
    1.0
}

fn three_percent() -> f64 {
    0.03
}
