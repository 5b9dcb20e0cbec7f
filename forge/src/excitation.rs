//! What the vehicle does: seven kinds of motion, each drawn anew for every log.

mod flight;
mod lab;
mod rocket;
mod shape;

pub use rocket::Rocket;

use crate::draw::Draw;
use crate::track::{Row, Track};

/// Time between the rows of a track and of a log [s].
pub const PERIOD_S: f64 = 1e-3;

/// Kind of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, PartialOrd, Ord)]
#[serde(rename_all = "snake_case")]
pub enum Excitation {
    /// Square waves and triangles of rate, several tilts, reference to 1 g.
    RateTable,
    /// Thrust with roll reversals and vibration.
    Boost,
    /// Random accelerations and rates.
    Manoeuvre,
    /// Sway under a wing, with vibration.
    CaptiveCarry,
    /// A real sounding rocket's flight.
    Rocket,
    /// Hardly any motion.
    Quiet,
    /// One tone of sway.
    Sway,
}

impl Excitation {
    /// All kinds.
    pub const ALL: [Self; 7] =
        [Self::RateTable, Self::Boost, Self::Manoeuvre, Self::CaptiveCarry, Self::Rocket, Self::Quiet, Self::Sway];

    /// Name in answers and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RateTable => "rate_table",
            Self::Boost => "boost",
            Self::Manoeuvre => "manoeuvre",
            Self::CaptiveCarry => "captive_carry",
            Self::Rocket => "rocket",
            Self::Quiet => "quiet",
            Self::Sway => "sway",
        }
    }

    /// Whether the gates count it; quiet and field-like ones are tabulated alone.
    #[must_use]
    pub fn is_rich(self) -> bool {
        !matches!(self, Self::Quiet | Self::Sway)
    }

    /// Whether it happens in a laboratory, where an outside reference can stand.
    #[must_use]
    pub fn in_laboratory(self) -> bool {
        matches!(self, Self::RateTable | Self::Quiet)
    }

    /// Draws a track. Without the rocket's flight, `Rocket` is a boost.
    #[must_use]
    pub fn track(self, rows: usize, rocket: Option<&Rocket>, draw: &mut Draw) -> Track {
        let mut track = match (self, rocket) {
            (Self::RateTable, _) => lab::rate_table(rows, draw),
            (Self::Boost, _) | (Self::Rocket, None) => flight::boost(rows, draw),
            (Self::Manoeuvre, _) => flight::manoeuvre(rows, draw),
            (Self::CaptiveCarry, _) => flight::captive_carry(rows, draw),
            (Self::Rocket, Some(rocket)) => rocket.track(rows, draw),
            (Self::Quiet, _) => lab::quiet(rows, draw),
            (Self::Sway, _) => flight::sway(rows, draw),
        };
        let (start_c, rise_c, time_s) = (draw.uniform(15.0, 35.0), draw.uniform(0.0, 8.0), draw.uniform(20.0, 200.0));
        for (index, row) in track.rows.iter_mut().enumerate() {
            row.temperature_c = start_c + rise_c * (1.0 - libm::exp(-(index as f64) * PERIOD_S / time_s));
        }
        track
    }
}

fn track_of(rows: usize, row: impl FnMut(usize) -> Row) -> Track {
    Track { period_s: PERIOD_S, rows: (0..rows).map(row).collect() }
}
