//! A row of the free gyro that needs a closer look: the first one, outages, spikes, a stop that is near.

use super::contact::side_beyond;
use super::flags::Flags;
use super::health::{self, Admitted};
use super::law::Law;
use super::signals::Estimate;
use super::state::{Regime, State};
use super::step::LIVELY_ROWS;
use crate::number::Number;
use crate::state::State as ModelState;

impl<N: Number> Law<N> {
    /// The first row, or the first with theta.
    pub(super) fn begin(&self, state: &mut State<N>, admitted: &Admitted<N>) -> Estimate<N> {
        if let Some(gyro) = admitted.gyro {
            self.place(state, gyro, N::ZERO, N::ZERO);
            // Steady: the motor carries the disturbance.
            state.filter[3] = self.load.increment(&[state.torque]);
            state.regime = Regime::Free;
            state.settling = self.settling_rows;
        } else {
            state.transient = self.widest;
        }
        self.finish(state, N::ZERO, admitted.flags | Flags::SETTLING)
    }

    /// Sets theta, w and p.
    pub(super) fn place(&self, state: &mut State<N>, gyro: N, w: N, p: N) {
        let [x0, x1, x2, _] = &mut state.filter;
        (*x0, *x1, *x2) = (gyro.shift_down(self.shift).widen(), w.widen(), p.widen());
    }

    pub(super) fn step_free(
        &self,
        state: &mut State<N>,
        admitted: &Admitted<N>,
        mean: N,
        last_gyro: N,
        axis: &crate::Law<N>,
        model: &ModelState<N>,
    ) -> Estimate<N> {
        let settling = state.settling > 0;
        state.settling = state.settling.saturating_sub(1);
        let flags = admitted.flags | Flags::SETTLING.when(settling);
        let Some(gyro) = admitted.gyro else {
            self.predict(state, N::ZERO, mean);
            let rows = admitted.gyro_missing;
            // The outage's uncertainty grows with the square of its rows: by the odd numbers.
            // What jumps meanwhile has jumped by more.
            let felt = if state.lively > 0 { rows + 2 } else { rows };
            for _ in 0..(2 * felt.min(64)).saturating_sub(1) {
                state.transient = state.transient + self.outage;
                state.outage = state.outage + self.outage;
            }
            let predicted = N::head(state.filter[0]).shift_up(self.shift);
            return match side_beyond(predicted, self.zone) {
                Some(side) if rows > 1 && !predicted.within(self.rest) => {
                    state.lasting |= Flags::OFFSET_DOUBTFUL;
                    self.meet_stop(state, side, side.mirror(self.rest), axis, model, flags)
                }
                _ => self.finish(state, N::ZERO, flags),
            };
        };
        let innovation = self.predict(state, gyro, mean);
        if let Some(side) = side_beyond(gyro, self.zone) {
            let deficit = -side.mirror(innovation);
            let least = if settling { self.usual + self.usual } else { self.usual };
            let [_, w, ..] = state.filter.map(N::head);
            let moved = side.mirror(gyro - last_gyro).shift_down(self.shift);
            let speed = side.mirror(w);
            let usual = self.usual.shift_down(self.shift);
            let still = moved.within(usual + usual) && moved < usual;
            // An outage may have hidden that it met the stop.
            state.lasting |= Flags::OFFSET_DOUBTFUL.when(state.trouble > 0);
            // Near a turning point theta stands still by itself: it must have been moving.
            if deficit > least && still && speed > usual && moved < speed.half() {
                state.postponed = false;
                return self.meet_stop(state, side, gyro, axis, model, flags);
            }
            // A stop may hold theta back: the filter must not learn from it before that is decided.
            let slowed = moved < speed.half() || still;
            let some = deficit + deficit + deficit > self.usual && slowed && state.waits == 0;
            let short = deficit > least && speed - moved > usual;
            state.postponed = !settling && (some || (short && state.waits < 3));
            state.waits = if state.postponed { state.waits + 1 } else { 0 };
            if state.postponed {
                return self.finish(state, innovation, flags);
            }
        }
        if admitted.gyro_back {
            // Where theta is and how fast it moves is all that is known after an outage.
            let beyond = !innovation.within(self.gate);
            state.lasting |= Flags::OFFSET_DOUBTFUL.when(beyond);
            health::Law::<N>::take_gyro(&mut state.health);
            self.place_anew(state, gyro);
            return self.finish(state, innovation, flags | Flags::SETTLING);
        }
        let gate = if settling { self.gate + self.gate + self.gate + self.gate } else { self.gate };
        if !innovation.within(gate) || (!settling && self.is_sudden(state, innovation)) {
            let spike = self.meet_spike(state, innovation);
            return self.finish(state, innovation, flags | spike);
        }
        health::Law::<N>::take_gyro(&mut state.health);
        if innovation.within(self.usual) {
            // Nothing has happened while theta was missing.
            state.transient = (state.transient - state.outage).most(N::ZERO);
        }
        state.outage = N::ZERO;
        let jumped = !innovation.within(self.jump);
        let lively = gyro.within(self.zone) && (state.lively > 0 || jumped);
        state.lively = if jumped { LIVELY_ROWS } else { state.lively.saturating_sub(1) };
        let gain = if settling || admitted.torque_lost || lively { &self.quick_gain } else { &self.gain };
        self.correct(state, gain, innovation);
        self.finish(state, innovation, flags)
    }

    /// The filter begins anew at theta; p and d go on as predicted.
    fn place_anew(&self, state: &mut State<N>, gyro: N) {
        state.filter[0] = gyro.shift_down(self.shift).widen();
        state.settling = self.settling_rows;
        state.transient = state.transient.least(self.outage);
        for _ in 0..4 {
            state.transient = state.transient + self.outage;
        }
    }
}
