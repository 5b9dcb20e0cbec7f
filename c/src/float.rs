//! The axis in `f32`, for cores with an FPU.

use crate::changed;
use crate::config::GimbalConfig;
use crate::message;
use crate::signals::{GimbalInputF32, GimbalOutputF32};
use crate::storage;
use core::ffi::c_char;
use gimbal_servo::{Law, State};

/// A law: built once, never changed.
#[repr(C, align(16))]
#[derive(Debug)]
pub struct GimbalLawF32 {
    storage: [u8; crate::GIMBAL_LAW_BYTES],
}

/// A state: plain memory, which may be copied.
#[repr(C, align(16))]
#[derive(Debug)]
pub struct GimbalStateF32 {
    storage: [u8; crate::GIMBAL_STATE_BYTES],
}

storage!(GimbalLawF32, Law<f32>);
storage!(GimbalStateF32, State<f32>);
changed!(GimbalStateF32, State<f32>);

/// Builds a law, once: in double precision, with some kilobytes of stack. False: it cannot be built, and `message`
/// says why, in at most `message_bytes` with the closing zero.
///
/// # Safety
/// `message` must be writable for `message_bytes`; it may be null when that is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gimbal_f32_build(
    config: &GimbalConfig,
    law: &mut GimbalLawF32,
    message: *mut c_char,
    message_bytes: usize,
) -> bool {
    match config.config().build::<f32>() {
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
pub extern "C" fn gimbal_f32_start(law: &GimbalLawF32, state: &mut GimbalStateF32) {
    state.put(law.inner().start());
}

/// Takes the row of this instant and gives the axis at it. Once each period; bounded in time, no allocation, no lock.
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_f32_step(
    law: &GimbalLawF32,
    state: &mut GimbalStateF32,
    input: &GimbalInputF32,
    output: &mut GimbalOutputF32,
) {
    *output = GimbalOutputF32::of(&law.inner().step(state.inner_mut(), input.input()));
}

/// Velocity error so far, along x and y [m/s].
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_f32_velocity_error_mps(
    law: &GimbalLawF32,
    state: &GimbalStateF32,
    velocity_error_mps: &mut [f64; 2],
) {
    *velocity_error_mps = law.inner().velocity_error_mps(state.inner());
}

/// Position error so far, along x and y [m].
#[unsafe(no_mangle)]
pub extern "C" fn gimbal_f32_position_error_m(
    law: &GimbalLawF32,
    state: &GimbalStateF32,
    position_error_m: &mut [f64; 2],
) {
    *position_error_m = law.inner().position_error_m(state.inner());
}
