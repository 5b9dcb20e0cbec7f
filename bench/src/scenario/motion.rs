//! What moves the vehicle, and what the platform does.

use serde::Deserialize;

/// What moves the vehicle.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Profile {
    /// 1 g along y.
    Rest,
    /// The paper's 20 g along y for 5 s.
    Unbalance,
    /// The same with a rate of 0.1 rad/s that turns every 2 s.
    Friction,
    /// A swaying vehicle.
    Sway {
        /// Peak of the specific force along y [m/s2].
        accel_mps2: f64,
        /// Peak of the rate [rad/s].
        rate_radps: f64,
        /// Its frequency [Hz].
        frequency_hz: f64,
    },
    /// An external torque.
    Torque {
        /// Its size [N m].
        torque_nm: f64,
        /// Its end [s].
        off_s: f64,
    },
    /// A log; `rocket` is shipped, any other is a file beside the scenario.
    Log {
        /// Which.
        log: String,
    },
}

/// A part that can be taken out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// The bearings' friction.
    Friction,
    /// The mass unbalance.
    Unbalance,
}

/// An effect of the platform.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EffectEntry {
    /// Its name.
    pub name: String,
    /// Values of its parameters; without them, typical ones.
    #[serde(default)]
    pub values: Vec<f64>,
}
