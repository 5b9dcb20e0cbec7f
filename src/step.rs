//! One period of one axis.
//!
//! ```text
//! row -> admitted row -> unbalance, friction level -> mean over the period -> friction solved -> loop -> INS sums
//! ```

use crate::crossing::Arc;
use crate::faults::Faults;
use crate::free::Heads;
use crate::law::Law;
use crate::number::Number;
use crate::signals::{Input, Output, Stop};
use crate::state::State;
use crate::stop::{self, Side};

/// What acts over a period.
struct Acting<N> {
    /// All disturbance torques but friction.
    other: N,
    friction_level: N,
    /// Vehicle rate at the end of the period.
    vehicle_rate: N,
    /// Apparent drift of the gyro.
    drift: N,
}

/// What the loop has become over a period.
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
        let mut faults = Faults::NONE;
        let row = self.guard.admit(&state.row, &input, &mut faults);
        let unbalance = self.unbalance.at(&[row.accel_x_mps2, row.accel_y_mps2]);
        let other = unbalance + row.torque_nm;
        let level = self.friction_level(state, &row, &mut faults);
        let drift = if self.cross_coupling { self.drift(state, &row) } else { N::ZERO };

        let moved = if state.started {
            let acting = self.acting(state, &row, other, level, drift, &mut faults);
            self.move_axis(state, &acting)
        } else {
            self.stay(state)
        };

        let mut gimbal_angle = N::narrow(moved.gimbal_angle);
        if !gimbal_angle.within(self.small_angle) {
            gimbal_angle = confine_angle::<N>(moved.gimbal_angle, &mut faults);
        }
        let gimbal_rate = moved.sensed_rate - drift;
        let relative_rate = row.vehicle_rate_radps - gimbal_rate.shift_down(self.rate_shift);
        let friction = level.times(self.friction.clamp(relative_rate));
        self.ins.step(&mut state.ins, [row.accel_x_mps2, row.accel_y_mps2], gimbal_angle);

        state.started = true;
        state.row = row;
        state.friction_level = level;
        state.other_torque = other;
        state.gyro_angle = moved.gyro_angle;
        state.gimbal_angle = gimbal_angle;
        state.gimbal_rate = gimbal_rate;
        state.relative_rate = relative_rate;
        state.drift = drift;
        if state.stop != Stop::Free {
            faults |= Faults::GYRO_SATURATED;
        } else if state.offset_left {
            faults |= Faults::OFFSET_LEFT;
        }
        Output {
            gimbal_angle_rad: gimbal_angle,
            gimbal_rate_radps: gimbal_rate,
            gyro_angle_rad: moved.gyro_angle,
            motor_torque_nm: moved.motor_torque,
            friction_torque_nm: friction,
            unbalance_torque_nm: unbalance,
            disturbance_torque_nm: state.torque,
            relative_rate_radps: relative_rate,
            stop: state.stop,
            stop_change_age: moved.stop_change_age,
            faults,
        }
    }

    /// Friction level at the row, for the bearing's rate as it was at the last one.
    #[inline(always)]
    fn friction_level(&self, state: &State<N>, row: &Input<N>, faults: &mut Faults) -> N {
        let rate = row.vehicle_rate_radps - state.gimbal_rate.shift_down(self.rate_shift);
        let accel = [row.accel_x_mps2, row.accel_y_mps2, row.accel_z_mps2];
        let level = self.level.at(&self.tables, accel, rate);
        if level.table_end {
            *faults |= Faults::TABLE_END;
        }
        level.torque
    }

    /// `theta w_x`: what cross coupling makes the gyro sense beside phi'.
    fn drift(&self, state: &State<N>, row: &Input<N>) -> N {
        self.drift_scale.at(&[state.gyro_angle.times(row.spin_rate_radps)])
    }

    #[inline(always)]
    fn acting(
        &self,
        state: &mut State<N>,
        row: &Input<N>,
        other: N,
        level: N,
        drift: N,
        faults: &mut Faults,
    ) -> Acting<N> {
        let mut acting = if self.held_inputs {
            Acting {
                other: state.other_torque,
                friction_level: state.friction_level,
                vehicle_rate: state.row.vehicle_rate_radps,
                drift,
            }
        } else {
            Acting {
                other: state.other_torque.half() + other.half(),
                friction_level: state.friction_level.half() + level.half(),
                vehicle_rate: row.vehicle_rate_radps,
                drift,
            }
        };
        if self.cross_coupling {
            self.couple(state, &mut acting, faults);
        }
        acting
    }

    /// The gyro senses phi' + drift, and the gimbal obeys (1) for phi' alone: for the sensed rate, a change of the drift is
    /// a torque. phi loses the drift's integral.
    #[cold]
    fn couple(&self, state: &mut State<N>, acting: &mut Acting<N>, faults: &mut Faults) {
        let torque = self.drift_torque.at(&[acting.drift - state.drift]);
        let limit = self.largest_drift_torque;
        *faults |= Faults::ARITHMETIC_SATURATED.when(!torque.within(limit));
        acting.other = acting.other + torque.least(limit).most(-limit);
        let lost = self.drift_angle.increment(&[acting.drift]) + self.drift_angle.increment(&[state.drift]);
        state.offset = N::confine(state.offset + lost);
        state.held.gimbal_angle = N::confine(state.held.gimbal_angle + lost);
    }

    #[inline(always)]
    fn move_axis(&self, state: &mut State<N>, acting: &Acting<N>) -> Moved<N> {
        match state.stop {
            Stop::Free => self.move_free(state, acting),
            Stop::Positive => self.move_on_stop(state, acting, Side::Positive),
            Stop::Negative => self.move_on_stop(state, acting, Side::Negative),
        }
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

    #[inline(always)]
    fn move_free(&self, state: &mut State<N>, acting: &Acting<N>) -> Moved<N> {
        let free = &self.free;
        let heads = Heads::of(&state.free);
        let quiet_change = acting.other - state.torque;
        let quiet_rate = free.gimbal_rate(&heads, quiet_change);
        let brake = free.gimbal_rate_gain.at(&[acting.friction_level]);
        let torque = self.torque(state, acting, quiet_rate, brake);
        let change = torque - state.torque;
        let gimbal_angle = state.offset + free.gimbal_angle(&heads, change);
        let sensed_rate = quiet_rate + free.gimbal_rate_gain.at(&[change - quiet_change]);
        let gyro_angle = free.gyro_angle(&heads, change);
        free.advance(&mut state.free, &heads, change);
        state.torque = torque;
        if gyro_angle.within(self.stop.angle) {
            let motor_torque =
                torque.rescale(self.units.torque - self.units.motor_torque) + free.motor_torque(&heads, change);
            Moved { gimbal_angle, sensed_rate, gyro_angle, motor_torque, stop_change_age: N::ZERO }
        } else {
            let start_slope = free.gyro_move.at(heads.modes());
            self.meet_stop(state, gimbal_angle, sensed_rate, gyro_angle, start_slope)
        }
    }

    /// theta ended the period beyond its stop.
    #[cold]
    #[inline(never)]
    fn meet_stop(
        &self,
        state: &mut State<N>,
        gimbal_angle: N::Wide,
        sensed_rate: N,
        gyro_angle: N,
        start_slope: N,
    ) -> Moved<N> {
        let side = if gyro_angle > N::ZERO { Side::Positive } else { Side::Negative };
        let stop = side.mirror(self.stop.angle);
        let heads = Heads::of(&state.free);
        let arc = Arc {
            start: side.mirror(state.gyro_angle - stop),
            end: side.mirror(gyro_angle - stop),
            start_slope: side.mirror(start_slope),
            end_slope: side.mirror(self.free.gyro_move.at(heads.modes())),
        };
        let share = arc.root();
        let [integrator, lags @ ..]: stop::Motor<N> = core::array::from_fn(|i| self.free.motor[i].at(heads.modes()));
        let torque = state.torque.rescale(self.units.torque - self.units.motor_torque);
        state.held = stop::State {
            integrator: (integrator + torque).widen(),
            lags: lags.map(N::widen),
            gimbal_rate: sensed_rate.widen(),
            gimbal_angle,
        };
        self.stop.meet(&mut state.held, &arc, share, side);
        state.stop = match side {
            Side::Positive => Stop::Positive,
            Side::Negative => Stop::Negative,
        };
        self.moved_on_stop(state, stop, N::ONE - share)
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
    fn move_on_stop(&self, state: &mut State<N>, acting: &Acting<N>, side: Side) -> Moved<N> {
        let stop = side.mirror(self.stop.angle);
        let quiet_rate = self.stop.gimbal_rate(&state.held, stop, acting.other);
        let brake = self.stop.gimbal_rate_gain.at(&[acting.friction_level]);
        let torque = self.torque(state, acting, quiet_rate, brake);
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
            let net = state.torque - motor.rescale(self.units.motor_torque - self.units.torque);
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
        let torque = state.torque.rescale(self.units.torque - self.units.motor_torque);
        let [z1, z2, z3, z4, z5] = released.lags;
        let integrator = N::narrow(state.held.integrator) - torque;
        let physical = [integrator, z1, z2, z3, z4, z5, released.gyro_angle, released.gyro_rate, sensed_rate];
        state.free = core::array::from_fn(|i| self.free.entry[i].increment(&physical));
        state.offset = state.held.gimbal_angle - released.gimbal_angle;
        state.stop = Stop::Free;
        state.offset_left = true;
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

    /// The initial state, before any period.
    fn stay(&self, state: &State<N>) -> Moved<N> {
        Moved {
            gimbal_angle: state.offset,
            sensed_rate: N::ZERO,
            gyro_angle: state.gyro_angle,
            motor_torque: state.torque.rescale(self.units.torque - self.units.motor_torque),
            stop_change_age: N::ZERO,
        }
    }
}

/// phi beyond the small angles: flagged, and kept within +-1 rad.
#[cold]
fn confine_angle<N: Number>(wide: N::Wide, faults: &mut Faults) -> N {
    *faults |= Faults::SMALL_ANGLE_EXCEEDED;
    if N::is_full(wide) {
        *faults |= Faults::ARITHMETIC_SATURATED;
    }
    N::narrow(wide).least(N::ONE).most(-N::ONE)
}
