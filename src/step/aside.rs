//! A period off the straight path: what acts over it, where inputs are held or the gyro's axes are coupled, too, both off
//! by default; and whether it leads back to the straight path.

use super::Acting;
use crate::faults::Faults;
use crate::law::Law;
use crate::number::Number;
use crate::state::{Regime, State};

/// What the straight path is told.
pub(super) struct Aside<N> {
    pub(super) acting: Acting<N>,
    /// Whether the gyro sits on a stop, or there is no period yet.
    pub(super) is_held: bool,
    pub(super) faults: Faults,
}

impl<N: Number> Law<N> {
    /// The regime off the stops.
    pub(crate) fn off_stops(&self) -> Regime {
        if self.unusual { Regime::Unusual } else { Regime::Free }
    }

    /// [`Law::act`] for any law in any regime; a gyro that was released is free from now on.
    #[cold]
    #[inline(never)]
    pub(super) fn act_aside(&self, state: &mut State<N>) -> Aside<N> {
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
        if state.regime == Regime::Released {
            state.regime = self.off_stops();
            state.stop_change_age = N::ZERO;
        }
        Aside { acting, is_held: matches!(state.regime, Regime::Held(_) | Regime::New), faults }
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
