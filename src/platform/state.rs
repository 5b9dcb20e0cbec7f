//! What a platform remembers between two rows.

use super::resolver::Resolver;
use super::turn::Turn;
use crate::estimator::{self, sums};
use crate::faults::Faults;
use crate::number::Number;
use crate::state::State as AxisState;

/// Everything that a step depends on: plain data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<N: Number> {
    /// By axis.
    pub(crate) axes: [AxisState<N>; 3],
    pub(crate) estimators: [estimator::State<N>; 3],
    /// Faults of each axis at the last row.
    pub(crate) faults: [Faults; 3],
    /// Gimbal angles as last admitted.
    pub(crate) angles: [N; 3],
    pub(crate) resolver: Resolver<N>,
    pub(crate) accel: [N; 3],
    pub(crate) modelled: Vector<N>,
    pub(crate) estimated: Vector<N>,
}

/// An attitude error in the stable member's axes, and its sums.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vector<N: Number> {
    /// What the gyros have not seen, and each axis' part of it at the last row.
    pub(crate) unseen: [N::Wide; 3],
    pub(crate) last: [N; 3],
    pub(crate) angle: [N; 3],
    pub(crate) sums: [sums::State<N>; 3],
    /// Rows of the sums' block.
    pub(crate) rows: u32,
}

impl<N: Number> Vector<N> {
    fn new() -> Self {
        Self {
            unseen: [N::HALF_BIT; 3],
            last: [N::ZERO; 3],
            angle: [N::ZERO; 3],
            sums: [sums::State::default(); 3],
            rows: 0,
        }
    }
}

impl<N: Number> State<N> {
    pub(crate) fn new() -> Self {
        Self {
            axes: [AxisState::new(); 3],
            estimators: [estimator::State::new(); 3],
            faults: [Faults::NONE; 3],
            angles: [N::ZERO; 3],
            resolver: Resolver { outer: Turn::NONE, middle: Turn::NONE, inner: Turn::NONE },
            accel: [N::ZERO; 3],
            modelled: Vector::new(),
            estimated: Vector::new(),
        }
    }
}
