//! The loop while the gyro sits on a stop, and the two changes of regime.
//!
//! On the stop `theta = +-stop`, `theta' = 0`: the motor torque runs on by itself and the gimbal integrates.
//!
//! ```text
//! y' = K theta      z_i' = p_i z_i      T_m = y + D theta + sum z_i      Jg phi'' = T_d - T_m
//! ```
//!
//! Exact for a torque held over each period. The float leaves the stop when phi' points away from it.
//!
//! **Contact and release within a period.** Both are placed on the cubic through the ends of the period
//! ([`crate::crossing`]). After a contact the free law has run on for the rest `h` of the period with an excess
//! `e = theta - stop`; what that excess did is taken out of y, `z_i`, phi' and phi, theta' taken linear over the rest. After a
//! release the float has moved for the rest of the period, pulled by a phi' that grows linearly from zero.

use crate::build::plant::{LAGS, Plant};
use crate::crossing::Arc;
use crate::number::Number;
use crate::row::ScaledRow;
use crate::units::Units;

/// What shapes the motor torque on a stop: y, then `z_i`.
pub(crate) type Motor<N> = [N; LAGS + 1];

/// Motor, theta on the stop, and the disturbance torque.
type Signals<N> = [N; LAGS + 3];

/// State on a stop.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct State<N: Number> {
    pub(crate) integrator: N::Wide,
    pub(crate) lags: [N::Wide; LAGS],
    pub(crate) gimbal_rate: N::Wide,
    pub(crate) gimbal_angle: N::Wide,
}

/// The loop on a stop over one period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// The stop angle.
    pub(crate) angle: N,
    integrator_change: ScaledRow<N, 1>,
    lag_decay: [N::Coef; LAGS],
    gimbal_rate_change: ScaledRow<N, { LAGS + 3 }>,
    gimbal_angle_change: ScaledRow<N, { LAGS + 4 }>,
    motor_torque: ScaledRow<N, { LAGS + 2 }>,
    /// Change of phi' over a period for a torque of 1: `T / Jg`.
    pub(crate) gimbal_rate_gain: ScaledRow<N, 1>,
    contact: Contact<N>,
    release: Release<N>,
}

/// Factors of the contact's correction; `e` angles, `h` and sums over it in periods.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Contact<N: Number> {
    lags: [LagTail<N>; LAGS],
    /// y for the excess's sum.
    integrator: ScaledRow<N, 1>,
    /// phi' for the excess, the excess's sum, and the changes of `z_i`.
    gimbal_rate: ScaledRow<N, { LAGS + 2 }>,
    /// Of which phi' that the motor torque made.
    motor_share: ScaledRow<N, { LAGS + 2 }>,
    /// phi for the excess's sum and for phi' that the motor torque made.
    gimbal_angle: ScaledRow<N, 2>,
}

/// Response of one lag to a rate that changes linearly over the last `h` of a period.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LagTail<N: Number> {
    /// `p T`.
    exponent: ScaledRow<N, 1>,
    curve: Curve<N>,
    gain: ScaledRow<N, 1>,
}

/// `(e^(x h) - 1 - x h) / (x h)^2` for `0 <= h <= 1`, a polynomial in h.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Curve<N: Number>([N; CURVE]);

const CURVE: usize = 7;
/// Curves and exponents are held in a full scale of 8.
const CURVE_SCALE: i32 = 3;

/// What the float has done by the end of the period in which it left the stop.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Release<N: Number> {
    curve: Curve<N>,
    /// theta' for phi' at the end, weighted.
    gyro_rate: ScaledRow<N, 1>,
    /// theta for theta', a third of the time.
    gyro_angle: ScaledRow<N, 1>,
    lags: [ScaledRow<N, 1>; LAGS],
    /// phi less the offset, for theta and theta'.
    gimbal_angle: ScaledRow<N, 2>,
}

/// The physical state when the gyro has left its stop.
pub(crate) struct Released<N: Number> {
    pub(crate) gyro_angle: N,
    pub(crate) gyro_rate: N,
    pub(crate) lags: [N; LAGS],
    /// (Jo theta' + Bo theta) / H.
    pub(crate) gimbal_angle: N::Wide,
}

