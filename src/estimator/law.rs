//! The estimator of one axis, built once: every factor that a row needs.

use super::bound::RootSum;
use super::config::Config;
use super::contact::Contact;
use super::filter::{Filter, STATES};
use super::servo::Servo;
use super::signals::{Estimate, Measured};
use super::state::State;
use super::{health, held, release, sums};
use crate::build::plant::Plant;
use crate::number::Number;
use crate::row::{Row, ScaledRow};
use crate::stored::stored;
use crate::units::Units;

/// The estimator of one axis, ready to step: built once from a [`Config`], never changed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Law<N: Number> {
    pub(super) health: health::Law<N>,
    /// Change of theta, w, p for w, p, `d - u`.
    pub(super) change: [Row<N, 3>; 3],
    pub(super) gain: [N::Coef; STATES],
    /// Full scale of the filter to that of theta.
    pub(super) shift: u32,
    /// Largest innovation that is no spike, and half of it.
    pub(super) gate: N,
    /// |theta| from which on a stop may be near.
    pub(super) zone: N,
    /// The nominal stop.
    pub(super) rest: N,
    /// phi for theta, w, p, `d - u`.
    pub(super) seen: Row<N, 4>,
    /// theta at the horizon, likewise.
    pub(super) ahead: Row<N, 4>,
    pub(super) stop: N,
    pub(super) ratio_share: N::Coef,
    pub(super) noise: N,
    pub(super) transient_decay: N::Coef,
    pub(super) transient_gain: N::Coef,
    pub(super) level_gain: N::Coef,
    /// Innovations beyond which the disturbance has jumped.
    pub(super) jump: N,
    /// Innovation that no torque makes from one row to the next.
    pub(super) sudden: N,
    /// Innovations that are plain noise.
    pub(super) usual: N,
    pub(super) widest: N,
    pub(crate) root_sum: RootSum<N>,
    pub(super) torque: ScaledRow<N, 1>,
    pub(super) sums: sums::Law<N>,
    pub(super) quick_gain: [N::Coef; STATES],
    pub(super) settling_rows: u32,
    pub(super) held: held::Law<N>,
    pub(super) release: release::Law<N>,
    pub(super) contact: Contact<N>,
    /// phi' for p, and for theta's excess at contact.
    pub(super) rate: ScaledRow<N, 2>,
    /// `H theta'` for w.
    pub(super) coupling: ScaledRow<N, 1>,
    /// u's inverse: d for a torque.
    pub(super) load: ScaledRow<N, 1>,
    /// Least fall of theta that is a release.
    pub(super) fallen: N,
    /// Uncertainty of phi after one row without theta; it grows with the square of the rows.
    pub(super) outage: N,
    /// phi that one period of delay adds, for phi'.
    pub(super) delay: ScaledRow<N, 1>,
    pub(super) servo: Servo<N>,
    pub(super) units: Units,
    /// Full scale of theta.
    pub(super) gyro: i32,
}

stored!([N: Number] Law<N> {
    health, change, gain, shift, gate, zone, rest, seen, ahead, stop, ratio_share, noise, transient_decay,
    transient_gain, level_gain, jump, sudden, usual, widest, root_sum, torque, sums, quick_gain, settling_rows, held,
    release, contact, rate, coupling, load, fallen, outage, delay, servo, units, gyro,
});

/// A share of something, as a factor.
pub(crate) fn share<N: Number>(value: f64) -> N::Coef {
    N::coef(value)
}

