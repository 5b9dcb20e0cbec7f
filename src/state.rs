//! The memory of one axis between two steps.

use crate::faults::Faults;
use crate::ins;
use crate::number::Number;
use crate::signals::{Input, Stop};
use crate::stop::Side;
use crate::{free, stop};

/// Everything that a step remembers: plain data, copied freely, saved and restored as bytes.
///
/// In this order in memory: what every step touches comes first, within reach of a short offset.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct State<N: Number> {
    /// The last row as admitted.
    pub(crate) row: Input<N>,
    /// Friction level and other disturbance torques at the last row.
    pub(crate) friction_level: N,
    pub(crate) other_torque: N,
    /// Disturbance torque that acted over the last period, both ends added.
    pub(crate) torque: N,
    /// phi' at the last row as the gyro senses it: with the drift that cross coupling adds.
    pub(crate) sensed_rate: N,
    /// The bearing's rate at the last row.
    pub(crate) relative_rate: N,
    pub(crate) gyro_angle: N,
    pub(crate) gimbal_angle: N,
    /// What phi has moved unseen by the gyro, while the gyro is free.
    pub(crate) offset: N::Wide,
    pub(crate) free: free::State<N>,
    pub(crate) ins: ins::State<N>,
    pub(crate) stop_change_age: N,
    pub(crate) held: stop::State<N>,
    /// theta times the spin-axis rate at the last row, with cross coupling.
    pub(crate) drift: N,
    /// Bits of the last step.
    pub(crate) faults: Faults,
    /// Bits that stay set.
    pub(crate) lasting: Faults,
    pub(crate) regime: Regime,
}

/// Which law moves the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Regime {
    /// The gyro is off its stops.
    Free,
    /// It is, of a law with held inputs or cross coupling: off the straight path.
    Unusual,
    /// It has left a stop within the last period.
    Released,
    /// The gyro sits on this stop.
    Held(Side),
    /// No row has come yet.
    New,
}

impl Regime {
    pub(crate) fn stop(self) -> Stop {
        match self {
            Self::Free | Self::Unusual | Self::Released | Self::New => Stop::Free,
            Self::Held(Side::Positive) => Stop::Positive,
            Self::Held(Side::Negative) => Stop::Negative,
        }
    }
}

impl<N: Number> State<N> {
    /// phi at the last row, the stable member's attitude error [rad].
    #[must_use]
    pub fn gimbal_angle_rad(&self) -> N {
        self.gimbal_angle
    }

    /// theta at the last row, the gyro's output angle [rad].
    #[must_use]
    pub fn gyro_angle_rad(&self) -> N {
        self.gyro_angle
    }

    /// At rest, no row yet.
    pub(crate) fn new() -> Self {
        Self {
            row: Input::default(),
            friction_level: N::ZERO,
            other_torque: N::ZERO,
            torque: N::ZERO,
            sensed_rate: N::ZERO,
            relative_rate: N::ZERO,
            gyro_angle: N::ZERO,
            gimbal_angle: N::ZERO,
            // phi is rounded to the nearest, so that an hour of its sum has no bias.
            offset: N::HALF_BIT,
            free: free::State::<N>::default(),
            ins: ins::State::default(),
            stop_change_age: N::ZERO,
            held: stop::State::default(),
            drift: N::ZERO,
            faults: Faults::NONE,
            lasting: Faults::NONE,
            regime: Regime::New,
        }
    }
}