impl<N: Number> Law<N> {
    pub(crate) fn build(plant: &Plant, units: &Units, stop_angle_rad: f64, period: f64) -> Self {
        let jg = plant.gimbal_inertia;
        let (k, d) = (plant.integrator_gain, plant.direct_gain());
        let motor_scale = units.motor_torque;
        let lag = |of: &dyn Fn(f64) -> f64| plant.lags.map(of);
        // Integrals of e^(p t) over one period, once and twice.
        let once = lag(&|p| libm::expm1(p * period) / p);
        let twice = lag(&|p| (libm::expm1(p * period) - p * period) / (p * p));
        let [z1, z2, z3, z4, z5] = once.map(|integral| -integral / jg);
        let half = 0.5 * period * period;
        let theta_rate = -(0.5 * k * period + d) * period / jg;
        let theta_angle = -(k * period / 3.0 + d) * half / jg;
        let [a1, a2, a3, a4, a5] = twice.map(|integral| -integral / jg);
        let [l1, l2, l3, l4, l5] = units.lags;
        let signals = [motor_scale, l1, l2, l3, l4, l5, units.gyro_angle, units.torque];
        let with_rate = [motor_scale, l1, l2, l3, l4, l5, units.gyro_angle, units.torque, units.gimbal_rate];
        let torque_scales = [motor_scale, l1, l2, l3, l4, l5, units.gyro_angle];
        Self {
            angle: N::quantise(stop_angle_rad, units.gyro_angle),
            integrator_change: ScaledRow::build([k * period], [units.gyro_angle], motor_scale),
            lag_decay: plant.lags.map(|p| N::decay_coef(libm::expm1(p * period))),
            gimbal_rate_change: ScaledRow::build(
                [-period / jg, z1, z2, z3, z4, z5, theta_rate, period / jg],
                signals,
                units.gimbal_rate,
            ),
            gimbal_angle_change: ScaledRow::build(
                [-half / jg, a1, a2, a3, a4, a5, theta_angle, half / jg, period],
                with_rate,
                units.gimbal_angle,
            ),
            motor_torque: ScaledRow::build([1.0, 1.0, 1.0, 1.0, 1.0, 1.0, d], torque_scales, motor_scale),
            gimbal_rate_gain: ScaledRow::build([period / jg], [units.torque], units.gimbal_rate),
            contact: Contact::build(plant, units, period),
            release: Release::build(plant, units, period),
        }
    }

    /// y and `z_i` as signals.
    pub(crate) fn motor(state: &State<N>) -> Motor<N> {
        let [a, b, c, d, e] = state.lags.map(N::narrow);
        [N::narrow(state.integrator), a, b, c, d, e]
    }

    /// `T_m` with theta at `stop`, the signed angle of the stop.
    pub(crate) fn motor_torque(&self, motor: &Motor<N>, stop: N) -> N {
        let [y, a, b, c, d, e] = *motor;
        self.motor_torque.at(&[y, a, b, c, d, e, stop])
    }

    /// phi' at the end of the period under the torque `torque`.
    pub(crate) fn gimbal_rate(&self, state: &State<N>, stop: N, torque: N) -> N {
        let [y, a, b, c, d, e] = Self::motor(state);
        N::narrow(state.gimbal_rate + self.gimbal_rate_change.increment(&[y, a, b, c, d, e, stop, torque]))
    }

    /// Advances the state by one period under the torque `torque`.
    pub(crate) fn advance(&self, state: &mut State<N>, stop: N, torque: N) {
        let [y, a, b, c, d, e] = Self::motor(state);
        let signals: Signals<N> = [y, a, b, c, d, e, stop, torque];
        let rate = N::narrow(state.gimbal_rate);
        state.gimbal_angle = N::confine(
            state.gimbal_angle + self.gimbal_angle_change.increment(&[y, a, b, c, d, e, stop, torque, rate]),
        );
        state.gimbal_rate = N::confine(state.gimbal_rate + self.gimbal_rate_change.increment(&signals));
        state.integrator = N::confine(state.integrator + self.integrator_change.increment(&[stop]));
        for (lag, decay) in state.lags.iter_mut().zip(&self.lag_decay) {
            *lag = N::low(*lag) + *decay * N::narrow(*lag);
        }
    }

    /// Takes out of the end of a period what theta's run beyond its stop has done. `arc` is theta's excess, mirrored
    /// to the positive stop, as `side` mirrors the results back; `share` of the period came before the contact.
    pub(crate) fn meet(&self, state: &mut State<N>, arc: &Arc<N>, share: N, side: Side) {
        let contact = &self.contact;
        let rest = N::ONE - share;
        let first = arc.slope(share);
        let last = arc.end_slope;
        // Sum of the excess over the rest of the period, for a linear slope.
        let sum = ((first + first + last).times(rest).times(rest)).times(contact_sixth::<N>());
        let changes: [N; LAGS] = core::array::from_fn(|i| -contact.lags[i].response(first, last - first, rest));
        let [a, b, c, d, e] = changes;
        let signals = [arc.end, sum, a, b, c, d, e];
        let motor_share = contact.motor_share.at(&signals);
        let apply = |wide: N::Wide, change: N| wide + side.mirror(change).widen();
        state.gimbal_angle = state.gimbal_angle
            + contact.gimbal_angle.increment(&[side.mirror(sum), side.mirror(motor_share.times(rest))]);
        state.gimbal_rate = apply(state.gimbal_rate, contact.gimbal_rate.at(&signals));
        state.integrator = apply(state.integrator, -contact.integrator.at(&[sum]));
        for (lag, change) in state.lags.iter_mut().zip(changes) {
            *lag = N::confine(*lag + side.mirror(change).widen());
        }
    }

