//! The axis in fixed point, for cores without an FPU.

use crate::changed;
use crate::config::GimbalConfig;
use crate::message;
use crate::signals::{GimbalInputF32, GimbalInputFixed, GimbalOutputF32, GimbalOutputFixed};
use crate::storage;
use core::ffi::c_char;
use gimbal_servo::{Fixed, Law, Number, State};

/// A law: built once, never changed.
#[repr(C, align(16))]
#[derive(Debug)]
pub struct GimbalLawFixed {
    storage: [u8; crate::GIMBAL_LAW_BYTES],
}

/// A state: plain memory, which may be copied.
#[repr(C, align(16))]
#[derive(Debug)]
pub struct GimbalStateFixed {
    storage: [u8; crate::GIMBAL_STATE_BYTES],
}

storage!(GimbalLawFixed, Law<Fixed>);
storage!(GimbalStateFixed, State<Fixed>);
changed!(GimbalStateFixed, State<Fixed>);

/// Builds a law, once: in double precision, with some kilobytes of stack. False: it cannot be built, and `message`
/// says why, in at most `message_bytes` with the closing zero.
///
/// # Safety
/// `message` must be writable for `message_bytes`; it may be null when that is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gimbal_fixed_build(
    config: &GimbalConfig,
    law: &mut GimbalLawFixed,
    message: *mut c_char,
    message_bytes: usize,
) -> bool {
    match config.config().build::<Fixed>() {
        Ok(built) => {
            law.put(built);
            true
        }
        Err(error) => {
            // SAFETY: the caller's promise.
            unsafe { message::write(&error, message, message_bytes) };
            false
        }
    }
}

/// The state at rest, before the first row.
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_fixed_start(law: &GimbalLawFixed, state: &mut GimbalStateFixed) {
    state.put(law.inner().start());
}

/// Takes the row of this instant and gives the axis at it. Once each period; bounded in time, no allocation, no lock.
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_fixed_step(
    law: &GimbalLawFixed,
    state: &mut GimbalStateFixed,
    input: &GimbalInputFixed,
    output: &mut GimbalOutputFixed,
) {
    *output = GimbalOutputFixed::of(&law.inner().step(state.inner_mut(), input.input()));
}

/// Velocity error so far, along x and y [m/s].
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_fixed_velocity_error_mps(
    law: &GimbalLawFixed,
    state: &GimbalStateFixed,
    velocity_error_mps: &mut [f64; 2],
) {
    *velocity_error_mps = law.inner().velocity_error_mps(state.inner());
}

/// Position error so far, along x and y [m].
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_fixed_position_error_m(
    law: &GimbalLawFixed,
    state: &GimbalStateFixed,
    position_error_m: &mut [f64; 2],
) {
    *position_error_m = law.inner().position_error_m(state.inner());
}

/// A row in SI as this law's fractions.
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_fixed_input(law: &GimbalLawFixed, si: &GimbalInputF32, input: &mut GimbalInputFixed) {
    *input = GimbalInputFixed::of(&law.inner().units().input(&si.si()));
}

/// This law's output in SI.
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_fixed_output(law: &GimbalLawFixed, output: &GimbalOutputFixed, si: &mut GimbalOutputF32) {
    let units = law.inner().units();
    #[allow(clippy::cast_possible_truncation, reason = "24 bits of the fraction's 31")]
    let value = |fraction: i32, exponent| Fixed::from_raw(fraction).to_f64(exponent) as f32;
    *si = GimbalOutputF32 {
        gimbal_angle_rad: value(output.gimbal_angle_rad, units.gimbal_angle),
        gimbal_rate_radps: value(output.gimbal_rate_radps, units.gimbal_rate),
        gyro_angle_rad: value(output.gyro_angle_rad, units.gyro_angle),
        motor_torque_nm: value(output.motor_torque_nm, units.motor_torque),
        friction_torque_nm: value(output.friction_torque_nm, units.torque),
        unbalance_torque_nm: value(output.unbalance_torque_nm, units.torque),
        disturbance_torque_nm: value(output.disturbance_torque_nm, units.torque),
        relative_rate_radps: value(output.relative_rate_radps, units.rate),
        stop_change_age: value(output.stop_change_age, 0),
        stop: output.stop,
        faults: output.faults,
    };
}
