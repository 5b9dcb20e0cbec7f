//! One period of one axis.
//!
//! ```text
//! row -> admitted row -> unbalance, friction level -> both ends of the period -> friction solved -> loop -> INS sums
//! ```
//!
//! The free gyro is the straight path; a stop, the first row, held inputs and cross coupling are branches off it.
//!
//! Torques over a period are the sums of its two ends, twice their mean; the loop's factors are halves for it.

mod aside;
mod held;
mod output;

use crate::faults::Faults;
use crate::free::Heads;
use crate::law::Law;
use crate::number::Number;
use crate::signals::{Input, Output};
use crate::state::{Regime, State};

/// What acts over a period.
#[derive(Clone, Copy)]
pub(super) struct Acting<N> {
    /// All disturbance torques but friction, both ends added.
    pub(super) other: N,
    /// Both ends added.
    pub(super) friction_level: N,
    /// Vehicle rate at the end of the period, as the gyro senses the stable member's.
    pub(super) end_rate: N,
    /// Vehicle rate at this row, likewise.
    pub(super) vehicle_rate: N,
}

/// The loop at the end of a period.
#[derive(Clone, Copy)]
pub(super) struct Moved<N: Number> {
    pub(super) gimbal_angle: N::Wide,
    /// phi' as the gyro senses it: with the drift that cross coupling adds.
    pub(super) sensed_rate: N,
    pub(super) gyro_angle: N,
    /// Vehicle rate at this row, as the gyro senses the stable member's.
    pub(super) vehicle_rate: N,
}

impl<N: Number> Law<N> {
    /// Takes the row of this instant and gives the state of the axis at it: [`Law::advance`], then [`Law::output`].
    ///
    /// The first call has no period behind it: it gives the initial state. Every later call advances the axis by one
    /// period over which the mean of the last two rows acts (or the last row, [`crate::Interpolation::Held`]).
    pub fn step(&self, state: &mut State<N>, input: Input<N>) -> Output<N> {
        self.advance(state, &input);
        self.output(state)
    }

    /// [`Law::step`] without its output: what has to be done in every period. The attitude error, theta and the fault
    /// bits are in the state ([`State::gimbal_angle_rad`], [`State::gyro_angle_rad`]); the torques are worked out when
    /// [`Law::output`] is called, which changes nothing.
    pub fn advance(&self, state: &mut State<N>, input: &Input<N>) -> Faults {
        let mut faults = state.lasting;
        self.guard.admit(&mut state.row, input, &mut faults);
        // One question for everything rare; what it leads to may lead back.
        let moved = 'moved: {
            let acting = if state.regime == Regime::Free {
                self.act(state, &mut faults)
            } else {
                let aside = self.act_aside(state);
                faults |= aside.faults;
                if aside.is_held {
                    faults |= self.move_held(state, &aside.acting);
                    break 'moved Moved::told(state, aside.acting.vehicle_rate);
                }
                aside.acting.taken_apart()
            };
            self.move_free(state, &acting, &mut faults)
        };