    /// The float at the end of the period, `rest` of it after the release; `gimbal_rate` is phi' at that end.
    pub(crate) fn leave(&self, state: &State<N>, stop: N, gimbal_rate: N, rest: N) -> Released<N> {
        let release = &self.release;
        let weighted = gimbal_rate.times(rest).times(release.curve.at(rest)).shift_up(CURVE_SCALE_SHIFT);
        let gyro_rate = release.gyro_rate.at(&[weighted]);
        let moved = release.gyro_angle.at(&[gyro_rate.times(rest)]);
        let gyro_angle = stop + moved;
        Released {
            gyro_angle,
            gyro_rate,
            lags: core::array::from_fn(|i| N::narrow(state.lags[i]) + release.lags[i].at(&[moved])),
            gimbal_angle: release.gimbal_angle.increment(&[gyro_angle, gyro_rate]),
        }
    }
}

const CURVE_SCALE_SHIFT: u32 = 3;

fn contact_sixth<N: Number>() -> N {
    N::quantise(1.0 / 6.0, 0)
}

/// Which stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// theta = +stop.
    Positive,
    /// theta = -stop.
    Negative,
}

impl Side {
    /// The value as the positive stop would see it, and back.
    #[inline(always)]
    pub(crate) fn mirror<N: Number>(self, value: N) -> N {
        match self {
            Self::Positive => value,
            Self::Negative => -value,
        }
    }
}

impl<N: Number> Contact<N> {
    fn build(plant: &Plant, units: &Units, period: f64) -> Self {
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
}

impl<N: Number> LagTail<N> {
    /// `(r / p)` times the integral of `e^(p (h - t)) e'(t)` over the last `h = rest` of the period, with
    /// `e'(t) = first + bend t / h`.
    fn response(&self, first: N, bend: N, rest: N) -> N {
        let curved = self.exponent.at(&[first.times(rest)]) + bend;
        let sum = first + curved.times(self.curve.at(rest)).shift_up(CURVE_SCALE_SHIFT);
        self.gain.at(&[sum.times(rest)])
    }
}

impl<N: Number> Release<N> {
    fn build(plant: &Plant, units: &Units, period: f64) -> Self {
        let (jo, bo, h) = (plant.float_inertia, plant.damping, plant.momentum);
        Self {
            curve: Curve::build(-bo / jo * period),
            gyro_rate: ScaledRow::build([h / jo * period], [units.gimbal_rate], units.gyro_rate()),
            gyro_angle: ScaledRow::build([period / 3.0], [units.gyro_rate()], units.gyro_angle),
            lags: core::array::from_fn(|i| ScaledRow::build([plant.lag_gains[i]], [units.gyro_angle], units.lags[i])),
            gimbal_angle: ScaledRow::build([bo / h, jo / h], [units.gyro_angle, units.gyro_rate()], units.gimbal_angle),
        }
    }
}

impl<N: Number> Curve<N> {
    /// Interpolates at Chebyshev's points of 0..1; a lag faster than an eighth of the period counts as one of that.
    fn build(exponent: f64) -> Self {
        let x = exponent.max(-8.0);
        let exact = |h: f64| {
            let y = x * h;
            if y > -1e-3 { 0.5 + y / 6.0 + y * y / 24.0 } else { (libm::expm1(y) - y) / (y * y) }
        };
        let node = |i: usize| 0.5 - 0.5 * libm::cos(core::f64::consts::PI * (i as f64 + 0.5) / CURVE as f64);
        // Newton's divided differences, then the polynomial's own coefficients from the innermost bracket outwards.
        let mut differences: [f64; CURVE] = core::array::from_fn(|i| exact(node(i)));
        for level in 1..CURVE {
            for i in (level..CURVE).rev() {
                differences[i] = (differences[i] - differences[i - 1]) / (node(i) - node(i - level));
            }
        }
        let mut powers = [0.0; CURVE];
        for i in (0..CURVE).rev() {
            for j in (1..CURVE).rev() {
                powers[j] = powers[j - 1] - node(i) * powers[j];
            }
            powers[0] = differences[i] - node(i) * powers[0];
        }
        Self(powers.map(|power| N::quantise(power, CURVE_SCALE)))
    }

    fn at(&self, rest: N) -> N {
        let mut value = N::ZERO;
        for power in self.0.iter().rev() {
            value = value.times(rest) + *power;
        }
        value
    }
}
