//! What can be wrong with a configuration.

use core::fmt;

/// Why a [`Config`](crate::Config) cannot be turned into a law.
///
/// Only `build` can fail; `step` cannot.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum BuildError {
    /// A field that must be positive and finite is not.
    NotPositive {
        /// Table and field, as in the model file: `servo.gimbal_inertia_kg_m2`.
        field: &'static str,
        /// The value given.
        value: f64,
    },
    /// A field lies outside the values that make sense for it.
    OutOfRange {
        /// Table and field, as in the model file.
        field: &'static str,
        /// The value given.
        value: f64,
        /// Smallest legal value.
        least: f64,
        /// Largest legal value.
        most: f64,
    },
    /// The closed loop has a pole that does not decay.
    UnstablePole {
        /// Real part, 1/s.
        real_radps: f64,
        /// Imaginary part, rad/s.
        imag_radps: f64,
    },
    /// Two complex pairs of poles of the closed loop coincide, so that its modes cannot be told apart.
    RepeatedPole {
        /// Real part, 1/s.
        real_radps: f64,
        /// Imaginary part, rad/s.
        imag_radps: f64,
    },
    /// The poles of the closed loop could not be located.
    PolesNotFound,
    /// Two gimbals of a platform turn about the same axis.
    SameAxis,
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotPositive { field, value } => {
                write!(f, "`{field}` is {value}; it must be positive and finite")
            }
            Self::OutOfRange { field, value, least, most } => {
                write!(f, "`{field}` is {value}; it must lie between {least} and {most}")
            }
            Self::UnstablePole { real_radps, imag_radps } => write!(
                f,
                "the loop is unstable: closed-loop pole at {real_radps:.4} {imag_radps:+.4}j rad/s; \
                 every pole needs a negative real part"
            ),
            Self::RepeatedPole { real_radps, imag_radps } => write!(
                f,
                "two pole pairs of the closed loop coincide at {real_radps:.4} {imag_radps:+.4}j rad/s; \
                 change a time constant by a part in a thousand"
            ),
            Self::SameAxis => write!(f, "two gimbals turn about the same axis; each needs one of x, y, z of its own"),
            Self::PolesNotFound => write!(
                f,
                "the closed loop's poles could not be located; the time constants differ by too many powers of ten"
            ),
        }
    }
}

impl core::error::Error for BuildError {}
