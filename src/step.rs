//! One period of one axis.
//!
//! ```text
//! row -> admitted row -> unbalance, friction level -> mean over the period -> friction solved -> loop -> INS sums
//! ```
//!
//! The free gyro is the straight path; a stop, the first row and cross coupling are branches off it.

use crate::crossing::Arc;
use crate::faults::Faults;
use crate::free::Heads;
use crate::law::Law;
use crate::number::Number;
use crate::signals::{Input, Output};
use crate::state::{Regime, State};
use crate::stop::{self, Side};

/// The disturbance at one row.
#[derive(Clone, Copy)]
struct Disturbance<N: Number> {
    row: Input<N>,
    unbalance: N,
    /// All disturbance torques but friction.
    other: N,
    friction_level: N,
    /// Apparent drift of the gyro, `theta w_x`.
    drift: N,
    faults: Faults,
}

/// What acts over a period.
struct Acting<N> {
    other: N,
    friction_level: N,
    /// Vehicle rate at the end of the period.
    vehicle_rate: N,
    drift: N,
}

/// The loop at the end of a period.
#[derive(Clone, Copy)]
struct Moved<N: Number> {
    gimbal_angle: N::Wide,
    /// phi' as the gyro senses it: with the drift that cross coupling adds.
    sensed_rate: N,
    gyro_angle: N,
    motor_torque: N,
    stop_change_age: N,
}

impl<N: Number> Law<N> {
    /// Takes the row of this instant and gives the state of the axis at it.
    ///
    /// The first call has no period behind it: it gives the initial state. Every later call advances the axis by one
    /// period over which the mean of the last two rows acts (or the last row, [`crate::Interpolation::Held`]).
    pub fn step(&self, state: &mut State<N>, input: Input<N>) -> Output<N> {
        let now = self.disturbance(state, &input);
        if state.regime != Regime::Free {
            return self.step_held(state, now);
        }
        let acting = self.acting(state, now);
        let heads = Heads::of(&state.free);
        let quiet_change = acting.other - state.torque;
        let quiet_rate = self.free.gimbal_rate(&heads, quiet_change);
        let brake = self.free.gimbal_rate_gain.at(&[acting.friction_level]);
        let torque = self.torque(state, &acting, quiet_rate, brake);
        let change = torque - state.torque;
        let sensed_rate = quiet_rate + self.free.gimbal_rate_gain.at(&[change - quiet_change]);
        let moved = self.free.advance(&mut state.free, &heads, change);
        state.torque = torque;
        let gimbal_angle = state.offset + moved.gimbal_angle;
        if !moved.gyro_angle.within(self.stop.angle) {
            return self.meet_stop(state, now, heads, gimbal_angle, sensed_rate, moved.gyro_angle);
        }
        let motor_torque = self.motor_full_scale(torque) + moved.motor_torque;
        let moved =
            Moved { gimbal_angle, sensed_rate, gyro_angle: moved.gyro_angle, motor_torque, stop_change_age: N::ZERO };
        self.finish(state, now, moved)
    }

    /// The row as admitted, and the disturbance at it.
    #[inline(always)]
    fn disturbance(&self, state: &State<N>, input: &Input<N>) -> Disturbance<N> {
        let (row, faults) = self.guard.admit(&state.row, input);
        let unbalance = self.unbalance.at(&[row.accel_x_mps2, row.accel_y_mps2]);
        // The level's viscous part takes the bearing's rate with phi' as it was at the last row.
        let rate = row.vehicle_rate_radps - state.gimbal_rate.shift_down(self.rate_shift);
        let accel = [row.accel_x_mps2, row.accel_y_mps2, row.accel_z_mps2];
        let level = self.level.at(&self.tables, accel, rate);
        Disturbance {
            row,
            unbalance,
            other: unbalance + row.torque_nm,
            friction_level: level.torque,
            drift: if self.cross_coupling { self.drift(state, &row) } else { N::ZERO },
            faults: if level.table_end { faults | Faults::TABLE_END } else { faults },
        }
    }

    /// `theta w_x`.
    fn drift(&self, state: &State<N>, row: &Input<N>) -> N {
        self.drift_scale.at(&[state.gyro_angle.times(row.spin_rate_radps)])
    }

    #[inline(always)]
    fn acting(&self, state: &mut State<N>, now: Disturbance<N>) -> Acting<N> {
        let mut acting = if self.held_inputs {
            Acting {
                other: state.other_torque,
                friction_level: state.friction_level,
                vehicle_rate: state.row.vehicle_rate_radps,
                drift: now.drift,
            }
        } else {
            Acting {
                other: state.other_torque.half() + now.other.half(),
                friction_level: state.friction_level.half() + now.friction_level.half(),
                vehicle_rate: now.row.vehicle_rate_radps,
                drift: now.drift,
            }
        };
        if self.cross_coupling {
            acting.other = acting.other + self.couple(state, now.drift);
        }
        acting
    }

    /// The gyro senses phi' + drift, and the gimbal obeys (1) for phi' alone: for the sensed rate, a change of the drift is
    /// a torque, which this gives. phi loses the drift's integral.
    fn couple(&self, state: &mut State<N>, drift: N) -> N {
        let lost = self.drift_angle.increment(&[drift]) + self.drift_angle.increment(&[state.drift]);
        state.offset = N::confine(state.offset + lost);
        state.held.gimbal_angle = N::confine(state.held.gimbal_angle + lost);
        let limit = self.largest_drift_torque;
        self.drift_torque.at(&[drift - state.drift]).least(limit).most(-limit)
    }

