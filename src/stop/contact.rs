//! The float meets its stop within a period.
//!
//! The free law has run on for the rest `h` of the period with an excess `e = theta - stop`. What that excess did is taken
//! out again: of y its integral, of `z_i` its response, of phi' the momentum `H e` and what the motor torque did with the
//! excess, of phi the integral. theta' is taken linear over the rest.

use core::hint::black_box;

use super::curve::{CURVE_SHIFT, Curve};
use super::{Side, State};
use crate::build::plant::{LAGS, Plant};
use crate::crossing::Arc;
use crate::number::Number;
use crate::row::{ScaledRow, keep_rolled};
use crate::stored::stored;
use crate::units::Units;

/// Factors of the contact's correction; `e` angles, `h` and sums over it in periods.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    lags: [LagTail<N>; LAGS],
    /// y for the excess's sum.
    integrator: ScaledRow<N, 1>,
    /// phi' for the excess, the excess's sum, and the changes of `z_i`.
    gimbal_rate: ScaledRow<N, { LAGS + 2 }>,
    /// Of which phi' that the motor torque made.
    motor_share: ScaledRow<N, { LAGS + 2 }>,
    /// 1/6.
    sixth: N,
    /// phi for the excess's sum and for phi' that the motor torque made.
    gimbal_angle: ScaledRow<N, 2>,
}

stored!([N: Number] Law<N> { lags, integrator, gimbal_rate, motor_share, sixth, gimbal_angle });

/// Response of one lag to a rate that changes linearly over the last `h` of a period.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LagTail<N: Number> {
    /// `p T`.
    exponent: ScaledRow<N, 1>,
    curve: Curve<N>,
    gain: ScaledRow<N, 1>,
}

stored!([N: Number] LagTail<N> { exponent, curve, gain });

impl<N: Number> Law<N> {
    pub(super) fn build(plant: &Plant, units: &Units, period: f64) -> Self {
        let jg = plant.gimbal_inertia;
        let [l1, l2, l3, l4, l5] = units.lags;
        let scales = [units.gyro_angle, units.gyro_angle, l1, l2, l3, l4, l5];
        // Integral of the change of T_m over the rest: -D sum T + sum (dz_i + (r_i / p_i) e) / p_i
        let excess: f64 = plant.lag_gains.iter().zip(&plant.lags).map(|(gain, pole)| gain / pole).sum();
        let [p1, p2, p3, p4, p5] = plant.lags.map(|pole| -1.0 / (pole * jg));
        let motor = [-excess / jg, plant.direct_gain() * period / jg, p1, p2, p3, p4, p5];
        let mut rate = motor;
        rate[0] += plant.momentum / jg;
        Self {
            sixth: N::quantise(1.0 / 6.0, 0),
            lags: core::array::from_fn(|i| LagTail {
                exponent: ScaledRow::build([plant.lags[i] * period], [units.gyro_angle], units.gyro_angle),
                curve: Curve::build(plant.lags[i] * period),
                gain: ScaledRow::build([plant.lag_gains[i]], [units.gyro_angle], units.lags[i]),
            }),
            integrator: ScaledRow::build([plant.integrator_gain * period], [units.gyro_angle], units.motor_torque),
            gimbal_rate: ScaledRow::build(rate, scales, units.gimbal_rate),
            motor_share: ScaledRow::build(motor, scales, units.gimbal_rate),
            // A torque that grows with the square of the time adds a quarter of its phi' times the time.
            gimbal_angle: ScaledRow::build(
                [plant.momentum * period / jg, 0.25 * period],
                [units.gyro_angle, units.gimbal_rate],
                units.gimbal_angle,
            ),
        }
    }

    /// Takes out of the end of a period what theta's run beyond its stop has done. `arc` is theta's excess, mirrored
    /// to the positive stop, as `side` mirrors the results back; `share` of the period came before the contact.
    pub(crate) fn correct(&self, state: &mut State<N>, arc: &Arc<N>, share: N, side: Side) {
        let rest = N::ONE - share;
        let first = arc.slope(share);
        let last = arc.end_slope;
        // Sum of the excess over the rest of the period, for a linear slope.
        let sum = ((first + first + last).times(rest).times(rest)).times(self.sixth);
        let mut changes = [N::ZERO; LAGS];
        // One after the other, for the sake of the program's size: a compiler that knew how many there are would unroll them.
        let lags = black_box(state.lags.as_mut_slice()).iter_mut().zip(black_box(changes.as_mut_slice()));
        for ((lag, change), tail) in lags.zip(&self.lags) {
            *change = -tail.response(first, last - first, rest);
            *lag = N::confine(*lag + side.mirror(*change).widen());
            keep_rolled();
        }
        let [a, b, c, d, e] = changes;
        let signals = [arc.end, sum, a, b, c, d, e];
        let motor_share = self.motor_share.at(&signals);
        let apply = |wide: N::Wide, change: N| wide + side.mirror(change).widen();
        state.gimbal_angle =
            state.gimbal_angle + self.gimbal_angle.increment(&[side.mirror(sum), side.mirror(motor_share.times(rest))]);
        state.gimbal_rate = apply(state.gimbal_rate, self.gimbal_rate.at(&signals));
        state.integrator = apply(state.integrator, -self.integrator.at(&[sum]));
    }
}

impl<N: Number> LagTail<N> {
    /// `(r / p)` times the integral of `e^(p (h - t)) e'(t)` over the last `h = rest` of the period, with
    /// `e'(t) = first + bend t / h`.
    // Not inlined, for the sake of the program's size.
    #[inline(never)]
    fn response(&self, first: N, bend: N, rest: N) -> N {
        let curved = self.exponent.at(&[first.times(rest)]) + bend;
        let sum = first + curved.times(self.curve.at(rest)).shift_up(CURVE_SHIFT);
        self.gain.at(&[sum.times(rest)])
    }
}
