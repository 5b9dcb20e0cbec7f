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
//! Contact and release within a period are placed on the cubic through the ends of the period
//! ([`crate::crossing`]); [`contact`] and [`release`] tell what happens for the rest of it.

pub(crate) mod contact;
mod curve;
pub(crate) mod release;

use crate::build::plant::{LAGS, Plant};
use crate::number::Number;
use crate::row::{Row, ScaledRow};
use crate::stored::stored;
use crate::units::Units;

/// What shapes the motor torque on a stop: y, then `z_i`.
pub(crate) type Motor<N> = [N; LAGS + 1];

/// Changes of phi' and of phi over a period, before their shifts, without what the disturbance torque and phi' make.
pub(crate) struct Quiet<N: Number> {
    rate: N::Wide,
    angle: N::Wide,
}

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
    pub(crate) contact: contact::Law<N>,
    pub(crate) release: release::Law<N>,
}

stored!([N: Number] Law<N> {
    angle, integrator_change, lag_decay, gimbal_rate_change, gimbal_angle_change, motor_torque, gimbal_rate_gain,
    contact, release,
});

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
            contact: contact::Law::build(plant, units, period),
            release: release::Law::build(plant, units, period),
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

    /// `T_m` on the stop.
    #[inline(never)]
    pub(crate) fn motor_torque_of(&self, state: &State<N>, stop: N) -> N {
        self.motor_torque(&Self::motor(state), stop)
    }

    /// What a period does, whatever its torque.
    pub(crate) fn quiet(&self, state: &State<N>, stop: N) -> Quiet<N> {
        let [y, a, b, c, d, e] = Self::motor(state);
        let signals = [y, a, b, c, d, e, stop];
        let ([rates @ .., _], [angles @ .., _, _]) = (&self.gimbal_rate_change.coefs, &self.gimbal_angle_change.coefs);
        Quiet { rate: Row { coefs: *rates }.increment(&signals), angle: Row { coefs: *angles }.increment(&signals) }
    }

    /// phi' at the end of the period under the torque `torque`.
    pub(crate) fn gimbal_rate(&self, state: &State<N>, quiet: &Quiet<N>, torque: N) -> N::Wide {
        let [.., coef] = self.gimbal_rate_change.coefs;
        state.gimbal_rate + N::widen_shifted(quiet.rate + coef * torque, self.gimbal_rate_change.shift)
    }

    /// Advances the state by one period under the torque `torque`.
    pub(crate) fn advance(&self, state: &mut State<N>, quiet: &Quiet<N>, stop: N, torque: N) {
        let [.., of_torque, of_rate] = self.gimbal_angle_change.coefs;
        let angle = quiet.angle + of_torque * torque + of_rate * N::narrow(state.gimbal_rate);
        state.gimbal_angle = N::confine(state.gimbal_angle + N::widen_shifted(angle, self.gimbal_angle_change.shift));
        state.gimbal_rate = N::confine(self.gimbal_rate(state, quiet, torque));
        state.integrator = N::confine(state.integrator + self.integrator_change.increment(&[stop]));
        for (lag, decay) in state.lags.iter_mut().zip(&self.lag_decay) {
            let head = N::head(*lag);
            *lag = N::kept(*lag, head) + *decay * head;
        }
    }
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
