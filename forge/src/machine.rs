//! The true platform in motion: fixed-step Runge-Kutta of order 4, cut at the contacts and releases of the gyro's stops.
//!
//! ```text
//! Jg phi''   = T_d - H theta' - T_m                                                             (1)
//! Jo theta'' = H phi' - Bo theta' + float torques            |theta| < stop                     (2)
//! T_m        = drive( lag( delay( F theta ) ) )                                                 (3)
//! T_d        = friction + unbalance + torques of the effects + external
//! V'         = (a_y phi, -a_x phi)                                                              (7)
//! ```
//!
//! On a stop theta stands still (inelastic contact) until the torque on the float points away from it. With an
//! appendage: `(Jg - Ja) phi'' = ... + S`, `Ja (phi + e)'' = -S`, S the torque of its spring and damper.

use crate::compensator::{Compensator, ORDER};
use crate::memory::{Memory, Path};
use crate::palmgren::Palmgren;
use crate::track::{Row, Track};
use crate::truth::Truth;

const PHI: usize = 0;
const PHI_RATE: usize = 1;
const THETA: usize = 2;
const THETA_RATE: usize = 3;
const SERVO: usize = 4;
const LAG: usize = SERVO + ORDER;
const RELATIVE: usize = LAG + 1;
const DEFLECTION: usize = RELATIVE + 1;
const DEFLECTION_RATE: usize = DEFLECTION + 1;
const HEAT: usize = DEFLECTION_RATE + 1;
const CREEP: usize = HEAT + 1;
const SNAP: usize = CREEP + 1;
const VELOCITY: usize = SNAP + 1;
const STATES: usize = VELOCITY + 2;

/// Time in which a snapping spring goes over [s].
const SNAP_TIME_S: f64 = 4e-3;
/// Smallest piece of a step that is still cut at an event [s].
const SHORTEST_S: f64 = 1e-12;

type States = [f64; STATES];

/// Where the float is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stop {
    Free,
    Upper,
    Lower,
}

/// What the platform shows at one instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sample {
    /// phi [rad].
    pub gimbal_angle_rad: f64,
    /// theta, as the servo sees it [rad].
    pub gyro_angle_rad: f64,
    /// Motor torque on the gimbal [N m].
    pub motor_torque_nm: f64,
    /// Vehicle against stable member [rad].
    pub relative_angle_rad: f64,
    /// Friction torque [N m].
    pub friction_nm: f64,
    /// Velocity error along x and y since the first row [m/s].
    pub velocity_error_mps: [f64; 2],
    /// Whether the gyro is on a stop.
    pub on_stop: bool,
}

/// Inputs at a stage of a step.
#[derive(Debug, Clone, Copy)]
struct Stage {
    row: Row,
    load_nm: f64,
    time_s: f64,
    since_commit_s: f64,
}

/// Torques at one instant.
#[derive(Debug, Clone, Copy)]
struct Torques {
    friction: f64,
    motor: f64,
}

/// Load torque of the bearings along a track, at the begin, the middle and the end of every step [N m]: the same for
/// every platform that runs along it.
#[derive(Debug, Clone)]
pub struct Loads {
    steps_per_row: usize,
    /// Two a step: begin and middle; the end is the next begin.
    halves_nm: Vec<f64>,
}

impl Loads {
    /// For platforms with these bearings.
    #[must_use]
    pub fn new(bearing: &gimbal_servo::bearing::Config, track: &Track, steps_per_row: usize) -> Self {
        let palmgren = Palmgren::new(bearing);
        let halves = 2 * steps_per_row;
        let halves_nm = (0..=(track.rows.len() - 1) * halves)
            .map(|half| {
                let (from, to) = track.around(half / halves);
                palmgren.load_nm(from.towards(to, (half % halves) as f64 / halves as f64).accel_mps2)
            })
            .collect();
        Self { steps_per_row, halves_nm }
    }

