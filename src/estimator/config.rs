//! What the estimator is told of the sensors and of how well the axis is known.

use super::filter::Filter;
use super::law::Law;
use crate::BuildError;
use crate::config::within;
use crate::number::Number;

/// How much more the disturbance wanders once it has jumped.
const QUICK: f64 = 5.0;

/// Sensors, tolerances and limits of one axis' estimator, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Config {
    /// The sensors.
    pub sensors: Sensors,
    /// How well the axis' parameters are known.
    pub tolerance: Tolerance,
    /// How far the disturbance torque wanders over one period, 1 sigma [N m]: sets the filter's bandwidth.
    pub disturbance_walk_nm: f64,
    /// How long ahead *saturation ahead* looks [s].
    pub horizon_s: f64,
    /// How long a missing sensor is bridged [s].
    pub bridge_s: f64,
    /// Widest bound that is of use, 1 sigma [rad].
    pub widest_bound_rad: f64,
}

/// The sensors that the estimator reads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensors {
    /// Noise of the pick-off, rms [rad].
    pub gyro_noise_rad: f64,
    /// Step of the pick-off's quantisation [rad].
    pub gyro_step_rad: f64,
    /// Largest angle that the pick-off shows [rad].
    pub gyro_range_rad: f64,
    /// Noise of the motor torque, rms [N m].
    pub motor_torque_noise_nm: f64,
    /// Whether the motor torque is measured; else it is had from theta by (3).
    pub motor_torque_measured: bool,
    /// Age of theta and of the motor torque when they are given [s].
    pub delay_s: f64,
    /// Equal readings in a row from which on a sensor counts as stuck; 0: never. For sensors without noise.
    pub stuck_rows: u32,
    /// Largest change of a specific force in one period that is no spike [m/s2].
    pub accel_jump_mps2: f64,
    /// Largest change of the rate in one period that is no spike [rad/s].
    pub rate_jump_radps: f64,
    /// Largest change of the motor torque in one period that is no spike [N m].
    pub torque_jump_nm: f64,
}

/// Relative standard uncertainty of each parameter that matters to the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Bo.
    pub damping: f64,
    /// Jo.
    pub float_inertia: f64,
    /// H.
    pub angular_momentum: f64,
    /// Jg.
    pub gimbal_inertia: f64,
    /// The stop angle.
    pub stop_angle: f64,
    /// Level of the modelled disturbance.
    pub friction_level: f64,
}

impl Default for Sensors {
    /// 2 urad rms, 16 bit over +-10 mrad, 1e-5 N m rms, no delay.
    fn default() -> Self {
        Self {
            gyro_noise_rad: 2e-6,
            gyro_step_rad: 20e-3 / 65_536.0,
            gyro_range_rad: 10e-3,
            motor_torque_noise_nm: 1e-5,
            motor_torque_measured: true,
            delay_s: 0.0,
            stuck_rows: 8,
            accel_jump_mps2: 5.0,
            rate_jump_radps: 0.05,
            torque_jump_nm: 5e-3,
        }
    }
}

impl Tolerance {
    /// Every parameter exact.
    pub const EXACT: Self = Self {
        damping: 0.0,
        float_inertia: 0.0,
        angular_momentum: 0.0,
        gimbal_inertia: 0.0,
        stop_angle: 0.0,
        friction_level: 0.0,
    };

    /// Every parameter known to `relative`, the friction level to 15 %.
    #[must_use]
    pub const fn with_default(relative: f64) -> Self {
        Self {
            damping: relative,
            float_inertia: relative,
            angular_momentum: relative,
            gimbal_inertia: relative,
            stop_angle: relative,
            friction_level: 0.15,
        }
    }
}

impl Default for Tolerance {
    /// 3 %, friction level 15 %.
    fn default() -> Self {
        Self::with_default(0.03)
    }
}

impl Default for Config {
    fn default() -> Self {
        Self {
            sensors: Sensors::default(),
            tolerance: Tolerance::default(),
            disturbance_walk_nm: 1.5e-4,
            horizon_s: 0.02,
            bridge_s: 0.05,
            widest_bound_rad: 5e-3,
        }
    }
}

impl Config {
    /// Checks every field by itself.
    ///
    /// # Errors
    /// The first field that is not finite or makes no sense.
    pub fn check(&self) -> Result<(), BuildError> {
        let sensors = &self.sensors;
        within("sensors.gyro_noise_rad", sensors.gyro_noise_rad, 1e-9, 1e-3)?;
        within("sensors.gyro_step_rad", sensors.gyro_step_rad, 0.0, 1e-3)?;
        within("sensors.gyro_range_rad", sensors.gyro_range_rad, 1e-4, 1.0)?;
        within("sensors.motor_torque_noise_nm", sensors.motor_torque_noise_nm, 0.0, 1e-2)?;
        within("sensors.delay_s", sensors.delay_s, 0.0, 5e-3)?;
        within("sensors.accel_jump_mps2", sensors.accel_jump_mps2, 1e-3, 1e4)?;
        within("sensors.rate_jump_radps", sensors.rate_jump_radps, 1e-4, 1e3)?;
        within("sensors.torque_jump_nm", sensors.torque_jump_nm, 1e-6, 10.0)?;
        let tolerance = &self.tolerance;
        within("tolerance.damping", tolerance.damping, 0.0, 0.5)?;
        within("tolerance.float_inertia", tolerance.float_inertia, 0.0, 0.5)?;
        within("tolerance.angular_momentum", tolerance.angular_momentum, 0.0, 0.5)?;
        within("tolerance.gimbal_inertia", tolerance.gimbal_inertia, 0.0, 0.5)?;
        within("tolerance.stop_angle", tolerance.stop_angle, 0.0, 0.5)?;
        within("tolerance.friction_level", tolerance.friction_level, 0.0, 1.0)?;
        within("disturbance_walk_nm", self.disturbance_walk_nm, 1e-7, 0.1)?;
        within("horizon_s", self.horizon_s, 0.0, 1.0)?;
        within("bridge_s", self.bridge_s, 0.0, 10.0)?;
        within("widest_bound_rad", self.widest_bound_rad, 1e-7, 1.0)
    }

    /// Builds the estimator's law for an axis.
    ///
    /// # Errors
    /// The first field that is wrong, of this configuration or of the axis'.
    pub fn build<N: Number>(&self, axis: &crate::Config) -> Result<Law<N>, BuildError> {
        self.check()?;
        let model = axis.build::<N>()?;
        let filter = Filter::new(self, axis, self.disturbance_walk_nm);
        // After a jump of the disturbance, a release or an outage.
        let quick = Filter::new(self, axis, QUICK * self.disturbance_walk_nm);
        Ok(Law::build(self, axis, model.units(), &filter, &quick))
    }
}
