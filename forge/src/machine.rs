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

mod command;
mod loads;
mod slope;
mod step;
mod torques;

pub(crate) use loads::Loads;

use crate::compensator::{Compensator, ORDER};
use crate::memory::Memory;
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
    pickoff_noise_rad: f64,
    time_s: f64,
    since_commit_s: f64,
}

/// Torques at one instant.
#[derive(Debug, Clone, Copy)]
struct Torques {
    friction: f64,
    motor: f64,
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

    /// Adds to the torque that the servo's integrator holds.
    pub fn hold(&mut self, torque_nm: f64) {
        self.states[SERVO] += self.compensator.held(torque_nm);
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
        let pickoff_noise_rad = self.pickoff_noise_rad(self.row);
        let stage = Stage {
            row,
            load_nm: self.palmgren.load_nm(row.accel_mps2),
            pickoff_noise_rad,
            time_s: self.start_s + self.row as f64 * self.track.period_s,
            since_commit_s: 0.0,
        };
        let torques = self.torques(&self.states, &stage, self.states[RELATIVE]);
        Sample {
            gimbal_angle_rad: self.states[PHI],
            gyro_angle_rad: self.seen(self.states[THETA] + pickoff_noise_rad),
            motor_torque_nm: torques.motor,
            relative_angle_rad: self.states[RELATIVE],
            friction_nm: torques.friction,
            velocity_error_mps: [self.states[VELOCITY], self.states[VELOCITY + 1]],
            on_stop: self.stop != Stop::Free,
        }
    }

    fn pickoff_noise_rad(&self, row: usize) -> f64 {
        self.truth.drive.noise_rad.get(row).copied().unwrap_or(0.0)
    }

    fn seen(&self, angle_rad: f64) -> f64 {
        self.truth.drive.step_rad.map_or(angle_rad, |step| libm::round(angle_rad / step) * step)
    }

    fn servo(states: &States) -> [f64; ORDER] {
        core::array::from_fn(|index| states[SERVO + index])
    }
}