    fn of_step(&self, row: usize, step: usize) -> Option<[f64; 3]> {
        let first = 2 * (row * self.steps_per_row + step);
        self.halves_nm.get(first..first + 3).map(|three| [three[0], three[1], three[2]])
    }
}

/// A platform that runs along a track.
#[derive(Debug, Clone)]
pub struct Machine<'a> {
    truth: &'a Truth,
    track: &'a Track,
    steps_per_row: usize,
    /// Time of the first row [s]; negative when the record starts later.
    start_s: f64,
    compensator: Compensator,
    palmgren: Palmgren,
    states: States,
    memory: Memory,
    stop: Stop,
    row: usize,
    /// Commands at the last step starts, newest last.
    history: Vec<f64>,
    frozen_nm: Option<f64>,
    contact_now: bool,
    loads: Option<&'a Loads>,
    /// Times of contact and of release [s].
    pub events_s: Vec<f64>,
}

fn inside(spans: &[(f64, f64)], time_s: f64) -> bool {
    spans.iter().any(|(from, to)| (*from..*to).contains(&time_s))
}

impl<'a> Machine<'a> {
    /// At rest at the first row of the track, whose time is `start_s`.
    #[must_use]
    pub fn new(truth: &'a Truth, track: &'a Track, steps_per_row: usize, start_s: f64) -> Self {
        Self {
            truth,
            track,
            steps_per_row,
            start_s,
            compensator: Compensator::new(&truth.config.servo),
            palmgren: Palmgren::new(&truth.config.bearing),
            states: [0.0; STATES],
            memory: Memory::new(truth),
            stop: Stop::Free,
            row: 0,
            history: Vec::new(),
            frozen_nm: None,
            contact_now: false,
            loads: None,
            events_s: Vec::new(),
        }
    }

    /// Takes the load torques from a table made for its track and its bearings.
    #[must_use]
    pub fn with_loads(mut self, loads: Option<&'a Loads>) -> Self {
        self.loads = loads.filter(|loads| loads.steps_per_row == self.steps_per_row);
        self
    }

    /// Lets the platform settle under the inputs of the first row for `time_s`.
    pub fn settle(&mut self, time_s: f64) {
        let still = Track { period_s: self.track.period_s, rows: vec![self.track.rows[0]; 2] };
        let step_s = self.track.period_s / self.steps_per_row as f64;
        let load_nm = Some([self.palmgren.load_nm(still.rows[0].accel_mps2); 3]);
        let mut spent = 0.0;
        while spent < time_s {
            self.step(&still, (0, 0.0), load_nm, step_s, 0.0);
            spent += step_s;
        }
        self.zero_record();
    }

    /// Starts the record here: relative angle and velocity error count from now.
    pub fn zero_record(&mut self) {
        self.states[CREEP] -= self.states[RELATIVE];
        self.states[RELATIVE] = 0.0;
        self.states[VELOCITY] = 0.0;
        self.states[VELOCITY + 1] = 0.0;
        self.events_s.clear();
    }

    /// Runs to the next row.
    pub fn advance(&mut self) {
        let step_s = self.track.period_s / self.steps_per_row as f64;
        let track = self.track;
        for step in 0..self.steps_per_row {
            let part = step as f64 / self.steps_per_row as f64;
            let time_s = self.start_s + (self.row as f64 + part) * track.period_s;
            let loads_nm = self.loads.and_then(|loads| loads.of_step(self.row, step));
            self.step(track, (self.row, part), loads_nm, step_s, time_s);
        }
        self.row += 1;
    }

    /// What the platform shows at the present row.
    #[must_use]
    pub fn sample(&self) -> Sample {
        let row = self.track.rows[self.row.min(self.track.rows.len() - 1)];
        let stage = Stage {
            row,
            load_nm: self.palmgren.load_nm(row.accel_mps2),
            time_s: self.start_s + self.row as f64 * self.track.period_s,
            since_commit_s: 0.0,
        };
        let torques = self.torques(&self.states, &stage, self.states[RELATIVE]);
        Sample {
            gimbal_angle_rad: self.states[PHI],
            gyro_angle_rad: self.seen(self.states[THETA]),
            motor_torque_nm: torques.motor,
            relative_angle_rad: self.states[RELATIVE],
            friction_nm: torques.friction,
            velocity_error_mps: [self.states[VELOCITY], self.states[VELOCITY + 1]],
            on_stop: self.stop != Stop::Free,
        }
    }

