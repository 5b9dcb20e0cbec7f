//! What sensors do to the truth: noise, and how they fail.

use gimbal_servo::estimator;
use serde::Deserialize;

/// White noise of the sensors, rms.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Noise {
    /// Pick-off [rad].
    pub gyro_angle_rad: f64,
    /// Step of the pick-off's quantisation [rad].
    pub gyro_step_rad: f64,
    /// Motor torque [N m].
    pub motor_torque_nm: f64,
    /// Specific force [m/s2].
    pub accel_mps2: f64,
    /// Rate [rad/s].
    pub rate_radps: f64,
}

impl Default for Noise {
    /// What the estimator's default sensors have.
    fn default() -> Self {
        let sensors = estimator::Sensors::default();
        Self {
            gyro_angle_rad: sensors.gyro_noise_rad,
            gyro_step_rad: sensors.gyro_step_rad,
            motor_torque_nm: sensors.motor_torque_noise_nm,
            accel_mps2: 0.01,
            rate_radps: 2e-4,
        }
    }
}

/// A signal of the sensor frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Signal {
    /// Specific force along x.
    AccelXMps2,
    /// Specific force along y.
    AccelYMps2,
    /// Specific force along z.
    AccelZMps2,
    /// Vehicle rate.
    VehicleRateRadps,
    /// theta.
    GyroAngleRad,
    /// Motor torque.
    MotorTorqueNm,
}

/// How a sensor fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SensorFaultKind {
    /// It repeats its last reading.
    Stuck,
    /// It gives none: theta and the motor torque are marked, the others are not a number.
    Missing,
    /// It gives a value that is not a number.
    NotANumber,
    /// `value` is added.
    Bias,
    /// `value` is added once in 100 ticks.
    Spikes,
    /// It reads no more than `value`.
    Limited,
}

/// A sensor that fails for some time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorFault {
    /// Which.
    pub signal: Signal,
    /// How.
    pub kind: SensorFaultKind,
    /// From [s].
    pub from_s: f64,
    /// To [s].
    pub to_s: f64,
    /// How much.
    #[serde(default)]
    pub value: f64,
}
