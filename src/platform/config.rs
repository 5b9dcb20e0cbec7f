//! Which gimbal turns about which axis, and what each one's axis is like.

use super::law::Law;
use crate::number::Number;
use crate::{BuildError, estimator};

/// An axis of the stable member, with which a gimbal's axis coincides while all gimbal angles are zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// x.
    X,
    /// y.
    Y,
    /// z.
    Z,
}

impl Axis {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// Place in a vector.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// As in the names of a log's columns.
    #[must_use]
    pub const fn letter(self) -> char {
        match self {
            Self::X => 'x',
            Self::Y => 'y',
            Self::Z => 'z',
        }
    }
}

/// One gimbal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gimbal {
    /// Its axis.
    pub axis: Axis,
    /// Its loop: servo, gyro, bearings, unbalance.
    pub servo: crate::Config,
    /// Its estimator.
    pub estimator: estimator::Config,
}

/// A platform of three gimbals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Config {
    /// From the outside in; the last one is the stable member.
    pub gimbals: [Gimbal; 3],
}

impl Config {
    /// Three gimbals alike, with the default parameters and the gyros' cross coupling.
    #[must_use]
    pub fn new(order: [Axis; 3]) -> Self {
        let mut servo = crate::Config::consistent();
        servo.gyro.cross_coupling = true;
        Self::alike(order, servo, estimator::Config::default())
    }

    /// Three gimbals alike, `order` from the outside in.
    #[must_use]
    pub fn alike(order: [Axis; 3], servo: crate::Config, estimator: estimator::Config) -> Self {
        Self { gimbals: order.map(|axis| Gimbal { axis, servo, estimator }) }
    }

    /// Builds the platform's law.
    ///
    /// # Errors
    /// Two gimbals about one axis, periods or ranges that differ, or whatever is wrong with an axis or its estimator.
    pub fn build<N: Number>(&self) -> Result<Law<N>, BuildError> {
        let [outer, middle, inner] = &self.gimbals;
        if outer.axis == middle.axis || middle.axis == inner.axis || inner.axis == outer.axis {
            return Err(BuildError::SameAxis);
        }
        for gimbal in [middle, inner] {
            equal("gimbals.period_s", gimbal.servo.period_s, outer.servo.period_s)?;
            let (range, first) = (&gimbal.servo.range, &outer.servo.range);
            equal("gimbals.range.radial_accel_mps2", range.radial_accel_mps2, first.radial_accel_mps2)?;
            equal("gimbals.range.axial_accel_mps2", range.axial_accel_mps2, first.axial_accel_mps2)?;
            equal("gimbals.range.rate_radps", range.rate_radps, first.rate_radps)?;
        }
        Law::build(self)
    }
}

/// One clock and one set of full scales serve all gimbals.
fn equal(field: &'static str, value: f64, first: f64) -> Result<(), BuildError> {
    crate::config::within(field, value, first, first)
}