    fn seen(&self, angle_rad: f64) -> f64 {
        self.truth.drive.step_rad.map_or(angle_rad, |step| libm::round(angle_rad / step) * step)
    }

    /// One step of `step_s` that begins a share `part` of the way from row `row` to the next; `loads_nm` at begin,
    /// middle and end where they are known.
    fn step(&mut self, track: &Track, (row, part): (usize, f64), loads_nm: Option<[f64; 3]>, step_s: f64, time_s: f64) {
        let (from, to) = track.around(row);
        let series = |place: usize| self.truth.torque.series_nm.get(place).copied().unwrap_or(0.0);
        let (extra_from, extra_to) = (series(row), series(row + 1));
        let known_at = |offset_s: f64, since_commit_s: f64, load_nm: Option<f64>, palmgren: &Palmgren| {
            let share = part + offset_s / track.period_s;
            let mut row = from.towards(to, share);
            row.external_nm += extra_from + (extra_to - extra_from) * share;
            let load_nm = load_nm.unwrap_or_else(|| palmgren.load_nm(row.accel_mps2));
            Stage { row, load_nm, time_s: time_s + offset_s, since_commit_s }
        };
        let stage_at = |palmgren: &Palmgren, offset_s: f64, since_commit_s: f64| {
            known_at(offset_s, since_commit_s, None, palmgren)
        };
        self.note_command(time_s);
        let mut done_s = 0.0;
        while step_s - done_s > SHORTEST_S {
            // a step that was cut has other middles
            let known = loads_nm.filter(|_| done_s == 0.0);
            let load = |place: usize| known.map(|loads| loads[place]);
            let begin = known_at(done_s, 0.0, load(0), &self.palmgren);
            let mut piece_s = step_s - done_s;
            let middle = known_at(done_s + 0.5 * piece_s, 0.5 * piece_s, load(1), &self.palmgren);
            let end = known_at(done_s + piece_s, piece_s, load(2), &self.palmgren);
            let mut after = self.runge_kutta(&begin, &middle, &end, done_s, piece_s);
            let overshoot = |machine: &Self, states: &States, stage: &Stage| machine.beyond_event(states, stage);
            let mut last = end;
            let mut event = false;
            if overshoot(self, &after, &end) > 0.0 {
                // bisection on the length of the step: the flag turns once within it
                let (mut short_s, mut long_s) = (0.0, piece_s);
                for _ in 0..48 {
                    let trial_s = 0.5 * (short_s + long_s);
                    let middle = stage_at(&self.palmgren, done_s + 0.5 * trial_s, 0.5 * trial_s);
                    let end = stage_at(&self.palmgren, done_s + trial_s, trial_s);
                    let trial = self.runge_kutta(&begin, &middle, &end, done_s, trial_s);
                    if overshoot(self, &trial, &end) > 0.0 {
                        (long_s, after, last) = (trial_s, trial, end);
                    } else {
                        short_s = trial_s;
                    }
                }
                piece_s = long_s;
                event = true;
            }
            self.commit(after, &last, piece_s);
            if event {
                self.pass_event(last.time_s);
            }
            done_s += piece_s.max(SHORTEST_S);
        }
    }

    /// Above 0 when the float has passed a stop, or is pushed away from the one it lies on.
    fn beyond_event(&self, states: &States, stage: &Stage) -> f64 {
        let stop_rad = self.truth.config.gyro.stop_angle_rad;
        match self.stop {
            Stop::Free => states[THETA].abs() - stop_rad,
            Stop::Upper => -self.float_torque_nm(states, stage),
            Stop::Lower => self.float_torque_nm(states, stage),
        }
    }

