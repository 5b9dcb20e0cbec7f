//! One row of the estimator.
//!
//! ```text
//! readings -> prediction -> theta's innovation -> correction -> phi, bound -> INS correction
//! ```
//!
//! The straight path is the free gyro with every sensor well; all else branches off it.

use super::bound::RootSum;
use super::config::Config;
use super::filter::{Filter, STATES};
use super::flags::Flags;
use super::health::{self, Admitted};
use super::held;
use super::release::{self, Correction};
use super::state::{Regime, State};
use crate::build::plant::Plant;
use crate::faults::Faults;
use crate::ins;
use crate::number::Number;
use crate::row::{Row, ScaledRow};
use crate::state::State as ModelState;
use crate::stop::Side;
use crate::units::Units;

/// Sensor faults that leave the filter's disturbance torque in doubt.
const TROUBLE: Flags = Flags::GYRO_TORQUE_OR_WRONG;
/// For so many rows.
const TROUBLED_ROWS: u32 = 100;

/// What the sensors of the axis read at this row; `None` where there is no reading.
///
/// In the full scales that [`Law::measured`] gives. A reading that is not finite counts as none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Measured<N> {
    /// theta [rad].
    pub gyro_angle_rad: Option<N>,
    /// `T_m` [N m].
    pub motor_torque_nm: Option<N>,
}

/// What is known of the axis at this row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate<N> {
    /// phi, the attitude error [rad].
    pub gimbal_angle_rad: N,
    /// Its uncertainty, 1 sigma [rad].
    pub bound_rad: N,
    /// `T_d` as it shows in theta and `T_m` [N m], in the full scale of motor torques.
    pub disturbance_torque_nm: N,
    /// theta's innovation: measured less predicted [rad].
    pub innovation_rad: N,
    /// What the estimate says of itself.
    pub flags: Flags,
}

/// The estimator of one axis, ready to step: built once from a [`Config`], never changed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Law<N: Number> {
    health: health::Law<N>,
    /// Change of theta, w, p for w, p, d, u.
    change: [Row<N, 4>; 3],
    gain: [N::Coef; STATES],
    /// Full scale of the filter to that of theta.
    shift: u32,
    /// Largest innovation that is no spike, and half of it.
    gate: N,
    /// |theta| from which on a stop may be near.
    zone: N,
    /// The nominal stop.
    rest: N,
    /// phi for theta, w, p, d, u.
    seen: Row<N, 5>,
    /// theta at the horizon, likewise.
    ahead: Row<N, 5>,
    stop: N,
    ratio_share: N::Coef,
    noise: N,
    transient_decay: N::Coef,
    transient_gain: N::Coef,
    level_gain: N::Coef,
    /// Innovations that are plain noise.
    usual: N,
    widest: N,
    root_sum: RootSum<N>,
    torque: ScaledRow<N, 1>,
    ins: ins::Law<N>,
    quick_gain: [N::Coef; STATES],
    settling_rows: u32,
    held: held::Law<N>,
    release: release::Law<N>,
    contact: Contact<N>,
    /// phi' for p, and for theta's excess at contact.
    rate: ScaledRow<N, 2>,
    /// `H theta'` for w.
    coupling: ScaledRow<N, 1>,
    /// u's inverse: d for a torque.
    load: ScaledRow<N, 1>,
    /// Least fall of theta that is a release.
    fallen: N,
    /// Uncertainty of phi after one row without theta; it grows with the square of the rows.
    outage: N,
    /// phi that one period of delay adds, for phi'.
    delay: ScaledRow<N, 1>,
    servo: Servo<N>,
    units: Units,
    /// Full scale of theta.
    gyro: i32,
}

/// (3) as it follows theta: y, then `z_i`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Servo<N: Number> {
    integrator: ScaledRow<N, 2>,
    decay: [N::Coef; 5],
    lags: [ScaledRow<N, 1>; 5],
    torque: ScaledRow<N, 7>,
}

