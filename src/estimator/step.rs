//! One row of the estimator.
//!
//! ```text
//! readings -> prediction -> theta's innovation -> correction -> phi, bound -> INS correction
//! ```
//!
//! The straight path is the free gyro with every sensor well; all else branches off it.

use super::filter::STATES;
use super::flags::Flags;
use super::law::Law;
use super::signals::{Estimate, Measured};
use super::state::{Regime, State};
use super::{health, sums};
use crate::faults::Faults;
use crate::number::Number;
use crate::signals::Input;
use crate::state::State as ModelState;

/// Rows from one look at what can wait to the next; [`sums::BLOCK`] is a multiple.
const LOOK: u32 = 8;
/// Sensor faults that leave the filter's disturbance torque in doubt.
const TROUBLE: Flags = Flags::GYRO.union(Flags::TORQUE).union(Flags::INPUT_WRONG);
/// For so many rows.
const TROUBLED_ROWS: u32 = 100;
/// Rows for which the disturbance is taken to change quickly after it has jumped.
pub(super) const LIVELY_ROWS: u32 = 5;

impl<N: Number> Law<N> {
    /// Takes the readings of this instant and gives the estimate at it.
    ///
    /// `axis` and `model` are the axis' law and its state after it has taken the same row, `faults` that step's faults:
    /// the estimator reads the admitted row and, while the gyro sits on a stop, the modelled disturbance.
    pub fn step(
        &self,
        state: &mut State<N>,
        measured: &Measured<N>,
        axis: &crate::Law<N>,
        model: &ModelState<N>,
        faults: Faults,
    ) -> Estimate<N> {
        let (Some(gyro), Some(torque)) = (measured.gyro_angle_rad, measured.motor_torque_nm) else {
            return self.step_closely(state, measured, axis, model, faults);
        };
        let row = &model.row;
        if state.watched || !self.health.ordinary(state, gyro, torque, row, faults) || !gyro.within(self.zone) {
            return self.step_closely(state, measured, axis, model, faults);
        }
        let innovation = self.predict(state, gyro, state.torque.half() + torque.half());
        state.torque = torque;
        state.gyro = gyro;
        state.inputs = inputs_of(row);
        let mut flags = Flags::NONE;
        if innovation.within(self.jump) {
            self.correct(state, &self.gain, innovation);
        } else {
            flags = self.meet_jump(state, innovation);
        }
        self.finish(state, innovation, flags)
    }

    /// Advances the filter; gives theta less its prediction.
    #[inline(always)]
    pub(super) fn predict(&self, state: &mut State<N>, gyro: N, torque: N) -> N {
        let [_, w, p, d] = state.filter.map(N::head);
        let signals = [w, p, d - self.load.times(torque)];
        let [x0, x1, x2, _] = &mut state.filter;
        *x0 = *x0 + self.change[0].increment(&signals);
        *x1 = *x1 + self.change[1].increment(&signals);
        *x2 = *x2 + self.change[2].increment(&signals);
        (gyro.shift_down(self.shift) - N::head(state.filter[0])).shift_up(self.shift)
    }

    #[inline(always)]
    pub(super) fn correct(&self, state: &mut State<N>, gain: &[N::Coef; STATES], innovation: N) {
        for (x, gain) in state.filter.iter_mut().zip(gain) {
            *x = *x + *gain * innovation;
        }
        let excess = innovation.abs() - self.usual;
        let d = N::head(state.filter[3]);
        state.innovation = innovation;
        state.transient = N::head(self.transient_decay * state.transient);
        if excess > N::ZERO {
            state.transient = state.transient.most(N::head(self.transient_gain * excess));
            state.level = d;
        } else {
            state.level = state.level + N::head(self.level_gain * (d - state.level));
        }
    }

    /// phi, its bound and the INS sums, the gyro free.
    #[inline(always)]
    pub(super) fn finish(&self, state: &mut State<N>, innovation: N, flags: Flags) -> Estimate<N> {
        let [theta, w, p, d] = state.filter.map(N::head);
        let signals = [theta, w, p, d - self.load.times(state.torque)];
        let seen = self.seen.increment(&signals);
        let angle = N::narrow(state.offset + seen);
        let mut bound = self.root_sum.of(self.noise + state.transient, N::head(self.ratio_share * N::head(seen).abs()));
        if state.offset_bound != N::ZERO {
            bound = self.root_sum.of(bound, state.offset_bound);
        }
        self.report(state, angle, bound, self.torque.times(d), innovation, flags | state.lasting)
    }