    fn pass_event(&mut self, time_s: f64) {
        self.events_s.push(time_s);
        let stop_rad = self.truth.config.gyro.stop_angle_rad;
        match self.stop {
            Stop::Free => {
                self.stop = if self.states[THETA] > 0.0 { Stop::Upper } else { Stop::Lower };
                self.states[THETA] = stop_rad.copysign(self.states[THETA]);
                self.states[THETA_RATE] = 0.0;
            }
            Stop::Upper | Stop::Lower => self.stop = Stop::Free,
        }
    }

    fn commit(&mut self, states: States, stage: &Stage, piece_s: f64) {
        let path = self.path(&states, stage, piece_s);
        self.memory.commit(self.truth, path, states[RELATIVE]);
        self.states = states;
    }

    fn path(&self, states: &States, stage: &Stage, time_s: f64) -> Path {
        let slip_radps = self.truth.config.bearing.slip_rate_radps;
        let rate = stage.row.rate_radps - states[PHI_RATE];
        Path {
            moved_rad: states[RELATIVE] - self.states[RELATIVE],
            time_s,
            rate_radps: rate,
            curve: (rate / slip_radps).clamp(-1.0, 1.0),
            slip_radps,
        }
    }

    fn runge_kutta(&self, begin: &Stage, middle: &Stage, end: &Stage, done_s: f64, step_s: f64) -> States {
        let along = |slope: &States, time_s: f64| -> States {
            core::array::from_fn(|index| self.states[index] + time_s * slope[index])
        };
        let k1 = self.slope(&self.states, begin, done_s);
        let k2 = self.slope(&along(&k1, 0.5 * step_s), middle, done_s + 0.5 * step_s);
        let k3 = self.slope(&along(&k2, 0.5 * step_s), middle, done_s + 0.5 * step_s);
        let k4 = self.slope(&along(&k3, step_s), end, done_s + step_s);
        core::array::from_fn(|index| {
            self.states[index] + step_s / 6.0 * (k1[index] + 2.0 * (k2[index] + k3[index]) + k4[index])
        })
    }

    fn servo(states: &States) -> [f64; ORDER] {
        core::array::from_fn(|index| states[SERVO + index])
    }

    /// Keeps the command at the start of a step, for the delay, and what changes only from step to step.
    fn note_command(&mut self, time_s: f64) {
        let drive = &self.truth.drive;
        if drive.delay_s > 0.0 || !drive.frozen_s.is_empty() {
            let command = self.compensator.output_nm(&Self::servo(&self.states), self.seen(self.states[THETA]));
            if self.history.is_empty() {
                self.history = vec![command; 4];
            }
            self.history.push(command);
            if self.history.len() > 65_536 {
                self.history.drain(..32_768);
            }
            self.frozen_nm = if inside(&drive.frozen_s, time_s) { self.frozen_nm.or(Some(command)) } else { None };
        }
        self.contact_now = self.truth.torque.contact.as_ref().is_some_and(|contact| inside(&contact.spans_s, time_s));
    }

    /// The command `delay` ago, `offset_s` into a step.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few thousand steps at most
    fn delayed(&self, command: f64, command_rate: f64, offset_s: f64) -> f64 {
        let delay_s = self.truth.drive.delay_s;
        let step_s = self.track.period_s / self.steps_per_row as f64;
        if delay_s < step_s {
            return command - delay_s * command_rate;
        }
        // steps before the start of the present one, at least 0
        let back = (delay_s - offset_s) / step_s;
        let newest = self.history.len() - 1;
        let whole = (back.floor().max(0.0) as usize).min(newest.saturating_sub(3));
        // cubic through four old commands; `place` counts back from the newest of the four
        let first = whole.saturating_sub(1);
        let place = back - first as f64;
        let value = |index: usize| self.history[newest.saturating_sub(first + index)];
        let [p, q, r, s] = [place, place - 1.0, place - 2.0, place - 3.0];
        value(0) * q * r * s / -6.0 + value(1) * p * r * s / 2.0 - value(2) * p * q * s / 2.0
            + value(3) * p * q * r / 6.0
    }

