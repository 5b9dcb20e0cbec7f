//! What acts over a period where inputs are held or the gyro's axes are coupled: both off by default.

use super::Acting;
use crate::faults::Faults;
use crate::law::Law;
use crate::number::Number;
use crate::state::State;

impl<N: Number> Law<N> {
    /// [`Law::act`] for a law with held inputs or cross coupling.
    #[cold]
    #[inline(never)]
    pub(super) fn act_unusually(&self, state: &mut State<N>) -> (Acting<N>, Faults) {
        let last = Acting {
            other: state.other_torque + state.other_torque,
            friction_level: state.friction_level + state.friction_level,
            end_rate: state.relative_rate + state.sensed_rate.shift_down(self.rate_shift),
            vehicle_rate: N::ZERO,
        };
        // The level's rate is the bearing's own, without the drift.
        state.sensed_rate = state.sensed_rate - state.drift;
        let mut faults = Faults::NONE;
        let mut acting = self.act(state, &mut faults);
        if self.held_inputs {
            acting = Acting { vehicle_rate: acting.vehicle_rate, ..last };
        }
        if self.cross_coupling {
            self.couple(state, &mut acting);
        }
        (acting, faults)
    }

    /// The gyro senses `phi' + theta w_x`, and the gimbal obeys (1) for phi' alone: for the sensed rate, a change of the
    /// drift `theta w_x` is a torque, and the bearing's rate is what it is with the vehicle's rate that much larger. phi
    /// loses the drift's integral.
    fn couple(&self, state: &mut State<N>, acting: &mut Acting<N>) {
        let drift = N::narrow_shifted(state.gyro_angle.product(state.row.spin_rate_radps), self.drift_shift);
        let lost = self.drift_angle.increment(&[drift]) + self.drift_angle.increment(&[state.drift]);
        state.offset = N::confine(state.offset + lost);
        state.held.gimbal_angle = N::confine(state.held.gimbal_angle + lost);
        state.gimbal_angle = N::narrow(state.gimbal_angle.widen() + lost);
        let limit = self.largest_drift_torque;
        let torque = self.drift_torque.at(&[drift - state.drift]).least(limit).most(-limit);
        acting.other = acting.other + torque + torque;
        let seen = drift.shift_down(self.rate_shift);
        acting.end_rate = acting.end_rate + seen;
        acting.vehicle_rate = acting.vehicle_rate + seen;
        state.drift = drift;
    }
}
