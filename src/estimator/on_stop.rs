//! A row on a stop, and the one that leaves it.

use super::flags::Flags;
use super::health::Admitted;
use super::law::Law;
use super::release::{self, Correction};
use super::signals::Estimate;
use super::state::{Regime, State};
use crate::number::Number;
use crate::state::State as ModelState;
use crate::stop::Side;

impl<N: Number> Law<N> {
    pub(super) fn step_on_stop(
        &self,
        state: &mut State<N>,
        admitted: &Admitted<N>,
        mean: N,
        side: Side,
        axis: &crate::Law<N>,
        model: &ModelState<N>,
    ) -> Estimate<N> {
        // A servo whose torque jumps on the stop is no fault: what was held back has been made up for.
        let jump = Flags::TORQUE_MISSING.when(state.health.torque_waits());
        let faults = admitted.flags.bits() & Flags::SENSORS.bits() & !jump.bits();
        let inputs = Flags::INPUT_WRONG | Flags::INPUT_SPIKE;
        let stuck = state.lasting.contains(Flags::INPUT_STUCK);
        let doubtful = faults & !Flags::INPUT_SPIKE.bits() != 0 || admitted.torque_spiked || stuck;
        state.lasting |= Flags::OFFSET_DOUBTFUL.when(doubtful);
        self.held.advance(&mut state.held, axis, model, mean, !admitted.flags.intersects(inputs));
        if let Some(gyro) = admitted.gyro {
            let fallen = side.mirror(state.held.stop - gyro);
            let back_on_stop = admitted.gyro_back && !gyro.within(self.zone);
            let moved = !fallen.within(self.fallen) && !back_on_stop;
            // A spike looks like a release: it takes a second row.
            let confirmed = moved && state.postponed;
            state.postponed = moved && !confirmed;
            if state.postponed {
                return self.finish_held(state, admitted.flags);
            }
            if confirmed && fallen > N::ZERO {
                return self.leave_stop(state, side, gyro, fallen, admitted.flags);
            }
            let outward = confirmed || admitted.gyro_back;
            // theta that still moves takes H theta' from the balance.
            let follow = if outward { fallen } else { fallen.half().half().half() };
            let follow = side.mirror(follow);
            state.held.stop = state.held.stop - follow;
            state.held.rate = state.held.rate + self.rate.increment(&[N::ZERO, follow]);
        }
        self.finish_held(state, admitted.flags)
    }

    pub(super) fn finish_held(&self, state: &mut State<N>, flags: Flags) -> Estimate<N> {
        let held = &state.held;
        let angle = N::narrow(held.angle + self.delay.increment(&[N::narrow(held.rate)]));
        let bound = self.held.bound(held, &self.root_sum);
        let torque = held.surplus + held.modelled.shift_down(self.held.torque_shift);
        self.report(state, angle, bound, torque, N::ZERO, flags | state.lasting | Flags::SATURATED)
    }

    fn leave_stop(&self, state: &mut State<N>, side: Side, gyro: N, fallen: N, flags: Flags) -> Estimate<N> {
        let held = state.held;
        let fall = self.release.fall(fallen.shift_down(self.shift), &held.rates.map(|rate| side.mirror(rate)));
        let excess = self.held.spanned(&held, side.mirror(fall.excess));
        let reading = self.held.spanned(&held, fall.excess_bound);
        state.postponed = false;
        let Correction { angle, bound } = release::Law::correction(&self.held, &held, &self.root_sum, excess, reading);
        let p = self.release.rate.at(&[N::narrow(held.rate) - side.mirror(fall.excess)]);
        self.place(state, gyro, side.mirror(fall.slope), p);
        let torque = held.surplus + held.modelled.shift_down(self.held.torque_shift);
        state.filter[3] = self.load.increment(&[torque]);
        let [theta, w, p, d] = state.filter.map(N::head);
        let seen = self.seen.increment(&[theta, w, p, d - self.load.times(state.torque)]);
        state.offset = N::confine(held.angle - angle.widen() - seen);
        state.offset_bound = bound;
        state.transient = N::ZERO;
        state.lasting |= Flags::OFFSET_HELD;
        state.regime = Regime::Free;
        state.settling = self.settling_rows;
        self.finish(state, N::ZERO, flags | Flags::SETTLING)
    }
}
