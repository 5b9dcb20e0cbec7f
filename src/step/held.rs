//! One period off the straight path: on a stop, onto it, off it, and the first row.

use super::Acting;
use crate::crossing::Arc;
use crate::faults::Faults;
use crate::free::Heads;
use crate::law::Law;
use crate::number::Number;
use crate::state::{Regime, State};
use crate::stop::{self, Side};

impl<N: Number> Law<N> {
    /// On a stop, or before any period. Writes what the straight path works out into the state, phi into `held`.
    #[cold]
    #[inline(never)]
    pub(super) fn move_held(&self, state: &mut State<N>, acting: &Acting<N>) -> Faults {
        if let Regime::Held(side) = state.regime {
            // One after the other and not one in the other: the deepest calls set the stack.
            let start = state.held;
            if self.move_on_stop(state, acting, side) {
                return Faults::GYRO_SATURATED;
            }
            self.leave_stop(state, &start, side);
            return Faults::OFFSET_LEFT;
        }
        state.regime = self.off_stops();
        state.held.gimbal_angle = state.offset;
        state.sensed_rate = state.drift;
        Faults::NONE
    }

    /// theta ended the period beyond its stop.
    #[cold]
    #[inline(never)]
    pub(super) fn meet_stop(
        &self,
        state: &mut State<N>,
        gimbal_angle: N::Wide,
        sensed_rate: N,
        gyro_angle: N,
    ) -> Faults {
        let side = if gyro_angle > N::ZERO { Side::Positive } else { Side::Negative };
        let stop = side.mirror(self.stop.angle);
        let heads = Heads::of(&state.free);
        let slope = |gimbal_angle: N, gyro_angle: N| {
            let seen = gimbal_angle - N::narrow(state.offset);
            side.mirror(self.instant.gyro_move.at(&[seen, gyro_angle]))
        };
        let arc = Arc {
            start: side.mirror(state.gyro_angle - stop),
            end: side.mirror(gyro_angle - stop),
            start_slope: slope(state.gimbal_angle, state.gyro_angle),
            end_slope: slope(N::narrow(gimbal_angle), gyro_angle),
        };
        let share = arc.root();
        let motor: stop::Motor<N> = self.instant.motor(&heads);
        let [integrator, lags @ ..] = motor;
        state.held = stop::State {
            integrator: (integrator + self.motor_full_scale(state.torque)).widen(),
            lags: lags.map(N::widen),
            gimbal_rate: sensed_rate.widen(),
            gimbal_angle,
        };
        self.stop.contact.correct(&mut state.held, &arc, share, side);
        state.regime = Regime::Held(side);
        Self::tell(state, stop, N::ONE - share);
        Faults::GYRO_SATURATED
    }

    fn tell(state: &mut State<N>, gyro_angle: N, stop_change_age: N) {
        state.sensed_rate = N::narrow(state.held.gimbal_rate);
        state.gyro_angle = gyro_angle;
        state.stop_change_age = stop_change_age;
    }

    /// Whether the float is still on its stop at the end of the period.
    #[inline(never)]
    fn move_on_stop(&self, state: &mut State<N>, acting: &Acting<N>, side: Side) -> bool {
        let stop = side.mirror(self.stop.angle);
        let quiet = self.stop.quiet(&state.held, stop);
        let quiet_rate = N::narrow(self.stop.gimbal_rate(&state.held, &quiet, acting.other.half()));
        let brake = self.stop.gimbal_rate_gain.at(&[acting.friction_level.half()]);
        let share = self.friction_share(state.relative_rate, acting.end_rate, quiet_rate, brake);
        state.torque = acting.other + acting.friction_level.times(share);
        self.stop.advance(&mut state.held, &quiet, stop, state.torque.half());
        let stays = side.mirror(N::narrow(state.held.gimbal_rate)) >= N::ZERO;
        if stays {
            Self::tell(state, stop, N::ZERO);
        }
        stays
    }

    /// phi' ended the period pointing away from the stop.
    #[cold]
    #[inline(never)]
    fn leave_stop(&self, state: &mut State<N>, start: &stop::State<N>, side: Side) {
        let stop = side.mirror(self.stop.angle);
        let slope = |held: &stop::State<N>| {
            let motor = self.stop.motor_torque_of(held, stop);
            let net = state.torque.half() - motor.shift_up(self.motor_shift);
            -side.mirror(self.stop.gimbal_rate_gain.at(&[net]))
        };
        let sensed_rate = N::narrow(state.held.gimbal_rate);
        let arc = Arc {
            start: -side.mirror(N::narrow(start.gimbal_rate)),
            end: -side.mirror(sensed_rate),
            start_slope: slope(start),
            end_slope: slope(&state.held),
        };
        let rest = N::ONE - arc.root();
        let released = self.stop.release.released(&state.held, stop, sensed_rate, rest);
        // Nothing a platform can do carries the float across within a period; absurd parameters can.
        let gyro_angle = released.gyro_angle.least(self.stop.angle).most(-self.stop.angle);
        let [z1, z2, z3, z4, z5] = released.lags;
        let integrator = N::narrow(state.held.integrator) - self.motor_full_scale(state.torque);
        let physical = [integrator, z1, z2, z3, z4, z5, gyro_angle, released.gyro_rate, sensed_rate];
        self.instant.enter(&mut state.free, &physical);
        state.offset = state.held.gimbal_angle - released.gimbal_angle;
        state.regime = Regime::Released;
        state.lasting |= Faults::OFFSET_LEFT;
        Self::tell(state, gyro_angle, rest);
    }
}