    fn momentum(&self, time_s: f64) -> f64 {
        let nominal = self.truth.config.gyro.angular_momentum_nm_s;
        self.truth.float.hunting.map_or(nominal, |[swing, frequency_hz, phase]| {
            nominal * (1.0 + swing * libm::sin(2.0 * core::f64::consts::PI * frequency_hz * time_s + phase))
        })
    }

    /// Torque on the float at rest [N m].
    fn float_torque_nm(&self, states: &States, stage: &Stage) -> f64 {
        let float = &self.truth.float;
        self.momentum(stage.time_s) * states[PHI_RATE] + float.constant_nm + float.per_accel * stage.row.accel_mps2[0]
            - float.restraint * states[THETA]
    }

    fn motor_nm(&self, states: &States) -> f64 {
        let drive = &self.truth.drive;
        let limited = drive.limit_nm.map_or(states[LAG], |limit| states[LAG].clamp(-limit, limit));
        let width = drive.dead_zone_nm;
        let mut torque = limited - limited.clamp(-width, width);
        if let Some([loss, _, _]) = drive.heating {
            torque *= 1.0 - loss * states[HEAT];
        }
        torque + drive.torque_asymmetry * torque.abs()
    }

    fn torques(&self, states: &States, stage: &Stage, relative_rad: f64) -> Torques {
        let friction = &self.truth.friction;
        let path = self.path(states, stage, stage.since_commit_s);
        let rate = stage.row.rate_radps - states[PHI_RATE];
        let [x, y, _] = stage.row.accel_mps2;
        let radial_g = libm::sqrt(x * x + y * y) / gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
        let load_nm = stage.load_nm * (1.0 + friction.load_change) * (1.0 + friction.load_per_g * radial_g);
        let mut level = load_nm + self.palmgren.viscous_nm(rate) * (1.0 + friction.viscous_change);
        if let Some([excess, width, exponent]) = friction.stribeck {
            let over = rate.abs() / width;
            level += excess * libm::exp(-libm::exp(exponent * libm::log(over.max(1e-9))));
        }
        let mut torque = level * self.memory.friction(friction.presliding.as_ref(), path);
        torque *= 1.0 + friction.asymmetry * path.curve;
        if let Some([growth, time_s, quick]) = friction.drift {
            let since = stage.time_s.max(0.0) / time_s;
            let grown = 1.0 - (1.0 - quick) * libm::exp(-since) - quick * libm::exp(-4.0 * since);
            torque *= 1.0 + growth * grown;
        }
        if let Some([swing, cycles, phase]) = friction.position {
            torque *= 1.0 + swing * libm::sin(cycles * relative_rad + phase);
        }
        torque += rate * (friction.linear + friction.quadratic * rate.abs());
        Torques { friction: torque, motor: self.motor_nm(states) }
    }

    /// Torque of everything on the gimbal but friction, servo and gyro [N m].
    fn disturbance_nm(&self, states: &States, stage: &Stage) -> f64 {
        let torque = &self.truth.torque;
        let unbalance = &self.truth.config.unbalance;
        let [x, y, _] = stage.row.accel_mps2;
        let (rate, relative) = (stage.row.rate_radps, states[RELATIVE]);
        let path = self.path(states, stage, stage.since_commit_s);
        let mut sum = (unbalance.x_kg_m + torque.unbalance_kg_m[0]) * y
            - (unbalance.y_kg_m + torque.unbalance_kg_m[1]) * x
            + torque.anisoelastic * x * y
            + relative * (torque.spring[0] + torque.spring[1] * relative * relative)
            + torque.constant_nm
            + torque.cross_rates * rate * stage.row.cross_rate_radps
            + torque.rate_squared * rate * rate
            + stage.row.external_nm;
        sum += self.memory.cable_nm(&torque.hysteresis, path);
        for [amplitude, cycles, phase] in &torque.ripple {
            sum += amplitude * libm::sin(cycles * relative + phase);
        }
        if let Some([size, _]) = torque.snap {
            sum += size * states[SNAP];
        }
        if let Some(contact) = torque.contact.as_ref().filter(|_| self.contact_now) {
            sum += contact.stiffness * (relative - contact.from_rad).max(0.0);
        }
        if let Some([size, displacement, limit]) = torque.chatter {
            let slow = (2.0 - (rate - states[PHI_RATE]).abs() / limit).clamp(0.0, 1.0);
            sum += size * slow * self.memory.brush(displacement, path);
        }
        if let Some([stiffness, _]) = torque.creep {
            sum += stiffness * (relative - states[CREEP]);
        }
        sum
    }

