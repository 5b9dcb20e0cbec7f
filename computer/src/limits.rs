//! Limits of the computer. They are compiled in: no frame can raise them.

use gimbal_servo::Range;
use gimbal_servo::paper::{DEGREE_RAD, STANDARD_GRAVITY_MPS2};

/// Ticks without a new sensor frame after which the output goes to its safe value.
pub const WATCHDOG_TICKS: u16 = 20;
/// New sensor frames in a row that end the safe output.
pub const RECOVERY_FRAMES: u16 = 5;
/// Age from which on a sensor frame counts as none [ticks].
pub const OLDEST_FRAME_TICKS: u32 = 5;
/// Frames that are looked at within a tick while it runs; the others are ignored and counted.
pub const FRAMES_A_TICK: u16 = 8;
/// Largest attitude correction that is let out [rad]: that of the model's small angles.
pub const CORRECTION_RAD: f32 = 0.1;
/// The attitude's uncertainty that goes with the safe output [rad].
pub const SAFE_BOUND_RAD: f32 = 1.0;
/// Ticks from one telemetry frame to the next.
pub const TELEMETRY_TICKS: u32 = 10;

/// Largest ranges that a model may be built for.
#[must_use]
pub fn range() -> Range {
    Range {
        radial_accel_mps2: 50.0 * STANDARD_GRAVITY_MPS2,
        axial_accel_mps2: 50.0 * STANDARD_GRAVITY_MPS2,
        rate_radps: 3_000.0 * DEGREE_RAD,
        torque_nm: 0.1,
    }
}

/// Whether a range lies within what the computer allows.
#[must_use]
pub fn allow(wanted: &Range) -> bool {
    let most = range();
    wanted.radial_accel_mps2 <= most.radial_accel_mps2
        && wanted.axial_accel_mps2 <= most.axial_accel_mps2
        && wanted.rate_radps <= most.rate_radps
        && wanted.torque_nm <= most.torque_nm
}