        let mut gimbal_angle = N::head(moved.gimbal_angle);
        if N::exceeds(moved.gimbal_angle, self.small_angle) {
            let beyond;
            (gimbal_angle, beyond) = self.confine_angle(moved.gimbal_angle);
            faults |= beyond;
        }
        self.ins.step(&mut state.ins, [state.row.accel_x_mps2, state.row.accel_y_mps2], gimbal_angle);
        state.gimbal_angle = gimbal_angle;
        state.gyro_angle = moved.gyro_angle;
        state.sensed_rate = moved.sensed_rate;
        state.relative_rate = moved.vehicle_rate - moved.sensed_rate.shift_down(self.rate_shift);
        state.faults = faults;
        faults
    }

    /// The disturbance at the row just admitted, and with the last row's over the period.
    #[inline(always)]
    fn act(&self, state: &mut State<N>, faults: &mut Faults) -> Acting<N> {
        let row = &state.row;
        let vehicle_rate = row.vehicle_rate_radps;
        let other = self.unbalance.above(row.torque_nm.widen(), &[row.accel_x_mps2, row.accel_y_mps2]);
        // The level's viscous part takes the bearing's rate with phi' as it was at the last row.
        let rate = vehicle_rate - state.sensed_rate.shift_down(self.rate_shift);
        let accel = [row.accel_x_mps2, row.accel_y_mps2, row.accel_z_mps2];
        let level = self.level.at(&self.tables, accel, rate, faults);
        let acting = Acting {
            other: state.other_torque + other,
            friction_level: state.friction_level + level,
            end_rate: vehicle_rate,
            vehicle_rate,
        };
        state.other_torque = other;
        state.friction_level = level;
        acting
    }

    /// One period with the gyro off its stops.
    #[inline(always)]
    fn move_free(&self, state: &mut State<N>, acting: &Acting<N>, faults: &mut Faults) -> Moved<N> {
        let heads = Heads::of(&state.free);
        let quiet_change = acting.other - state.torque;
        let (rate, angle) = self.free.quiet(&heads);
        let quiet_rate = N::head(rate + self.free.gimbal_rate_gain * quiet_change);
        let brake = N::head(self.free.gimbal_rate_gain * acting.friction_level);
        let share = self.friction_share(state.relative_rate, acting.end_rate, quiet_rate, brake);
        let friction = acting.friction_level.times(share);
        // From torque to torque, so that the changes add up to the torque to the last bit.
        let torque = acting.other + friction;
        let change = (torque - state.torque).stirred();
        let sensed_rate = quiet_rate + brake.times(share);
        let gyro_angle = self.free.advance(&mut state.free, &heads, change);
        let gimbal_angle = state.offset + (angle + self.free.gimbal_angle_gain * change);
        state.torque = torque;
        if gyro_angle.beyond(self.stop_limit) {
            *faults |= self.meet_stop(state, gimbal_angle, sensed_rate, gyro_angle);
            return Moved::told(state, acting.vehicle_rate);
        }
        Moved { gimbal_angle, sensed_rate, gyro_angle, vehicle_rate: acting.vehicle_rate }
    }

    /// Friction's mean share of its level over the period, when phi' would become `quiet_rate` without friction and
    /// `brake` more with all of it.
    #[inline(always)]
    pub(super) fn friction_share(&self, relative_rate: N, end_rate: N, quiet_rate: N, brake: N) -> N {
        let free_end = end_rate - quiet_rate.shift_down(self.rate_shift);
        self.friction.mean(relative_rate, free_end, brake.shift_down(self.rate_shift))
    }

    /// phi beyond the small angles: flagged, and kept within +-1 rad.
    #[cold]
    #[inline(never)]
    fn confine_angle(&self, wide: N::Wide) -> (N, Faults) {
        let (angle, limit) = (N::narrow(wide), self.largest_angle);
        let full = Faults::ARITHMETIC_SATURATED.when(N::is_full(wide) || !angle.within(limit));
        (angle.least(limit).most(-limit), Faults::SMALL_ANGLE_EXCEEDED | full)
    }
}

// What functions off the straight path give passes through memory. Taken apart, it does so there alone: the straight path
// keeps its own in registers.

impl<N: Number> Acting<N> {
    #[inline(always)]
    fn taken_apart(&self) -> Self {
        let Self { other, friction_level, end_rate, vehicle_rate } = *self;
        Self { other, friction_level, end_rate, vehicle_rate }
    }
}

impl<N: Number> Moved<N> {
    /// What a function off the straight path has written into the state.
    #[inline(always)]
    fn told(state: &State<N>, vehicle_rate: N) -> Self {
        Self {
            gimbal_angle: state.held.gimbal_angle,
            sensed_rate: state.sensed_rate,
            gyro_angle: state.gyro_angle,
            vehicle_rate,
        }
    }
}
