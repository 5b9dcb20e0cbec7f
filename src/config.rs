//! The whole configuration of one gimbal axis, in SI units.

use crate::{BuildError, bearing, gyro, servo, unbalance};

/// One gimbal axis: the four parts of the model file, and how the law is to be built.
///
/// A configuration may be wrong; [`Config::check`] says how. `build` turns it into an immutable law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Config {
    /// Gimbal inertia and servo: `[servo]`.
    pub servo: servo::Config,
    /// Single-axis gyro: `[gyro]`.
    pub gyro: gyro::Config,
    /// Gimbal bearings: `[bearing]`.
    pub bearing: bearing::Config,
    /// Mass unbalance: `[unbalance]`.
    pub unbalance: unbalance::Config,
    /// Input ranges that the law covers: `[range]`.
    #[cfg_attr(feature = "serde", serde(default))]
    pub range: Range,
    /// Time between two calls of `step` [s], 0.25 ms to 4 ms.
    #[cfg_attr(feature = "serde", serde(skip, default = "default_period_s"))]
    pub period_s: f64,
    /// What acts between two rows of input.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub interpolation: Interpolation,
}

/// What the inputs do between row k-1 and row k.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interpolation {
    /// Rows are point samples: their mean acts over the interval.
    #[default]
    Mean,
    /// Row k-1 is held until row k comes.
    Held,
}

/// Largest inputs that the law is sized for; beyond them an input is clamped and a fault bit set.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Range {
    /// Specific force along x and along y [m/s2].
    pub radial_accel_mps2: f64,
    /// Specific force along the gimbal axis z [m/s2].
    pub axial_accel_mps2: f64,
    /// Vehicle rate about the gimbal axis, and rate about the gyro's spin axis [rad/s].
    pub rate_radps: f64,
    /// External disturbance torque [N m].
    pub torque_nm: f64,
}

impl Default for Range {
    /// 50 g radial, 20 g axial, 3,000 deg/s, 0.05 N m (5e5 dyne cm).
    fn default() -> Self {
        Self {
            radial_accel_mps2: 50.0 * crate::paper::STANDARD_GRAVITY_MPS2,
            axial_accel_mps2: 20.0 * crate::paper::STANDARD_GRAVITY_MPS2,
            rate_radps: 3000.0 * crate::paper::DEGREE_RAD,
            torque_nm: 0.05,
        }
    }
}

/// The default period: 1 ms.
pub(crate) const DEFAULT_PERIOD_S: f64 = 1e-3;

#[cfg(feature = "serde")]
fn default_period_s() -> f64 {
    DEFAULT_PERIOD_S
}

impl Config {
    /// Checks every field by itself. Stability is checked by `build`.
    ///
    /// # Errors
    /// The first field that is not finite, not positive or out of range, by its name in the model file.
    pub fn check(&self) -> Result<(), BuildError> {
        self.servo.check()?;
        self.gyro.check()?;
        self.bearing.check()?;
        self.unbalance.check()?;
        positive("range.radial_accel_mps2", self.range.radial_accel_mps2)?;
        positive("range.axial_accel_mps2", self.range.axial_accel_mps2)?;
        positive("range.rate_radps", self.range.rate_radps)?;
        positive("range.torque_nm", self.range.torque_nm)?;
        within("period_s", self.period_s, 0.25e-3, 4e-3)
    }
}

/// `value` must be finite and above zero.
pub(crate) fn positive(field: &'static str, value: f64) -> Result<(), BuildError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(BuildError::NotPositive { field, value }) }
}

/// `value` must be finite and in `least..=most`.
pub(crate) fn within(field: &'static str, value: f64, least: f64, most: f64) -> Result<(), BuildError> {
    // A NaN fails both comparisons.
    if value >= least && value <= most { Ok(()) } else { Err(BuildError::OutOfRange { field, value, least, most }) }
}
