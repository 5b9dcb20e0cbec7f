//! What can be wrong with an effect's values.

use std::fmt;

use gimbal_servo::BuildError;

use super::Bound;

/// Why an effect cannot be added to a plant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum EffectError {
    /// The number of values is not the number of parameters.
    Count {
        /// Name of the effect.
        effect: &'static str,
        /// Number of its parameters.
        expected: usize,
        /// Number of values given.
        given: usize,
    },
    /// A value has no meaning.
    Value {
        /// Name of the effect.
        effect: &'static str,
        /// Name of the parameter.
        parameter: &'static str,
        /// The value given.
        value: f64,
        /// What would be right.
        bound: Bound,
    },
    /// The configuration that results is wrong.
    Config(BuildError),
}

impl fmt::Display for EffectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count { effect, expected, given } => {
                write!(f, "`{effect}` takes {expected} values; {given} are given")
            }
            Self::Value { effect, parameter, value, bound } => {
                let right = match bound {
                    Bound::Any => "finite",
                    Bound::NotNegative => "finite and not negative",
                    Bound::Positive => "finite and positive",
                };
                write!(f, "`{parameter}` of `{effect}` is {value}; it must be {right}")
            }
            Self::Config(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for EffectError {}

impl From<BuildError> for EffectError {
    fn from(error: BuildError) -> Self {
        Self::Config(error)
    }
}
