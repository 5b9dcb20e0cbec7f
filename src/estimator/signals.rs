//! What goes into the estimator at a row, and what comes out.

use super::flags::Flags;

/// What the sensors of the axis read at this row; `None` where there is no reading.
///
/// In the full scales that [`super::Law::measured`] gives. A reading that is not finite counts as none.
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