    /// Torque over the period, friction included, when phi' would become `quiet_rate` without friction and `brake` less
    /// with all of it.
    #[inline(always)]
    fn torque(&self, state: &State<N>, acting: &Acting<N>, quiet_rate: N, brake: N) -> N {
        let free_end = acting.vehicle_rate - (quiet_rate - acting.drift).shift_down(self.rate_shift);
        let brake = brake.shift_down(self.rate_shift);
        let share = self.friction.mean(state.relative_rate, free_end, brake);
        acting.other + acting.friction_level.times(share)
    }

    /// A disturbance torque in the full scale of motor torques.
    #[inline(always)]
    fn motor_full_scale(&self, torque: N) -> N {
        torque.shift_down(self.motor_shift)
    }

    /// Remembers the row, adds up the INS errors, and gives the output.
    #[inline(always)]
    fn finish(&self, state: &mut State<N>, now: Disturbance<N>, moved: Moved<N>) -> Output<N> {
        let row = now.row;
        let mut faults = now.faults | state.lasting;
        let mut gimbal_angle = N::narrow(moved.gimbal_angle);
        if !gimbal_angle.within(self.small_angle) {
            let beyond;
            (gimbal_angle, beyond) = confine_angle(moved.gimbal_angle);
            faults |= beyond;
        }
        let gimbal_rate = moved.sensed_rate - now.drift;
        let relative_rate = row.vehicle_rate_radps - gimbal_rate.shift_down(self.rate_shift);
        let friction = now.friction_level.times(self.friction.clamp(relative_rate));
        self.ins.step(&mut state.ins, [row.accel_x_mps2, row.accel_y_mps2], gimbal_angle);

        state.row = row;
        state.friction_level = now.friction_level;
        state.other_torque = now.other;
        state.gyro_angle = moved.gyro_angle;
        state.gimbal_angle = gimbal_angle;
        state.gimbal_rate = gimbal_rate;
        state.relative_rate = relative_rate;
        state.drift = now.drift;
        Output {
            gimbal_angle_rad: gimbal_angle,
            gimbal_rate_radps: gimbal_rate,
            gyro_angle_rad: moved.gyro_angle,
            motor_torque_nm: moved.motor_torque,
            friction_torque_nm: friction,
            unbalance_torque_nm: now.unbalance,
            disturbance_torque_nm: state.torque,
            relative_rate_radps: relative_rate,
            stop: state.regime.stop(),
            stop_change_age: moved.stop_change_age,
            faults,
        }
    }

    /// [`Law::finish`] off the straight path.
    #[inline(never)]
    fn finish_held(&self, state: &mut State<N>, now: Disturbance<N>, moved: Moved<N>) -> Output<N> {
        let mut output = self.finish(state, now, moved);
        if matches!(state.regime, Regime::Held(_)) {
            output.faults |= Faults::GYRO_SATURATED;
        }
        output
    }

    /// On a stop, or before any period.
    #[inline(never)]
    fn step_held(&self, state: &mut State<N>, now: Disturbance<N>) -> Output<N> {
        let moved = match state.regime {
            Regime::Held(side) => self.move_on_stop(state, now, side),
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
        self.finish_held(state, now, moved)
    }

    /// theta ended the period beyond its stop.
    #[cold]
    #[inline(never)]
    fn meet_stop(
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
        self.stop.meet(&mut state.held, &arc, share, side);
        state.regime = Regime::Held(side);
        let moved = self.moved_on_stop(state, stop, N::ONE - share);
        self.finish_held(state, now, moved)
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
    fn move_on_stop(&self, state: &mut State<N>, now: Disturbance<N>, side: Side) -> Moved<N> {
        let acting = self.acting(state, now);
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
        let released = self.stop.leave(&state.held, stop, sensed_rate, rest);
        let torque = self.motor_full_scale(state.torque);
        let [z1, z2, z3, z4, z5] = released.lags;
        let integrator = N::narrow(state.held.integrator) - torque;
        let physical = [integrator, z1, z2, z3, z4, z5, released.gyro_angle, released.gyro_rate, sensed_rate];
        state.free = core::array::from_fn(|i| self.free.entry[i].increment(&physical));
        state.offset = state.held.gimbal_angle - released.gimbal_angle;
        state.regime = Regime::Free;
        state.lasting |= Faults::OFFSET_LEFT;
        Moved {
            gimbal_angle: state.held.gimbal_angle,
            sensed_rate,
            gyro_angle: released.gyro_angle,
            motor_torque: self
                .stop
                .motor_torque(&[N::narrow(state.held.integrator), z1, z2, z3, z4, z5], released.gyro_angle),
            stop_change_age: rest,
        }
    }
}

/// phi beyond the small angles: flagged, and kept within +-1 rad.
#[cold]
fn confine_angle<N: Number>(wide: N::Wide) -> (N, Faults) {
    let full = Faults::ARITHMETIC_SATURATED.when(N::is_full(wide));
    (N::narrow(wide).least(N::ONE).most(-N::ONE), Faults::SMALL_ANGLE_EXCEEDED | full)
}
