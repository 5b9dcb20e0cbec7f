//! Effects: what a real platform does and the nominal model leaves out.
//!
//! An effect has a name, a block, parameters and logged columns that it changes; all of them stand in one table.
//! Each acts as its equation says, added to the nominal plant; with its size zero the plant is the nominal one.
//!
//! ```
//! use gimbal_plant::{Effect, Plant};
//! use gimbal_servo::Config;
//!
//! let ripple = Effect::from_name("torque_ripple").unwrap();
//! let plant = Plant::new(&Config::consistent())?.with_effect(ripple, &[2e-4, 12.0, 0.0])?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod altered;
pub(crate) mod cable;
mod error;
mod fixed_torque;
pub(crate) mod flexible_mode;
pub(crate) mod float_torque;
pub(crate) mod loop_delay;
pub(crate) mod measurement;
pub(crate) mod motor;
mod parameters;
pub(crate) mod pickoff_quantisation;
pub(crate) mod presliding;
pub(crate) mod scaled_friction;
pub(crate) mod stribeck;
mod table;
pub(crate) mod torque_ripple;
pub(crate) mod viscous;

pub(crate) use altered::{Altered, Laws};
pub use error::EffectError;
use table::{Entry, TABLE};

/// An effect, by its name.
#[derive(Clone, Copy)]
pub struct Effect(&'static Entry);

/// The part of the platform in which an effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Block {
    /// Gimbal bearings.
    Friction,
    /// Other torques on the gimbal.
    Disturbance,
    /// From the pick-off to the motor.
    Servo,
    /// Gyro.
    Gyro,
    /// Stable member.
    Structure,
    /// Sensors that only write the log.
    Measurement,
}

/// One parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name, which ends in the unit when it has one.
    pub name: &'static str,
    /// Unit; `1` for a ratio.
    pub unit: &'static str,
    /// Low end of the realistic range.
    pub low: f64,
    /// A typical value.
    pub typical: f64,
    /// High end of the realistic range.
    pub high: f64,
    /// Which values have a meaning.
    pub bound: Bound,
}

/// Values of a parameter that have a meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bound {
    /// Every finite value.
    Any,
    /// Zero and above.
    NotNegative,
    /// Above zero.
    Positive,
}

impl Effect {
    /// Every effect, block by block.
    pub fn all() -> impl ExactSizeIterator<Item = Self> {
        TABLE.iter().map(Self)
    }

    /// The effect of a name, spelt exactly.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        TABLE.iter().find(|entry| entry.name == name).map(Self)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Where it acts.
    #[must_use]
    pub fn block(self) -> Block {
        self.0.block
    }

    /// Its parameters, in the order in which values are given; the sizes come first.
    #[must_use]
    pub fn parameters(self) -> &'static [Parameter] {
        self.0.parameters
    }

    /// How many of its parameters are sizes: with all of them zero the plant is the nominal one.
    #[must_use]
    pub fn sizes(self) -> usize {
        self.0.sizes
    }

    /// Logged columns that it changes.
    #[must_use]
    pub fn columns(self) -> &'static [&'static str] {
        self.0.columns
    }

    /// Typical values of its parameters.
    #[must_use]
    pub fn typical(self) -> Vec<f64> {
        self.0.parameters.iter().map(|parameter| parameter.typical).collect()
    }

    pub(crate) fn apply(self, values: &[f64], altered: &mut Altered) -> Result<(), EffectError> {
        let name = self.name();
        if values.len() != self.0.parameters.len() {
            let (expected, given) = (self.0.parameters.len(), values.len());
            return Err(EffectError::Count { effect: name, expected, given });
        }
        for (parameter, &value) in self.0.parameters.iter().zip(values) {
            let legal = match parameter.bound {
                Bound::Any => value.is_finite(),
                Bound::NotNegative => value.is_finite() && value >= 0.0,
                Bound::Positive => value.is_finite() && value > 0.0,
            };
            if !legal {
                let bound = parameter.bound;
                return Err(EffectError::Value { effect: name, parameter: parameter.name, value, bound });
            }
        }
        if values[..self.0.sizes].iter().any(|&size| size != 0.0) {
            (self.0.apply)(values, altered);
        }
        Ok(())
    }
}

impl std::fmt::Debug for Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Effect").field(&self.name()).finish()
    }
}

impl PartialEq for Effect {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Effect {}

impl std::fmt::Display for Block {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Friction => "friction",
            Self::Disturbance => "disturbance",
            Self::Servo => "servo",
            Self::Gyro => "gyro",
            Self::Structure => "structure",
            Self::Measurement => "measurement",
        })
    }
}