    fn slope(&self, states: &States, stage: &Stage, offset_s: f64) -> States {
        let config = &self.truth.config;
        let free = self.stop == Stop::Free;
        let theta_rate = if free { states[THETA_RATE] } else { 0.0 };
        let torques = self.torques(states, stage, states[RELATIVE]);
        let net = torques.friction + self.disturbance_nm(states, stage)
            - self.momentum(stage.time_s) * theta_rate
            - torques.motor;
        let mut slope = [0.0; STATES];
        slope[PHI] = states[PHI_RATE];
        slope[RELATIVE] = stage.row.rate_radps - states[PHI_RATE];
        let inertia = config.servo.gimbal_inertia_kg_m2;
        if let Some(part) = self.truth.appendage {
            let own = part.share * inertia;
            let deflection = states[DEFLECTION];
            let stretched = deflection - deflection.clamp(-part.play_rad, part.play_rad);
            let damped = if part.play_rad == 0.0 || stretched != 0.0 { states[DEFLECTION_RATE] } else { 0.0 };
            let spring = own * part.frequency_radps * part.frequency_radps * stretched
                + 2.0 * part.damping * own * part.frequency_radps * damped;
            slope[PHI_RATE] = (net + spring) / (inertia - own);
            slope[DEFLECTION] = states[DEFLECTION_RATE];
            slope[DEFLECTION_RATE] = -spring / own - slope[PHI_RATE];
        } else {
            slope[PHI_RATE] = net / inertia;
        }
        if free {
            slope[THETA] = theta_rate;
            slope[THETA_RATE] = (self.float_torque_nm(states, stage) - config.gyro.damping_nm_s_per_rad * theta_rate)
                / config.gyro.float_inertia_kg_m2;
        }
        self.servo_slope(states, theta_rate, offset_s, &mut slope);
        if let Some([_, full_nm, time_s]) = self.truth.drive.heating {
            let load = torques.motor / full_nm;
            slope[HEAT] = (load * load - states[HEAT]) / time_s;
        }
        if let Some([_, time_s]) = self.truth.torque.creep {
            slope[CREEP] = (states[RELATIVE] - states[CREEP]) / time_s;
        }
        if self.truth.torque.snap.is_some() {
            slope[SNAP] = (self.memory.side - states[SNAP]) / SNAP_TIME_S;
        }
        slope[VELOCITY] = stage.row.accel_mps2[1] * states[PHI];
        slope[VELOCITY + 1] = -stage.row.accel_mps2[0] * states[PHI];
        slope
    }

    fn servo_slope(&self, states: &States, theta_rate: f64, offset_s: f64, slope: &mut States) {
        let servo = Self::servo(states);
        let seen = self.seen(states[THETA]);
        let servo_slope = self.compensator.slope(&servo, seen);
        slope[SERVO..SERVO + ORDER].copy_from_slice(&servo_slope);
        let mut command = self.compensator.output_nm(&servo, seen);
        if self.truth.drive.delay_s > 0.0 {
            let rate = self.compensator.output_nm(&servo_slope, theta_rate);
            command = self.delayed(command, rate, offset_s);
        }
        if let Some(frozen) = self.frozen_nm {
            command = frozen;
        }
        slope[LAG] = (command - states[LAG]) / self.truth.config.servo.motor_lag_s;
    }
}
