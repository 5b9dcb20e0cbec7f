//! One period off the straight path: on a stop, onto it, off it, and the first row.

use super::{Disturbance, Moved};
use crate::crossing::Arc;
use crate::faults::Faults;
use crate::free::Heads;
use crate::law::Law;
use crate::number::Number;
use crate::signals::Output;
use crate::state::{Regime, State};
use crate::stop::{self, Side};

impl<N: Number> Law<N> {
    /// [`Law::finish`] off the straight path.
    #[inline(never)]
    fn finish_held(&self, state: &mut State<N>, now: &Disturbance<N>, moved: &Moved<N>) -> Output<N> {
        let mut output = self.finish(state, *now, *moved);
        if matches!(state.regime, Regime::Held(_)) {
            output.faults |= Faults::GYRO_SATURATED;
        }
        output
    }

    /// On a stop, or before any period.
    #[inline(never)]
    pub(super) fn step_held(&self, state: &mut State<N>, now: Disturbance<N>) -> Output<N> {
        let moved = match state.regime {
            Regime::Held(side) => self.move_on_stop(state, &now, side),
            Regime::Free | Regime::New => {
                state.regime = Regime::Free;
                Moved {
                    gimbal_angle: state.offset,
                    sensed_rate: now.drift,
                    gyro_angle: state.gyro_angle,
                    motor_torque: self.motor_full_scale(state.torque),
                    stop_change_age: N::ZERO,
                }
            }
        };
        self.finish_held(state, &now, &moved)
    }

    /// theta ended the period beyond its stop.
    #[cold]
    #[inline(never)]
    pub(super) fn meet_stop(
        &self,
        state: &mut State<N>,
        now: Disturbance<N>,
        before: Heads<N>,
        gimbal_angle: N::Wide,
        sensed_rate: N,
        gyro_angle: N,
    ) -> Output<N> {
        let side = if gyro_angle > N::ZERO { Side::Positive } else { Side::Negative };
        let stop = side.mirror(self.stop.angle);
        let heads = Heads::of(&state.free);
        let slope = |heads: &Heads<N>| side.mirror(self.free.gyro_move.at(heads.modes()));
        let arc = Arc {
            start: side.mirror(state.gyro_angle - stop),
            end: side.mirror(gyro_angle - stop),
            start_slope: slope(&before),
            end_slope: slope(&heads),
        };
        let share = arc.root();
        let motor: stop::Motor<N> = core::array::from_fn(|i| self.free.motor[i].at(heads.modes()));
        let [integrator, lags @ ..] = motor;
        state.held = stop::State {
            integrator: (integrator + self.motor_full_scale(state.torque)).widen(),
            lags: lags.map(N::widen),
            gimbal_rate: sensed_rate.widen(),
            gimbal_angle,
        };
        self.stop.contact.correct(&mut state.held, &arc, share, side);
        state.regime = Regime::Held(side);
        let moved = self.moved_on_stop(state, stop, N::ONE - share);
        self.finish_held(state, &now, &moved)
    }

    fn moved_on_stop(&self, state: &State<N>, stop: N, stop_change_age: N) -> Moved<N> {
        Moved {
            gimbal_angle: state.held.gimbal_angle,
            sensed_rate: N::narrow(state.held.gimbal_rate),
            gyro_angle: stop,
            motor_torque: self.stop.motor_torque(&stop::Law::motor(&state.held), stop),
            stop_change_age,
        }
    }

    #[inline(never)]
    fn move_on_stop(&self, state: &mut State<N>, now: &Disturbance<N>, side: Side) -> Moved<N> {
        let acting = self.acting(state, *now);
        let stop = side.mirror(self.stop.angle);
        let quiet_rate = self.stop.gimbal_rate(&state.held, stop, acting.other);
        let brake = self.stop.gimbal_rate_gain.at(&[acting.friction_level]);
        let torque = self.torque(state, &acting, quiet_rate, brake);
        let start = state.held;
        self.stop.advance(&mut state.held, stop, torque);
        state.torque = torque;
        if side.mirror(N::narrow(state.held.gimbal_rate)) >= N::ZERO {
            self.moved_on_stop(state, stop, N::ZERO)
        } else {
            self.leave_stop(state, &start, side, stop)
        }
    }

    /// phi' ended the period pointing away from the stop.
    #[cold]
    #[inline(never)]
    fn leave_stop(&self, state: &mut State<N>, start: &stop::State<N>, side: Side, stop: N) -> Moved<N> {
        let slope = |held: &stop::State<N>| {
            let motor = self.stop.motor_torque(&stop::Law::motor(held), stop);
            let net = state.torque - motor.shift_up(self.motor_shift);
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
        let torque = self.motor_full_scale(state.torque);
        let [z1, z2, z3, z4, z5] = released.lags;
        let integrator = N::narrow(state.held.integrator) - torque;
        let physical = [integrator, z1, z2, z3, z4, z5, gyro_angle, released.gyro_rate, sensed_rate];
        state.free = core::array::from_fn(|i| self.free.entry[i].increment(&physical));
        state.offset = state.held.gimbal_angle - released.gimbal_angle;
        state.regime = Regime::Free;
        state.lasting |= Faults::OFFSET_LEFT;
        Moved {
            gimbal_angle: state.held.gimbal_angle,
            sensed_rate,
            gyro_angle,
            motor_torque: self.stop.motor_torque(&[N::narrow(state.held.integrator), z1, z2, z3, z4, z5], gyro_angle),
            stop_change_age: rest,
        }
    }
}
