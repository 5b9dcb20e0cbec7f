//! The equations of motion.
//!
//! ```text
//! gimbal   Jg phi''   = T_d - H theta' - T_m                                                             (1)
//! gyro     Jo theta'' = H (phi' + theta w_x) - Bo theta'      on a stop theta' = theta'' = 0             (2)
//! INS      V' = (a_y phi, -a_x phi)      P' = V                                                          (7)
//! T_d = T_f + T_u + T_external           T_u = u_x a_y - u_y a_x           w_rel = vehicle rate - phi'
//! ```
//!
//! `w_x` acts only with `gyro.cross_coupling`.

use gimbal_servo::Config;

use crate::bearing::Bearings;
use crate::friction::{self, Zones};
use crate::row::{Interval, Row};
use crate::runge_kutta::Field;
use crate::servo::Cascade;
use crate::state::{Mode, Stop};
use crate::vector::{INTEGRATOR, N, PHI, PHI_RATE, POSITION, RELATIVE, THETA, THETA_RATE, TORQUE, VELOCITY, Vector};

/// Least phi that the step size resolves [rad], a ten-thousandth of the least peak that accuracy is promised for.
const LEAST_ANGLE_RAD: f64 = 1e-7;
/// Least torque that the step size resolves [N m].
const LEAST_TORQUE_NM: f64 = 1e-6;
/// Rate of the loop, which turns the least angle into a least rate [rad/s].
const LOOP_RATE_RADPS: f64 = 500.0;

/// Everything about the plant that does not change.
#[derive(Debug, Clone)]
pub(crate) struct System {
    pub(crate) config: Config,
    pub(crate) bearings: Bearings,
    pub(crate) zones: Zones,
    cascade: Cascade,
}

/// The system in one mode, under the inputs of one interval: smooth.
pub(crate) struct Motion<'a> {
    pub(crate) system: &'a System,
    pub(crate) interval: &'a Interval,
    pub(crate) mode: Mode,
}

impl System {
    pub(crate) fn new(config: &Config) -> Self {
        let bearings = Bearings::new(&config.bearing);
        let zones = Zones::new(&bearings, false);
        Self { config: *config, bearings, zones, cascade: Cascade::new(&config.servo) }
    }

    /// Least size of each quantity that the step size resolves.
    pub(crate) fn floor(&self) -> Vector {
        let theta = LEAST_ANGLE_RAD * self.config.gyro.low_frequency_gain();
        let mut floor = [LEAST_ANGLE_RAD; N];
        floor[PHI_RATE] = LOOP_RATE_RADPS * LEAST_ANGLE_RAD;
        floor[THETA] = theta;
        floor[THETA_RATE] = LOOP_RATE_RADPS * theta;
        self.cascade.floor(theta, LEAST_TORQUE_NM, &mut floor);
        floor
    }

    /// The state that stands still under a row: the integrator of F carries the disturbance.
    pub(crate) fn settled(&self, row: &Row) -> Vector {
        let mut y = [0.0; N];
        let zone = self.zones.find(row.vehicle_rate_radps);
        let torque = self.friction_nm(zone, row, &y) + self.unbalance_nm(row) + row.torque_nm;
        y[INTEGRATOR] = torque;
        y[TORQUE] = torque;
        y
    }

    /// `w_rel` [rad/s].
    pub(crate) fn relative_rate_radps(row: &Row, y: &Vector) -> f64 {
        row.vehicle_rate_radps - y[PHI_RATE]
    }

    /// `T_f` [N m].
    pub(crate) fn friction_nm(&self, zone: usize, row: &Row, y: &Vector) -> f64 {
        if !self.bearings.present() {
            return 0.0;
        }
        friction::torque_nm(&self.bearings, self.zones.at(zone), row, Self::relative_rate_radps(row, y))
    }

    /// `T_u` [N m].
    pub(crate) fn unbalance_nm(&self, row: &Row) -> f64 {
        let unbalance = &self.config.unbalance;
        unbalance.x_kg_m * row.accel_y_mps2 - unbalance.y_kg_m * row.accel_x_mps2
    }

    /// Torque on the float but for its damping [N m].
    pub(crate) fn float_nm(&self, row: &Row, y: &Vector) -> f64 {
        let gyro = &self.config.gyro;
        let spin = if gyro.cross_coupling { row.spin_rate_radps } else { 0.0 };
        gyro.angular_momentum_nm_s * (y[PHI_RATE] + y[THETA] * spin)
    }

    /// The slope of every quantity.
    fn slope(&self, row: &Row, mode: &Mode, y: &Vector) -> Vector {
        let mut rate = [0.0; N];
        let gyro = &self.config.gyro;
        self.cascade.rate(y[THETA], y, &mut rate);
        let disturbance = self.friction_nm(mode.zone, row, y) + self.unbalance_nm(row) + row.torque_nm;
        let net = disturbance - gyro.angular_momentum_nm_s * y[THETA_RATE] - y[TORQUE];
        rate[PHI] = y[PHI_RATE];
        rate[PHI_RATE] = net / self.config.servo.gimbal_inertia_kg_m2;
        if mode.stop == Stop::Free {
            let float = self.float_nm(row, y) - gyro.damping_nm_s_per_rad * y[THETA_RATE];
            rate[THETA] = y[THETA_RATE];
            rate[THETA_RATE] = float / gyro.float_inertia_kg_m2;
        }
        rate[RELATIVE] = Self::relative_rate_radps(row, y);
        rate[VELOCITY] = row.accel_y_mps2 * y[PHI];
        rate[VELOCITY + 1] = -row.accel_x_mps2 * y[PHI];
        rate[POSITION] = y[VELOCITY];
        rate[POSITION + 1] = y[VELOCITY + 1];
        rate
    }
}

impl Field for Motion<'_> {
    fn rate(&self, tau_s: f64, y: &Vector) -> Vector {
        self.system.slope(&self.interval.at(tau_s), &self.mode, y)
    }
}