/// What the mean of neighbouring samples misses of the motor torque's impulse after a contact, as phi'.
///
/// At the contact theta' falls to zero, and the servo answers within a few periods: in the terms of (3), for a theta' of 1
/// and the contact d periods before a sample,
///
/// ```text
/// T^2 D d (1 - d) / 2 + sum r_i / p_i^2 (T e^(p_i d T) / (1 - e^(p_i T)) + 1 / p_i - T (1/2 - d))
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
struct Contact<N: Number> {
    powers: [ScaledRow<N, 1>; 3],
    shift: u32,
}

impl<N: Number> Contact<N> {
    fn build(plant: &Plant, units: &Units, scale: i32, gyro: i32, period: f64) -> Self {
        let at = |d: f64| {
            let lags = plant.lags.iter().zip(&plant.lag_gains).map(|(p, gain)| {
                let x = p * period;
                gain / p * (-period * libm::exp(x * d) / libm::expm1(x) + 1.0 / p - period * (0.5 - d))
            });
            let sum = 0.5 * period * period * plant.direct_gain() * d * (1.0 - d) + lags.sum::<f64>();
            sum / (period * plant.gimbal_inertia)
        };
        let (start, middle, end) = (at(0.0), at(0.5), at(1.0));
        let square = 2.0 * (start + end) - 4.0 * middle;
        let powers = [start, end - start - square, square];
        Self {
            powers: powers.map(|power| ScaledRow::build([power], [scale], units.gimbal_rate)),
            shift: (scale - gyro).unsigned_abs(),
        }
    }

