//! The integrated quantities, by name.

/// Number of integrated quantities.
pub(crate) const N: usize = 18;

/// All integrated quantities.
pub(crate) type Vector = [f64; N];

/// phi [rad].
pub(crate) const PHI: usize = 0;
/// phi' [rad/s].
pub(crate) const PHI_RATE: usize = 1;
/// theta [rad].
pub(crate) const THETA: usize = 2;
/// theta' [rad/s].
pub(crate) const THETA_RATE: usize = 3;
/// Lag states of the four sections `(1 + Ti s) / (1 + Tj s)` of F [N m/s].
pub(crate) const SECTION: usize = 4;
/// The integrator of F [N m].
pub(crate) const INTEGRATOR: usize = 8;
/// Motor torque behind the lag [N m].
pub(crate) const TORQUE: usize = 9;
/// Angle of the appendage of the flexible mode [rad].
pub(crate) const APPENDAGE: usize = 10;
/// Its rate [rad/s].
pub(crate) const APPENDAGE_RATE: usize = 11;
/// Cable hysteresis, share of its largest torque.
pub(crate) const HYSTERESIS: usize = 12;
/// The states that steer the step size; those that follow are integrals of them.
pub(crate) const CONTROLLED: usize = 13;
/// rel, integral of `w_rel`: vehicle against stable member [rad].
pub(crate) const RELATIVE: usize = 13;
/// Velocity error along x, then y [m/s].
pub(crate) const VELOCITY: usize = 14;
/// Position error along x, then y [m].
pub(crate) const POSITION: usize = 16;
