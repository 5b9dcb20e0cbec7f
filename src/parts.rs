//! Blocks of the step by themselves, so that what each takes can be counted and compared. Not part of the interface.

use crate::faults::Faults;
use crate::free::{self, Heads};
use crate::law::Law;
use crate::number::Number;
use crate::signals::{Input, Output};
use crate::state::State;

/// The nine modes alone.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Modes<N: Number>(free::State<N>);

#[doc(hidden)]
impl<N: Number> Law<N> {
    /// The linear part: nine modes driven by a change of the torque; theta, phi and `T_m` less the torque.
    pub fn part_linear(&self, modes: &mut Modes<N>, torque_change: N) -> [N; 3] {
        let heads = Heads::of(&modes.0);
        let moved = self.free.advance(&mut modes.0, &heads, torque_change);
        [moved.gyro_angle, N::narrow(moved.gimbal_angle), moved.motor_torque]
    }

    /// The input guard.
    pub fn part_guard(&self, state: &State<N>, row: &mut Input<N>) -> Faults {
        self.guard.admit(&state.row, row)
    }

    /// Friction over the period from `last` to `now`, solved for the rate that it leaves.
    pub fn part_friction(&self, last: &Output<N>, now: &Output<N>, level: N) -> N {
        let brake = self.free.gimbal_rate_gain.at(&[level]).shift_down(self.rate_shift);
        level.times(self.friction.mean(last.relative_rate_radps, now.relative_rate_radps, brake))
    }

    /// The friction level by the step's tables.
    pub fn part_level(&self, row: &Input<N>, rate: N) -> N {
        self.level.at(&self.tables, [row.accel_x_mps2, row.accel_y_mps2, row.accel_z_mps2], rate).torque
    }

    /// The root that the friction level takes of the sum of two squares.
    pub fn part_root(&self, x: N, y: N) -> N {
        x.hypot(y, self.tables.sqrt())
    }
}
