//! What goes into a step and what comes out.

use crate::faults::Faults;

/// One row of input, point samples at one instant.
///
/// With `N = f32` the values are SI; with [`Fixed`](crate::Fixed) they are fractions of the full scales in
/// [`Units`](crate::Units).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Input<N> {
    /// Specific force along x [m/s2].
    pub accel_x_mps2: N,
    /// Specific force along y [m/s2].
    pub accel_y_mps2: N,
    /// Specific force along the gimbal axis z [m/s2].
    pub accel_z_mps2: N,
    /// Vehicle rate about the gimbal axis [rad/s].
    pub vehicle_rate_radps: N,
    /// External disturbance torque on the gimbal, beside friction and unbalance [N m].
    pub torque_nm: N,
    /// The stable member's own inertial rate about the gyro's spin axis [rad/s]; used with `cross_coupling` alone.
    pub spin_rate_radps: N,
}

/// Where the gyro's float is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Stop {
    /// Between its stops.
    #[default]
    Free,
    /// On the positive stop.
    Positive,
    /// On the negative stop.
    Negative,
}

/// State of the axis at the instant of the row just given.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Output<N> {
    /// phi, the stable member's attitude error [rad].
    pub gimbal_angle_rad: N,
    /// phi' [rad/s].
    pub gimbal_rate_radps: N,
    /// theta, the gyro's output angle [rad].
    pub gyro_angle_rad: N,
    /// `T_m` [N m].
    pub motor_torque_nm: N,
    /// Friction torque on the gimbal at this instant [N m]; along the bearing's relative rate.
    pub friction_torque_nm: N,
    /// Torque of the mass unbalance at this instant [N m].
    pub unbalance_torque_nm: N,
    /// Mean of all disturbance torques over the period just past [N m].
    pub disturbance_torque_nm: N,
    /// The bearing's relative rate: vehicle rate less phi' [rad/s].
    pub relative_rate_radps: N,
    /// Where the float is.
    pub stop: Stop,
    /// How long ago, in periods, the float met or left a stop within the period just past; 0 if it did not.
    pub stop_change_age: N,
    /// Fault bits of this step.
    pub faults: Faults,
}
