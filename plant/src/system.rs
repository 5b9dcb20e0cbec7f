//! The equations of motion.
//!
//! ```text
//! gimbal   Jg phi''   = T_d - H theta' - T_m                                                             (1)
//! gyro     Jo theta'' = H (phi' + theta w_x) - Bo theta'      on a stop theta' = theta'' = 0             (2)
//! INS      V' = (a_y phi, -a_x phi)      P' = V                                                          (7)
//! T_d = T_f + T_u + T_external           T_u = u_x a_y - u_y a_x           w_rel = vehicle rate - phi'
//! ```
//!
//! `w_x` acts only with `gyro.cross_coupling`. Effects add their torques where their files say.

use gimbal_servo::Config;

use crate::bearing::Bearings;
use crate::effects::loop_delay::{History, Past};
use crate::effects::motor::Stretch;
use crate::effects::{Altered, Laws, pickoff_quantisation};
use crate::friction::{self, Zones};
use crate::row::{Interval, Row};
use crate::runge_kutta::Field;
use crate::servo::Cascade;
use crate::state::{Mode, Stop};
use crate::vector::{
    APPENDAGE, APPENDAGE_RATE, HYSTERESIS, INTEGRATOR, N, PHI, PHI_RATE, POSITION, RELATIVE, THETA, THETA_RATE, TORQUE,
    VELOCITY, Vector,
};

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
    pub(crate) laws: Laws,
    pub(crate) bearings: Bearings,
    pub(crate) zones: Zones,
    pub(crate) stretches: Vec<Stretch>,
    cascade: Cascade,
}

/// What acts at one instant beside the integrated quantities.
pub(crate) struct Moment<'a> {
    pub(crate) row: &'a Row,
    pub(crate) time_s: f64,
    pub(crate) mode: &'a Mode,
    /// Motor torque behind lag and delay, before clamp and dead zone [N m].
    pub(crate) command_nm: f64,
}

/// The system in one mode, under the inputs of one interval: smooth.
pub(crate) struct Motion<'a> {
    pub(crate) system: &'a System,
    pub(crate) interval: &'a Interval,
    pub(crate) mode: Mode,
    /// Time at the start of the interval [s].
    pub(crate) start_s: f64,
    pub(crate) past: Option<&'a History>,
}

impl Moment<'_> {
    /// `w_rel` [rad/s].
    pub(crate) fn relative_rate_radps(&self, y: &Vector) -> f64 {
        self.row.vehicle_rate_radps - y[PHI_RATE]
    }
}

impl System {
    pub(crate) fn new(altered: &Altered) -> Self {
        let (config, laws) = (altered.config, altered.laws);
        let bearings = Bearings::new(&config.bearing);
        let zones = Zones::new(&bearings, laws.corner_at_rest());
        Self { config, laws, bearings, zones, stretches: laws.motor.stretches(), cascade: Cascade::new(&config.servo) }
    }

    /// Least size of each quantity that the step size resolves.
    pub(crate) fn floor(&self) -> Vector {
        let theta = LEAST_ANGLE_RAD * self.config.gyro.low_frequency_gain();
        let mut floor = [LEAST_ANGLE_RAD; N];
        floor[PHI_RATE] = LOOP_RATE_RADPS * LEAST_ANGLE_RAD;
        floor[THETA] = theta;
        floor[THETA_RATE] = LOOP_RATE_RADPS * theta;
        floor[APPENDAGE_RATE] = LOOP_RATE_RADPS * LEAST_ANGLE_RAD;
        floor[HYSTERESIS] = 1e-3;
        self.cascade.floor(theta, LEAST_TORQUE_NM, &mut floor);
        floor
    }

    /// The state that stands still under a row: the integrator of F carries the disturbance, and phi drifts as
    /// far as a torque on the float makes it.
    pub(crate) fn settled(&self, row: &Row) -> (Vector, Mode) {
        let mut y = [0.0; N];
        y[PHI_RATE] = -self.laws.float.torque_nm(row) / self.config.gyro.angular_momentum_nm_s;
        y[APPENDAGE_RATE] = y[PHI_RATE];
        let mut mode = Mode { zone: self.zones.find(row.vehicle_rate_radps - y[PHI_RATE]), ..Mode::default() };
        mode.reversal.ratio = self.zones.at(mode.zone).sign;
        let moment = Moment { row, time_s: 0.0, mode: &mode, command_nm: 0.0 };
        let command = self.laws.motor.command_nm(self.disturbance_nm(&moment, &y));
        y[INTEGRATOR] = command;
        y[TORQUE] = command;
        (y, mode)
    }

    /// `T_f` [N m].
    pub(crate) fn friction_nm(&self, moment: &Moment, y: &Vector) -> f64 {
        friction::torque_nm(&self.bearings, &self.laws, self.zones.at(moment.mode.zone), moment, y)
    }