impl<N: Number> Law<N> {
    pub(crate) fn build(config: &Config, axis: &crate::Config, units: &Units, filter: &Filter, quick: &Filter) -> Self {
        let period = axis.period_s;
        let h = axis.gyro.angular_momentum_nm_s;
        let jg = axis.servo.gimbal_inertia_kg_m2;
        let tolerance = &config.tolerance;
        let stop = axis.gyro.stop_angle_rad;
        let largest_gain = filter.gain.iter().chain(&quick.gain).fold(0.0_f64, |most, gain| most.max(gain.abs()));
        // The gains are fractions between theta's full scale and the filter's.
        let shift = N::exponent(largest_gain).max(0);
        // The axis' own full scale of theta holds its modes, which are larger.
        let gyro = units.gyro_angle.min(N::exponent(8.0 * stop));
        let scale = gyro + shift;
        let torque = units.motor_torque;
        let signals = [scale; 4];
        let gains = |filter: &Filter| filter.gain.map(|gain| N::coef(N::rescaled(gain, -shift)));
        let delay = config.sensors.delay_s / period;
        let seen = filter.seen_row(delay);
        let ahead = filter.ahead(delay + config.horizon_s / period)[0];
        let ahead_scale = Row::<N, 4>::exponent(ahead, signals).max(scale);
        let now = filter.seen_row(0.0);
        let seen_gain: f64 = now.iter().zip(&quick.gain).map(|(row, gain)| row * gain).sum();
        let read = libm::hypot(config.sensors.gyro_noise_rad, config.sensors.gyro_step_rad / libm::sqrt(12.0));
        let angle = |value: f64| N::quantise(value, gyro);
        let zone = stop * (1.0 - 4.0 * tolerance.stop_angle) - 6.0 * filter.innovation_rad;
        let seen_noise = filter.deviation(&[now[0], now[1], now[2], now[3]]);
        let rate_noise = filter.ratio / period * filter.deviation(&[0.0, 0.0, 1.0, 0.0]);
        // phi from a rate that is uncertain, and from a torque that may have come.
        let outage = rate_noise * period + 0.75 * period * period * 0.3 * axis.range.torque_nm / jg;
        Self {
            health: health::Law::build(config, axis, units, gyro),
            change: core::array::from_fn(|i| {
                let [_, w, p, d] = filter.change[i];
                Row::build([w, p, d], [scale; 3], scale)
            }),
            gain: gains(filter),
            shift: shift.unsigned_abs(),
            gate: angle(40.0 * filter.innovation_rad),
            zone: angle(zone),
            rest: angle(stop),
            seen: Row::build(seen, signals, units.gimbal_angle),
            ahead: Row::build(ahead, signals, ahead_scale),
            stop: N::quantise(stop, ahead_scale),
            ratio_share: share::<N>(libm::hypot(tolerance.damping, tolerance.angular_momentum)),
            noise: N::quantise(seen_noise, units.gimbal_angle),
            level_gain: N::coef(1.0 / 16.0),
            // The filter forgets an innovation at about the pace at which it takes d in.
            transient_decay: N::coef(0.92),
            transient_gain: N::coef(N::rescaled(1.6 * seen_gain, gyro - units.gimbal_angle)),
            jump: angle(3.5 * filter.innovation_rad),
            sudden: angle(10.0 * filter.innovation_rad),
            usual: angle(2.5 * filter.innovation_rad),
            widest: N::quantise(config.widest_bound_rad, units.gimbal_angle),
            root_sum: RootSum::build(),
            torque: ScaledRow::build([1.0 / filter.torque_scale], [scale], torque),
            sums: sums::Law::build(units, axis.range.radial_accel_mps2.max(axis.range.axial_accel_mps2), period),
            quick_gain: gains(quick),
            settling_rows: 40,
            held: held::Law::build(config, axis, units, filter),
            release: release::Law::build(axis, units, scale),
            contact: Contact::build(&Plant::new(axis), units, scale, gyro, period),
            rate: ScaledRow::build([filter.ratio / period, h / jg], [scale, gyro], units.gimbal_rate),
            coupling: ScaledRow::build([h / period], [scale], torque),
            load: ScaledRow::build([filter.torque_scale], [torque], scale),
            fallen: angle(5.5 * read),
            outage: N::quantise(outage, units.gimbal_angle),
            delay: ScaledRow::build([config.sensors.delay_s], [units.gimbal_rate], units.gimbal_angle),
            servo: Servo::build(&Plant::new(axis), units, scale, period),
            units: *units,
            gyro,
        }
    }

    /// The state before the first row: nothing known.
    #[must_use]
    pub fn start(&self) -> State<N> {
        State::new()
    }

    /// Exponent of the full scale of theta as measured.
    #[must_use]
    pub fn gyro_exponent(&self) -> i32 {
        self.gyro
    }

    /// Readings in SI as the law takes them; `None` or not finite: no reading.
    #[must_use]
    pub fn measured(&self, gyro_angle_rad: Option<f64>, motor_torque_nm: Option<f64>) -> Measured<N> {
        let quantise = |value: Option<f64>, exponent| {
            value.filter(|value| value.is_finite()).map(|value| N::quantise(value, exponent))
        };
        Measured {
            gyro_angle_rad: quantise(gyro_angle_rad, self.gyro),
            motor_torque_nm: quantise(motor_torque_nm, self.units.motor_torque),
        }
    }

    /// The estimate in SI.
    #[must_use]
    pub fn si(&self, estimate: &Estimate<N>) -> Estimate<f64> {
        Estimate {
            gimbal_angle_rad: estimate.gimbal_angle_rad.to_f64(self.units.gimbal_angle),
            bound_rad: estimate.bound_rad.to_f64(self.units.gimbal_angle),
            disturbance_torque_nm: estimate.disturbance_torque_nm.to_f64(self.units.motor_torque),
            innovation_rad: estimate.innovation_rad.to_f64(self.gyro),
            flags: estimate.flags,
        }
    }

    /// What the navigation adds to its velocity along x and y [m/s].
    #[must_use]
    pub fn velocity_correction_mps(&self, state: &State<N>) -> [f64; 2] {
        self.sums.velocity_mps(&state.sums, self.products(state)).map(|error| -error)
    }

    /// What the navigation adds to its position along x and y [m].
    #[must_use]
    pub fn position_correction_m(&self, state: &State<N>) -> [f64; 2] {
        self.sums.position_m(&state.sums, state.rows, self.products(state)).map(|error| -error)
    }

    /// `(a_y phi, -a_x phi)` at the last row.
    fn products(&self, state: &State<N>) -> [f64; 2] {
        let angle = state.angle.to_f64(self.units.gimbal_angle);
        let [x, y, ..] = state.inputs.map(|accel| accel.to_f64(self.units.accel));
        [y * angle, -x * angle]
    }

    /// What phi has moved unseen by the gyro up to its last release [rad].
    #[must_use]
    pub fn offset_rad(&self, state: &State<N>) -> f64 {
        N::narrow(state.offset).to_f64(self.units.gimbal_angle)
    }

    /// Its uncertainty, 1 sigma [rad].
    #[must_use]
    pub fn offset_bound_rad(&self, state: &State<N>) -> f64 {
        state.offset_bound.to_f64(self.units.gimbal_angle)
    }
}
