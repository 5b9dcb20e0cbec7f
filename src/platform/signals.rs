//! What goes into a platform's step and what comes out.

use crate::faults::Faults;
use crate::{estimator, signals};

/// One row of input, point samples at one instant; vectors in the order x, y, z.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Input<N> {
    /// Specific force, in the axes of the stable member [m/s2].
    pub accel_mps2: [N; 3],
    /// The vehicle's rate, in axes of the vehicle that are the stable member's at gimbal angles of zero [rad/s].
    pub vehicle_rate_radps: [N; 3],
    /// Angle of the gimbal about each axis against the one that carries it, right-handed, within a half turn [rad].
    pub gimbal_angle_rad: [N; 3],
    /// External torque on the gimbal about each axis [N m].
    pub torque_nm: [N; 3],
}

/// The platform at the instant of the row just given; vectors in the stable member's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output<N> {
    /// phi [rad].
    pub attitude_error_rad: [N; 3],
    /// Each loop, by its axis.
    pub axes: [signals::Output<N>; 3],
    /// Fault bits of all axes and of the gimbal angles.
    pub faults: Faults,
    /// The middle gimbal stands within 6 deg of a right angle, where the outer and the inner axis fall together.
    pub gimbal_lock: bool,
}

/// What is known of the platform at this row; vectors in the stable member's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate<N> {
    /// phi [rad].
    pub attitude_error_rad: [N; 3],
    /// Its uncertainty, 1 sigma [rad].
    pub bound_rad: [N; 3],
    /// Each loop, by its axis.
    pub axes: [estimator::Estimate<N>; 3],
    /// Flags of all axes.
    pub flags: estimator::Flags,
}