    /// `T_u` [N m].
    pub(crate) fn unbalance_nm(&self, row: &Row) -> f64 {
        let unbalance = &self.config.unbalance;
        unbalance.x_kg_m * row.accel_y_mps2 - unbalance.y_kg_m * row.accel_x_mps2
    }

    /// `T_d` [N m].
    fn disturbance_nm(&self, moment: &Moment, y: &Vector) -> f64 {
        let laws = &self.laws;
        let row = moment.row;
        let mut torque = self.friction_nm(moment, y) + self.unbalance_nm(row) + row.torque_nm;
        torque += laws.input_torque_nm(row) + laws.spring.stiffness_nm_per_rad * y[RELATIVE];
        if let Some(hysteresis) = laws.hysteresis {
            torque += hysteresis.torque_nm * y[HYSTERESIS];
        }
        if let Some(ripple) = laws.ripple {
            torque += ripple.torque_nm(y[RELATIVE]);
        }
        torque
    }

    /// Torque on the float but for its damping [N m].
    pub(crate) fn float_nm(&self, row: &Row, y: &Vector) -> f64 {
        let gyro = &self.config.gyro;
        let spin = if gyro.cross_coupling { row.spin_rate_radps } else { 0.0 };
        gyro.angular_momentum_nm_s * (y[PHI_RATE] + y[THETA] * spin) + self.laws.float.torque_nm(row)
    }

    /// Motor torque behind lag and delay [N m].
    pub(crate) fn command_nm(&self, past: Option<&History>, time_s: f64, y: &Vector) -> f64 {
        match past {
            Some(past) if self.laws.delay_s > 0.0 => past.at(Past::Torque, time_s - self.laws.delay_s),
            _ => y[TORQUE],
        }
    }

    /// How much of the past the laws refer to [s].
    pub(crate) fn past_s(&self) -> f64 {
        self.laws.delay_s + (-self.laws.measurement.skew_s).max(0.0)
    }

    /// The slope of every quantity.
    fn slope(&self, moment: &Moment, y: &Vector) -> Vector {
        let mut rate = [0.0; N];
        let (row, mode, gyro) = (moment.row, moment.mode, &self.config.gyro);
        let seen = pickoff_quantisation::seen_rad(self.laws.pickoff_step_rad, mode.cell, y[THETA]);
        self.cascade.rate(seen, y, &mut rate);
        let motor = self.stretches[mode.stretch].torque_nm(moment.command_nm);
        let mut net = self.disturbance_nm(moment, y) - gyro.angular_momentum_nm_s * y[THETA_RATE] - motor;
        let mut inertia = self.config.servo.gimbal_inertia_kg_m2;
        if let Some(appendage) = self.laws.appendage {
            let twist = y[PHI] - y[APPENDAGE];
            let acceleration = appendage.acceleration(twist, y[PHI_RATE] - y[APPENDAGE_RATE]);
            rate[APPENDAGE] = y[APPENDAGE_RATE];
            rate[APPENDAGE_RATE] = acceleration;
            net -= appendage.ratio * inertia * acceleration;
            inertia *= 1.0 - appendage.ratio;
        }
        rate[PHI] = y[PHI_RATE];
        rate[PHI_RATE] = net / inertia;
        if mode.stop == Stop::Free {
            let float = self.float_nm(row, y) - gyro.damping_nm_s_per_rad * y[THETA_RATE];
            rate[THETA] = y[THETA_RATE];
            rate[THETA_RATE] = float / gyro.float_inertia_kg_m2;
        }
        rate[RELATIVE] = moment.relative_rate_radps(y);
        if let Some(hysteresis) = self.laws.hysteresis {
            rate[HYSTERESIS] = hysteresis.rate(y[HYSTERESIS], self.zones.at(mode.zone).sign, rate[RELATIVE]);
        }
        rate[VELOCITY] = row.accel_y_mps2 * y[PHI];
        rate[VELOCITY + 1] = -row.accel_x_mps2 * y[PHI];
        rate[POSITION] = y[VELOCITY];
        rate[POSITION + 1] = y[VELOCITY + 1];
        rate
    }
}

impl Motion<'_> {
    /// Hands a moment of this motion to a function of it.
    pub(crate) fn at<R>(&self, tau_s: f64, y: &Vector, function: impl FnOnce(&Moment) -> R) -> R {
        let time_s = self.start_s + tau_s;
        let command_nm = self.system.command_nm(self.past, time_s, y);
        function(&Moment { row: &self.interval.at(tau_s), time_s, mode: &self.mode, command_nm })
    }
}

impl Field for Motion<'_> {
    fn rate(&self, tau_s: f64, y: &Vector) -> Vector {
        self.at(tau_s, y, |moment| self.system.slope(moment, y))
    }
}
