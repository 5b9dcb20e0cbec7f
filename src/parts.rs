//! Blocks of the step by themselves, so that what each takes can be counted and compared. Not part of the interface.

use crate::faults::Faults;
use crate::free::{self, Heads};
use crate::law::Law;
use crate::number::Number;
use crate::signals::{Input, Output};

/// The nine modes alone.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Modes<N: Number>(free::State<N>);

#[doc(hidden)]
impl<N: Number> Law<N> {
    /// The linear part: nine modes driven by a change of the torque; theta, phi and phi'.
    pub fn part_linear(&self, modes: &mut Modes<N>, torque_change: N) -> [N; 3] {
        let heads = Heads::of(&modes.0);
        let (rate, angle) = self.free.quiet(&heads);
        let gyro_angle = self.free.advance(&mut modes.0, &heads, torque_change);
        let angle = N::narrow(angle + self.free.gimbal_angle_gain * torque_change);
        [gyro_angle, angle, N::head(rate + self.free.gimbal_rate_gain * torque_change)]
    }

    /// The input guard; `row` is the last row, and becomes this one.
    pub fn part_guard(&self, row: &mut Input<N>, input: &Input<N>) -> Faults {
        let mut faults = Faults::NONE;
        self.guard.admit(row, input, &mut faults);
        faults
    }

    /// Friction over the period from `last` to `now`, solved for the rate that it leaves.
    pub fn part_friction(&self, last: &Output<N>, now: &Output<N>, level: N) -> N {
        let brake = N::head(self.free.gimbal_rate_gain * level).shift_down(self.rate_shift);
        level.times(self.friction.mean(last.relative_rate_radps, now.relative_rate_radps, brake))
    }

    /// The friction level by the step's tables.
    pub fn part_level(&self, row: &Input<N>, rate: N) -> N {
        let accel = [row.accel_x_mps2, row.accel_y_mps2, row.accel_z_mps2];
        self.level.at(&self.tables, accel, rate, &mut Faults::default())
    }

    /// The root that the friction level takes of the sum of two squares.
    pub fn part_root(&self, x: N, y: N) -> N {
        x.hypot(y, &self.tables.sqrt)
    }
}
