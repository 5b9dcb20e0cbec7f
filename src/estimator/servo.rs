//! (3) as it follows theta, where the motor torque is not measured.

use super::law::Law;
use super::state::{Regime, State};
use crate::build::plant::Plant;
use crate::number::Number;
use crate::row::ScaledRow;
use crate::stored::stored;
use crate::units::Units;

/// (3) as it follows theta: y, then `z_i`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Servo<N: Number> {
    integrator: ScaledRow<N, 2>,
    decay: [N::Coef; 5],
    lags: [ScaledRow<N, 1>; 5],
    torque: ScaledRow<N, 7>,
}

stored!([N: Number] Servo<N> { integrator, decay, lags, torque });

impl<N: Number> Servo<N> {
    pub(crate) fn build(plant: &Plant, units: &Units, scale: i32, period: f64) -> Self {
        let [a, b, c, d, e] = units.lags;
        let torque = units.motor_torque;
        let half = 0.5 * plant.integrator_gain * period;
        Self {
            integrator: ScaledRow::build([half, half], [scale; 2], torque),
            decay: plant.lags.map(|pole| N::decay_coef(libm::expm1(pole * period))),
            // theta along a line over the period
            lags: core::array::from_fn(|i| {
                let x = plant.lags[i] * period;
                ScaledRow::build([plant.lag_gains[i] * libm::expm1(x) / x], [scale], units.lags[i])
            }),
            torque: ScaledRow::build(
                [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, plant.direct_gain()],
                [torque, a, b, c, d, e, scale],
                torque,
            ),
        }
    }
}

impl<N: Number> Law<N> {
    /// (3) over the period just past, theta along a line.
    pub(super) fn follow_servo(&self, state: &mut State<N>) {
        let theta = match state.regime {
            Regime::Held(_) => state.held.stop.shift_down(self.shift),
            Regime::New | Regime::Free => N::head(state.filter[0]),
        };
        let servo = &self.servo;
        let change = theta - state.servo_theta;
        let [integrator, lags @ ..] = &mut state.servo;
        *integrator = N::confine(*integrator + servo.integrator.increment(&[state.servo_theta, theta]));
        for (lag, (decay, gain)) in lags.iter_mut().zip(servo.decay.iter().zip(&servo.lags)) {
            let head = N::narrow(*lag);
            *lag = N::confine(N::kept(*lag, head) + *decay * head + gain.increment(&[change]));
        }
        state.servo_theta = theta;
        state.torque_waiting = state.torque;
        let [y, a, b, c, d, e] = state.servo.map(N::narrow);
        state.torque = servo.torque.at(&[y, a, b, c, d, e, theta]);
    }
}