    #[inline(always)]
    pub(super) fn report(
        &self,
        state: &mut State<N>,
        angle: N,
        bound: N,
        torque: N,
        innovation: N,
        flags: Flags,
    ) -> Estimate<N> {
        let [accel_x, accel_y, ..] = state.inputs;
        sums::Law::step(&mut state.sums, [accel_x, accel_y], angle);
        state.angle = angle;
        state.rows += 1;
        if state.rows % LOOK == 0 {
            self.look(state);
        }
        Estimate {
            gimbal_angle_rad: angle,
            bound_rad: bound,
            disturbance_torque_nm: torque,
            innovation_rad: innovation,
            flags: flags | Flags::BOUND_TOO_WIDE.when(bound > self.widest),
        }
    }

    /// What is done once in [`LOOK`] rows: whether theta comes to its stop within the horizon; and the end of a block of sums.
    #[inline(never)]
    fn look(&self, state: &mut State<N>) {
        if state.rows >= sums::BLOCK {
            state.rows = 0;
            self.sums.close(&mut state.sums);
            self.health.watch_inputs(state);
        }
        let [theta, w, p, d] = state.filter.map(N::head);
        let ahead = self.ahead.at(&[theta, w, p, d - self.load.times(state.torque)]);
        let reached = state.regime == Regime::Free && !ahead.within(self.stop);
        state.lasting = state.lasting.without(Flags::SATURATION_AHEAD) | Flags::SATURATION_AHEAD.when(reached);
    }

    /// The filter has been advanced, and theta is not where it should be: the disturbance has jumped, or theta has.
    #[cold]
    #[inline(never)]
    fn meet_jump(&self, state: &mut State<N>, innovation: N) -> Flags {
        state.watched = true;
        if !innovation.within(self.gate) || self.is_sudden(state, innovation) {
            return self.meet_spike(state, innovation);
        }
        state.lively = LIVELY_ROWS;
        self.correct(state, &self.quick_gain, innovation);
        Flags::NONE
    }

    /// Whether an innovation has grown from one row to the next as no torque makes theta move: of a step of `T_d`, theta
    /// shows the cube of the time.
    pub(super) fn is_sudden(&self, state: &State<N>, innovation: N) -> bool {
        let twice = state.innovation.abs() + state.innovation.abs();
        let four = twice + twice;
        innovation.abs() > self.sudden + four + four
    }

    /// A reading of theta that is no reading.
    pub(super) fn meet_spike(&self, state: &mut State<N>, innovation: N) -> Flags {
        health::Law::<N>::miss_gyro(&mut state.health);
        state.innovation = innovation;
        state.transient = state.transient.most(self.outage);
        Flags::GYRO_MISSING
    }

    /// Any row off the straight path.
    #[inline(never)]
    fn step_closely(
        &self,
        state: &mut State<N>,
        measured: &Measured<N>,
        axis: &crate::Law<N>,
        model: &ModelState<N>,
        faults: Faults,
    ) -> Estimate<N> {
        let admitted = self.health.admit(state, measured, &inputs_of(&model.row), faults, self.zone);
        let previous = state.torque;
        let mut mean = previous;
        if let Some(torque) = admitted.torque {
            mean = previous.half() + torque.half() + admitted.catch_up;
            state.torque = torque;
        }
        let troubled = admitted.torque_spiked || (admitted.flags.intersects(TROUBLE) && !state.health.torque_waits());
        state.trouble = if troubled { TROUBLED_ROWS } else { state.trouble.saturating_sub(1) };
        if !self.health.torque_measured() {
            // Half a period on from the last row, along the line through the last two.
            mean = state.torque + (state.torque - state.torque_waiting).half();
        }
        let last_gyro = state.gyro;
        if let Some(gyro) = measured.gyro_angle_rad.filter(|gyro| gyro.is_number()) {
            state.gyro = gyro;
        }
        let estimate = match state.regime {
            Regime::New => self.begin(state, &admitted),
            Regime::Free => self.step_free(state, &admitted, mean, last_gyro, axis, model),
            Regime::Held(side) => self.step_on_stop(state, &admitted, mean, side, axis, model),
        };
        if !self.health.torque_measured() {
            self.follow_servo(state);
        }
        state.watched = state.regime != Regime::Free
            || state.settling > 0
            || state.trouble > 0
            || state.lively > 0
            || self.health.watches(&state.health);
        estimate
    }
}

/// `a_x`, `a_y`, `a_z`, rate.
fn inputs_of<N: Number>(row: &Input<N>) -> [N; health::INPUTS] {
    [row.accel_x_mps2, row.accel_y_mps2, row.accel_z_mps2, row.vehicle_rate_radps]
}
