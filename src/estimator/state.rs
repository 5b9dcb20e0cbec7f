//! What the estimator remembers between two rows.

use super::filter::STATES;
use super::flags::Flags;
use super::{health, held, sums};
use crate::number::Number;
use crate::stop::Side;

/// Everything that an estimate depends on: plain data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<N: Number> {
    /// theta, w, p, d.
    pub(crate) filter: [N::Wide; STATES],
    /// Motor torque, theta and inputs as last admitted.
    pub(crate) torque: N,
    /// A motor torque that jumped and waits for the next row to confirm it.
    pub(crate) torque_waiting: N,
    pub(crate) gyro: N,
    pub(crate) inputs: [N; health::INPUTS],
    /// Uncertainty from what the filter has not followed yet.
    pub(crate) transient: N,
    /// theta's innovation at the last correction.
    pub(crate) innovation: N,
    /// What an outage of theta has added to it.
    pub(crate) outage: N,
    /// Rows for which the disturbance is taken to change quickly.
    pub(crate) lively: u32,
    /// d without its noise, for the balance on a stop.
    pub(crate) level: N,
    /// What phi has moved unseen by the gyro, and its uncertainty.
    pub(crate) offset: N::Wide,
    pub(crate) offset_bound: N,
    pub(crate) sums: sums::State<N>,
    /// Rows of the block so far.
    pub(crate) rows: u32,
    /// phi at the last row.
    pub(crate) angle: N,
    /// Inputs at the end of the last block.
    pub(crate) block_inputs: [N; health::INPUTS],
    /// Rows for which each has not changed.
    pub(crate) equal_inputs: [u32; health::INPUTS],
    pub(crate) regime: Regime,
    /// Whether the next row needs a closer look: settling, or a sensor that was not well.
    pub(crate) watched: bool,
    pub(crate) health: health::State,
    /// Rows until the filter's steady gains hold.
    pub(crate) settling: u32,
    /// Rows until a fault of theta or of the motor torque is forgotten.
    pub(crate) trouble: u32,
    /// Whether the last correction was left out because a stop may have held theta back.
    pub(crate) postponed: bool,
    /// Corrections left out in a row.
    pub(crate) waits: u32,
    pub(crate) held: held::State<N>,
    /// The servo as it follows theta, where the motor torque is not measured.
    pub(crate) servo: [N::Wide; 6],
    pub(crate) servo_theta: N,
    /// Bits that stay set, and that of stuck inputs.
    pub(crate) lasting: Flags,
}

/// What the float does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Regime {
    /// No row has come yet.
    New,
    Free,
    Held(Side),
}

impl<N: Number> State<N> {
    pub(crate) fn new() -> Self {
        Self {
            filter: [N::Wide::default(); STATES],
            torque: N::ZERO,
            torque_waiting: N::ZERO,
            gyro: N::ZERO,
            inputs: [N::ZERO; health::INPUTS],
            transient: N::ZERO,
            innovation: N::ZERO,
            outage: N::ZERO,
            lively: 0,
            level: N::ZERO,
            offset: N::Wide::default(),
            offset_bound: N::ZERO,
            sums: sums::State::default(),
            rows: 0,
            angle: N::ZERO,
            block_inputs: [N::ZERO; health::INPUTS],
            equal_inputs: [0; health::INPUTS],
            regime: Regime::New,
            watched: true,
            health: health::State::default(),
            settling: 0,
            trouble: 0,
            postponed: false,
            waits: 0,
            held: held::State::default(),
            servo: [N::Wide::default(); 6],
            servo_theta: N::ZERO,
            lasting: Flags::NONE,
        }
    }
}
