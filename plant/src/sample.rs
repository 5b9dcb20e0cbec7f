//! What the plant gives at each row.

use crate::row::Row;
use crate::state::Stop;

/// The plant at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since the first row [s].
    pub time_s: f64,
    /// phi, which is the platform's attitude error [rad].
    pub gimbal_angle_rad: f64,
    /// phi' [rad/s].
    pub gimbal_rate_radps: f64,
    /// theta [rad].
    pub gyro_angle_rad: f64,
    /// theta' [rad/s].
    pub gyro_rate_radps: f64,
    /// rel, vehicle against stable member since the first row [rad].
    pub relative_angle_rad: f64,
    /// `T_m`, as it acts on the gimbal [N m].
    pub motor_torque_nm: f64,
    /// `T_f`, bearing friction on the gimbal [N m].
    pub friction_torque_nm: f64,
    /// `T_u`, mass unbalance [N m].
    pub unbalance_torque_nm: f64,
    /// Where the float is.
    pub stop: Stop,
    /// INS velocity error along x and y [m/s].
    pub velocity_error_mps: [f64; 2],
    /// INS position error along x and y [m].
    pub position_error_m: [f64; 2],
    /// What the sensors make of it.
    pub logged: Logged,
}

/// The row of a log: what the sensors give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Logged {
    /// Pick-off angle, which is theta but for its sensor [rad].
    pub gyro_angle_rad: f64,
    /// Motor torque, which is `T_m` but for its sensor [N m].
    pub motor_torque_nm: f64,
    /// The inputs.
    pub inputs: Row,
}
