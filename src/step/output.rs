//! What the state of the axis says, worked out when asked for.

use crate::free::Heads;
use crate::law::Law;
use crate::number::Number;
use crate::signals::Output;
use crate::state::{Regime, State};

impl<N: Number> Law<N> {
    /// The axis at the last row.
    #[must_use]
    #[inline(never)]
    pub fn output(&self, state: &State<N>) -> Output<N> {
        let row = &state.row;
        Output {
            gimbal_angle_rad: state.gimbal_angle,
            gimbal_rate_radps: state.sensed_rate - state.drift,
            gyro_angle_rad: state.gyro_angle,
            motor_torque_nm: match state.regime {
                Regime::Free | Regime::Unusual | Regime::Released | Regime::New => {
                    self.motor_full_scale(state.torque) + self.instant.motor_torque.at(Heads::of(&state.free).modes())
                }
                Regime::Held(_) => self.stop.motor_torque_of(&state.held, state.gyro_angle),
            },
            friction_torque_nm: state.friction_level.times(self.friction.clamp(state.relative_rate)),
            unbalance_torque_nm: self.unbalance.at(&[row.accel_x_mps2, row.accel_y_mps2]),
            disturbance_torque_nm: state.torque.half(),
            relative_rate_radps: state.relative_rate,
            stop: state.regime.stop(),
            stop_change_age: state.stop_change_age,
            faults: state.faults,
        }
    }

    /// A torque over a period, both ends added, as its mean in the full scale of motor torques.
    pub(super) fn motor_full_scale(&self, torque: N) -> N {
        torque.half().shift_down(self.motor_shift)
    }
}