    /// For w at contact, and theta's excess over the stop, mirrored.
    fn increment(&self, w: N, excess: N, side: Side) -> N::Wide {
        let speed = side.mirror(w);
        if speed <= N::ZERO {
            return N::Wide::default();
        }
        let mut excess = excess.shift_down(self.shift);
        if excess > speed {
            excess = excess - speed;
        }
        let part = excess.least(speed).ratio(speed);
        let [a, b, c] = &self.powers;
        a.increment(&[w]) + b.increment(&[w.times(part)]) + c.increment(&[w.times(part).times(part)])
    }
}

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
        let from = [scale, scale, scale, torque];
        let signals = [scale, scale, scale, scale, torque];
        let gains = |filter: &Filter| filter.gain.map(|gain| N::coef(N::rescaled(gain, -shift)));
        let delay = config.sensors.delay_s / period;
        let seen = filter.seen_row(delay);
        let ahead = filter.ahead(delay + config.horizon_s / period)[0];
        let ahead_scale = Row::<N, 5>::exponent(ahead, signals).max(scale);
        let now = filter.seen_row(0.0);
        let seen_gain: f64 = now.iter().zip(&filter.gain).map(|(row, gain)| row * gain).sum();
        let read = libm::hypot(config.sensors.gyro_noise_rad, config.sensors.gyro_step_rad / libm::sqrt(12.0));
        let angle = |value: f64| N::quantise(value, gyro);
        let zone = stop * (1.0 - 4.0 * tolerance.stop_angle) - 6.0 * filter.innovation_rad;
        let seen_noise = filter.deviation(&[now[0], now[1], now[2], now[3]]);
        let rate_noise = filter.ratio / period * filter.deviation(&[0.0, 0.0, 1.0, 0.0]);
        // phi from a rate that is uncertain, and from a torque that may have come.
        let outage = rate_noise * period + 0.75 * period * period * 0.1 * axis.range.torque_nm / jg;
        Self {
            health: health::Law::build(config, axis, units, gyro),
            change: core::array::from_fn(|i| {
                let [_, w, p, d] = filter.change[i];
                Row::build([w, p, d, filter.drive[i]], from, scale)
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
            usual: angle(2.5 * filter.innovation_rad),
            widest: N::quantise(config.widest_bound_rad, units.gimbal_angle),
            root_sum: RootSum::build(),
            torque: ScaledRow::build([1.0 / filter.torque_scale], [scale], torque),
            ins: ins::Law::build(units, axis.range.radial_accel_mps2.max(axis.range.axial_accel_mps2), period),
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
        self.ins.velocity_error_mps(&state.ins, [0.0; 2]).map(|error| -error)
    }

    /// What the navigation adds to its position along x and y [m].
    #[must_use]
    pub fn position_correction_m(&self, state: &State<N>) -> [f64; 2] {
        self.ins.position_error_m(&state.ins, [0.0; 2]).map(|error| -error)
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

    /// Takes the readings of this instant and gives the estimate at it.
    ///
    /// `axis` and `model` are the axis' law and its state after it has taken the same row, `faults` that step's faults:
    /// the estimator reads the admitted row and, while the gyro sits on a stop, the modelled disturbance.
    pub fn step(
        &self,
        state: &mut State<N>,
        measured: &Measured<N>,
        axis: &crate::Law<N>,
        model: &ModelState<N>,
        faults: Faults,
    ) -> Estimate<N> {
        let row = &model.row;
        let inputs = [row.accel_x_mps2, row.accel_y_mps2, row.accel_z_mps2, row.vehicle_rate_radps];
        let (Some(gyro), Some(torque)) = (measured.gyro_angle_rad, measured.motor_torque_nm) else {
            return self.step_closely(state, measured, &inputs, axis, model, faults);
        };
        if state.watched || !self.health.ordinary(state, gyro, torque, &inputs, faults) || !gyro.within(self.zone) {
            return self.step_closely(state, measured, &inputs, axis, model, faults);
        }
        let innovation = self.predict(state, gyro, state.torque.half() + torque.half());
        if !innovation.within(self.gate) {
            return self.meet_spike(state, gyro, torque, innovation, inputs);
        }
        self.correct(state, &self.gain, innovation);
        state.torque = torque;
        state.gyro = gyro;
        state.inputs = inputs;
        self.finish(state, innovation, Flags::NONE)
    }

    /// Advances the filter; gives theta less its prediction.
    #[inline(always)]
    fn predict(&self, state: &mut State<N>, gyro: N, torque: N) -> N {
        let [_, w, p, d] = state.filter.map(N::head);
        let signals = [w, p, d, torque];
        let [x0, x1, x2, _] = &mut state.filter;
        *x0 = *x0 + self.change[0].increment(&signals);
        *x1 = *x1 + self.change[1].increment(&signals);
        *x2 = *x2 + self.change[2].increment(&signals);
        (gyro.shift_down(self.shift) - N::head(state.filter[0])).shift_up(self.shift)
    }

    #[inline(always)]
    fn correct(&self, state: &mut State<N>, gain: &[N::Coef; STATES], innovation: N) {
        for (x, gain) in state.filter.iter_mut().zip(gain) {
            *x = *x + *gain * innovation;
        }
        let excess = innovation.abs() - self.usual;
        let d = N::head(state.filter[3]);
        state.transient = N::head(self.transient_decay * state.transient);
        if excess > N::ZERO {
            state.transient = state.transient.most(N::head(self.transient_gain * excess));
            state.level = d;
        } else {
            state.level = state.level + N::head(self.level_gain * (d - state.level));
        }
    }

    /// phi, its bound and the INS sums, the gyro free.
    #[inline(always)]
    fn finish(&self, state: &mut State<N>, innovation: N, flags: Flags) -> Estimate<N> {
        let [theta, w, p, d] = state.filter.map(N::head);
        let signals = [theta, w, p, d, state.torque];
        let seen = self.seen.increment(&signals);
        let angle = N::narrow(state.offset + seen);
        let mut bound = self.root_sum.of(self.noise + state.transient, N::head(self.ratio_share * N::head(seen).abs()));
        if state.offset_bound != N::ZERO {
            bound = self.root_sum.of(bound, state.offset_bound);
        }
        let ahead = self.ahead.at(&signals);
        let flags = flags | state.lasting | Flags::SATURATION_AHEAD.when(!ahead.within(self.stop));
        self.report(state, angle, bound, self.torque.times(d), innovation, flags)
    }

    #[inline(always)]
    fn report(&self, state: &mut State<N>, angle: N, bound: N, torque: N, innovation: N, flags: Flags) -> Estimate<N> {
        let [accel_x, accel_y, ..] = state.inputs;
        self.ins.step(&mut state.ins, [accel_x, accel_y], angle);
        Estimate {
            gimbal_angle_rad: angle,
            bound_rad: bound,
            disturbance_torque_nm: torque,
            innovation_rad: innovation,
            flags: flags | Flags::BOUND_TOO_WIDE.when(bound > self.widest),
        }
    }

    /// The filter has been advanced, and theta is far from where it should be.
    #[cold]
    #[inline(never)]
    fn meet_spike(&self, state: &mut State<N>, gyro: N, torque: N, innovation: N, inputs: [N; 4]) -> Estimate<N> {
        state.torque = torque;
        state.gyro = gyro;
        state.inputs = inputs;
        health::Law::<N>::miss_gyro(&mut state.health);
        state.watched = true;
        state.transient = state.transient.most(self.outage);
        self.finish(state, innovation, Flags::GYRO_MISSING)
    }

    /// Any row off the straight path.
    #[inline(never)]
    fn step_closely(
        &self,
        state: &mut State<N>,
        measured: &Measured<N>,
        inputs: &[N; 4],
        axis: &crate::Law<N>,
        model: &ModelState<N>,
        faults: Faults,
    ) -> Estimate<N> {
        let admitted = self.health.admit(state, measured, inputs, faults, self.zone);
        let previous = state.torque;
        let mut mean = previous;
        if let Some(torque) = admitted.torque {
            mean = previous.half() + torque.half() + admitted.catch_up;
            state.torque = torque;
        }
        let troubled = admitted.flags.bits() & TROUBLE.bits() != 0 && !state.health.torque_waits();
        state.trouble = if troubled { TROUBLED_ROWS } else { state.trouble.saturating_sub(1) };
        if !self.health.torque_measured() {
            // Half a period on from the last row, along the line through the last two.
            mean = state.torque + (state.torque - state.torque_waiting).half();
        }
        let last_gyro = state.gyro;
        if let Some(gyro) = measured.gyro_angle_rad.filter(|gyro| gyro.is_number()) {
            state.gyro = gyro;
        }
        let estimate = match state.regime {
            Regime::New => self.begin(state, &admitted),
            Regime::Free => self.step_free(state, &admitted, mean, last_gyro, axis, model),
            Regime::Held(side) => self.step_on_stop(state, &admitted, mean, side, axis, model),
        };
        if !self.health.torque_measured() {
            self.follow_servo(state);
        }
        state.watched = state.regime != Regime::Free
            || state.settling > 0
            || state.trouble > 0
            || self.health.watches(&state.health);
        estimate
    }

    /// (3) over the period just past, theta along a line.
    fn follow_servo(&self, state: &mut State<N>) {
        let theta = match state.regime {
            Regime::Held(_) => state.held.stop.shift_down(self.shift),
            Regime::New | Regime::Free => N::head(state.filter[0]),
        };
        let servo = &self.servo;
        let change = theta - state.servo_theta;
        let [integrator, lags @ ..] = &mut state.servo;
        *integrator = N::confine(*integrator + servo.integrator.increment(&[state.servo_theta, theta]));
        for (lag, (decay, gain)) in lags.iter_mut().zip(servo.decay.iter().zip(&servo.lags)) {
            *lag = N::confine(N::low(*lag) + *decay * N::narrow(*lag) + gain.increment(&[change]));
        }
        state.servo_theta = theta;
        state.torque_waiting = state.torque;
        let [y, a, b, c, d, e] = state.servo.map(N::narrow);
        state.torque = servo.torque.at(&[y, a, b, c, d, e, theta]);
    }

    /// The first row, or the first with theta.
    fn begin(&self, state: &mut State<N>, admitted: &Admitted<N>) -> Estimate<N> {
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
    fn place(&self, state: &mut State<N>, gyro: N, w: N, p: N) {
        let [x0, x1, x2, _] = &mut state.filter;
        (*x0, *x1, *x2) = (gyro.shift_down(self.shift).widen(), w.widen(), p.widen());
    }

    fn step_free(
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
            for _ in 0..(2 * rows.min(64)).saturating_sub(1) {
                state.transient = state.transient + self.outage;
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
            let still = moved < usual;
            // Near a turning point theta stands still by itself: it must have been moving.
            if deficit > least && still && speed > usual && moved < speed.half() {
                state.postponed = false;
                return self.meet_stop(state, side, gyro, axis, model, flags);
            }
            // A stop may hold theta back: the filter must not learn from it before that is decided.
            let slowed = moved < speed.half() || still;
            let some = deficit + deficit + deficit > self.usual && slowed && state.waits == 0;
            state.postponed = !settling && (some || (deficit > least && state.waits < 3));
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
        if !innovation.within(gate) {
            health::Law::<N>::miss_gyro(&mut state.health);
            state.transient = state.transient.most(self.outage);
            return self.finish(state, innovation, flags | Flags::GYRO_MISSING);
        }
        health::Law::<N>::take_gyro(&mut state.health);
        let gain = if settling || admitted.torque_lost { &self.quick_gain } else { &self.gain };
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

    /// The filter has run on beyond the stop by what theta is short of it.
    fn meet_stop(
        &self,
        state: &mut State<N>,
        side: Side,
        gyro: N,
        axis: &crate::Law<N>,
        model: &ModelState<N>,
        flags: Flags,
    ) -> Estimate<N> {
        let [theta, w, p, d] = state.filter.map(N::head);
        let excess = (theta - gyro.shift_down(self.shift)).shift_up(self.shift);
        let excess = if side.mirror(excess) > N::ZERO { excess } else { N::ZERO };
        let seen = self.seen.increment(&[theta, w, p, d, state.torque]);
        let angle = state.offset + seen;
        let rate = self.rate.increment(&[p, excess]) - self.contact.increment(w, side.mirror(excess), side);
        let torque = self.torque.times(state.level);
        let moved = self.torque.times(d - state.level).half();
        let modelled = held::modelled_torque(axis, model, N::narrow(rate));
        let coupling = N::head(self.held.rate_share * self.coupling.times(w).abs());
        let noise = self.root_sum.of(self.noise + state.transient, state.offset_bound);
        let seen_doubt = N::head(self.ratio_share * N::narrow(seen).abs());
        let torque_bound = self.root_sum.of_all(&[self.held.torque_noise, coupling, moved]);
        state.held = held::State {
            angle,
            rate,
            rates: [N::narrow(rate); release::RATES],
            first_angle: N::narrow(angle),
            first_rate: N::narrow(rate),
            first_bound: self.root_sum.of(noise, seen_doubt),
            torque_bound,
            first_torque_bound: torque_bound,
            surplus: torque - modelled.shift_down(self.held.torque_shift),
            modelled,
            first_modelled: modelled,
            stop: gyro,
            ..held::State::default()
        };
        state.regime = Regime::Held(side);
        state.lasting |= Flags::OFFSET_DOUBTFUL.when(state.trouble > 0);
        state.postponed = false;
        state.watched = true;
        self.finish_held(state, flags)
    }

    fn step_on_stop(
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
        state.lasting |= Flags::OFFSET_DOUBTFUL.when(faults & !Flags::INPUT_SPIKE.bits() != 0);
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

    fn finish_held(&self, state: &mut State<N>, flags: Flags) -> Estimate<N> {
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
        let seen = self.seen.increment(&[theta, w, p, d, state.torque]);
        state.offset = N::confine(held.angle - angle.widen() - seen);
        state.offset_bound = bound;
        state.transient = N::ZERO;
        state.lasting |= Flags::OFFSET_HELD;
        state.regime = Regime::Free;
        state.settling = self.settling_rows;
        self.finish(state, N::ZERO, flags | Flags::SETTLING)
    }
}

/// The side on which an angle lies beyond a limit.
fn side_beyond<N: Number>(angle: N, limit: N) -> Option<Side> {
    if angle.within(limit) {
        None
    } else if angle > N::ZERO {
        Some(Side::Positive)
    } else {
        Some(Side::Negative)
    }
}

impl<N: Number> Servo<N> {
    fn build(plant: &Plant, units: &Units, scale: i32, period: f64) -> Self {
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
