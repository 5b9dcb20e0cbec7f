//! One period of one axis.
//!
//! ```text
//! row -> admitted row -> unbalance, friction level -> mean over the period -> friction solved -> loop -> INS sums
//! ```
//!
//! The free gyro is the straight path; a stop, the first row and cross coupling are branches off it.

mod held;

use crate::faults::Faults;
use crate::free::Heads;
use crate::law::Law;
use crate::number::Number;
use crate::signals::{Input, Output};
use crate::state::{Regime, State};

/// The disturbance at one row.
#[derive(Clone, Copy)]
pub(super) struct Disturbance<N: Number> {
    pub(super) row: Input<N>,
    pub(super) unbalance: N,
    /// All disturbance torques but friction.
    pub(super) other: N,
    pub(super) friction_level: N,
    /// Apparent drift of the gyro, `theta w_x`.
    pub(super) drift: N,
    pub(super) faults: Faults,
}

/// What acts over a period.
pub(super) struct Acting<N> {
    pub(super) other: N,
    pub(super) friction_level: N,
    /// Vehicle rate at the end of the period.
    pub(super) vehicle_rate: N,
    pub(super) drift: N,
}

/// The loop at the end of a period.
#[derive(Clone, Copy)]
pub(super) struct Moved<N: Number> {
    pub(super) gimbal_angle: N::Wide,
    /// phi' as the gyro senses it: with the drift that cross coupling adds.
    pub(super) sensed_rate: N,
    pub(super) gyro_angle: N,
    pub(super) motor_torque: N,
    pub(super) stop_change_age: N,
}

impl<N: Number> Law<N> {
    /// Takes the row of this instant and gives the state of the axis at it.
    ///
    /// The first call has no period behind it: it gives the initial state. Every later call advances the axis by one
    /// period over which the mean of the last two rows acts (or the last row, [`crate::Interpolation::Held`]).
    pub fn step(&self, state: &mut State<N>, mut input: Input<N>) -> Output<N> {
        let faults = self.guard.admit(&state.row, &mut input);
        let now = self.disturbance(state, input, faults);
        if state.regime != Regime::Free {
            return self.step_held(state, now);
        }
        let acting = self.acting(state, now);
        let heads = Heads::of(&state.free);
        let quiet_change = acting.other - state.torque;
        let quiet_rate = self.free.gimbal_rate(&heads, quiet_change);
        let brake = self.free.gimbal_rate_gain.at(&[acting.friction_level]);
        let torque = self.torque(state, &acting, quiet_rate, brake);
        let change = torque - state.torque + self.stir;
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

    /// The disturbance at an admitted row.
    #[inline(always)]
    fn disturbance(&self, state: &State<N>, row: Input<N>, faults: Faults) -> Disturbance<N> {
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
        N::narrow_shifted(state.gyro_angle.product(row.spin_rate_radps), self.drift_shift)
    }

    #[inline(always)]
    pub(super) fn acting(&self, state: &mut State<N>, now: Disturbance<N>) -> Acting<N> {
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
    pub(super) fn torque(&self, state: &State<N>, acting: &Acting<N>, quiet_rate: N, brake: N) -> N {
        let free_end = acting.vehicle_rate - (quiet_rate - acting.drift).shift_down(self.rate_shift);
        let brake = brake.shift_down(self.rate_shift);
        let share = self.friction.mean(state.relative_rate, free_end, brake);
        acting.other + acting.friction_level.times(share)
    }

    /// A disturbance torque in the full scale of motor torques.
    #[inline(always)]
    pub(super) fn motor_full_scale(&self, torque: N) -> N {
        torque.shift_down(self.motor_shift)
    }

    /// Remembers the row, adds up the INS errors, and gives the output.
    #[inline(always)]
    pub(super) fn finish(&self, state: &mut State<N>, now: Disturbance<N>, moved: Moved<N>) -> Output<N> {
        let row = now.row;
        let mut faults = now.faults | state.lasting;
        let mut gimbal_angle = N::narrow(moved.gimbal_angle);
        if !gimbal_angle.within(self.small_angle) {
            let beyond;
            (gimbal_angle, beyond) = self.confine_angle(moved.gimbal_angle);
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

    /// phi beyond the small angles: flagged, and kept within +-1 rad.
    #[cold]
    fn confine_angle(&self, wide: N::Wide) -> (N, Faults) {
        let (angle, limit) = (N::narrow(wide), self.largest_angle);
        let full = Faults::ARITHMETIC_SATURATED.when(N::is_full(wide) || !angle.within(limit));
        (angle.least(limit).most(-limit), Faults::SMALL_ANGLE_EXCEEDED | full)
    }
}
