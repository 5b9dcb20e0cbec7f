//! The memory of one axis between two steps.

use crate::faults::Faults;
use crate::ins;
use crate::number::Number;
use crate::signals::{Input, Stop};
use crate::stop::Side;
use crate::{free, stop};

/// Everything that a step remembers: plain data, copied freely, saved and restored as bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<N: Number> {
    /// The last row as admitted.
    pub(crate) row: Input<N>,
    /// Friction level and other disturbance torques at the last row.
    pub(crate) friction_level: N,
    pub(crate) other_torque: N,
    /// Disturbance torque that acted over the last period.
    pub(crate) torque: N,
    pub(crate) gyro_angle: N,
    pub(crate) gimbal_angle: N,
    pub(crate) gimbal_rate: N,
    /// The bearing's rate at the last row.
    pub(crate) relative_rate: N,
    /// theta times the spin-axis rate at the last row, with cross coupling.
    pub(crate) drift: N,
    /// What phi has moved unseen by the gyro, while the gyro is free.
    pub(crate) offset: N::Wide,
    pub(crate) free: free::State<N>,
    pub(crate) held: stop::State<N>,
    pub(crate) ins: ins::State<N>,
    /// Bits that stay set.
    pub(crate) lasting: Faults,
    pub(crate) regime: Regime,
}

/// Which law moves the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Regime {
    /// The gyro is off its stops.
    Free,
    /// The gyro sits on this stop.
    Held(Side),
    /// No row has come yet.
    New,
}

impl Regime {
    pub(crate) fn stop(self) -> Stop {
        match self {
            Self::Free | Self::New => Stop::Free,
            Self::Held(Side::Positive) => Stop::Positive,
            Self::Held(Side::Negative) => Stop::Negative,
        }
    }
}

impl<N: Number> State<N> {
    /// At rest, no row yet.
    pub(crate) fn new() -> Self {
        Self {
            row: Input::default(),
            friction_level: N::ZERO,
            other_torque: N::ZERO,
            torque: N::ZERO,
            gyro_angle: N::ZERO,
            gimbal_angle: N::ZERO,
            gimbal_rate: N::ZERO,
            relative_rate: N::ZERO,
            drift: N::ZERO,
            // phi is rounded to the nearest, so that an hour of its sum has no bias.
            offset: N::HALF_BIT,
            free: free::State::<N>::default(),
            held: stop::State::default(),
            ins: ins::State::default(),
            lasting: Faults::NONE,
            regime: Regime::New,
        }
    }
}
