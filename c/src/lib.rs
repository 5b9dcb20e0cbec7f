//! The model for firmware in C: one axis, in `f32` and in fixed point.
//!
//! The caller owns all memory; nothing is allocated. Build a law once, start a state, step it once each period. The bits
//! are those of the Rust library. Every pointer must be valid and not null; a law must have been built and a state
//! started before it is passed on.

// The interface is raw memory of the caller's: its validity is the caller's promise.
#![allow(unsafe_code)]
#![cfg_attr(target_os = "none", no_std)]

mod config;
mod fixed;
mod float;
mod message;
mod signals;

pub use config::{GimbalConfig, gimbal_config_as_printed, gimbal_config_consistent};
pub use fixed::{
    GimbalLawFixed, GimbalStateFixed, gimbal_fixed_build, gimbal_fixed_input, gimbal_fixed_output,
    gimbal_fixed_position_error_m, gimbal_fixed_start, gimbal_fixed_step, gimbal_fixed_velocity_error_mps,
};
pub use float::{
    GimbalLawF32, GimbalStateF32, gimbal_f32_build, gimbal_f32_position_error_m, gimbal_f32_start, gimbal_f32_step,
    gimbal_f32_velocity_error_mps,
};
pub use signals::{GimbalInputF32, GimbalInputFixed, GimbalOutputF32, GimbalOutputFixed};

/// Bytes that hold a law.
pub const GIMBAL_LAW_BYTES: usize = 6144;
/// Bytes that hold a state.
pub const GIMBAL_STATE_BYTES: usize = 512;

/// What a panic does where there is no operating system: the step has none; `build` stops here instead of going on.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {
        core::hint::spin_loop();
    }
}

/// Memory of the caller's as what lies in it.
macro_rules! storage {
    ($name:ident, $inner:ty) => {
        const _: () = assert!(size_of::<$inner>() <= size_of::<$name>() && align_of::<$inner>() <= align_of::<$name>());

        impl $name {
            fn inner(&self) -> &$inner {
                // SAFETY: large enough, aligned, and written by `put` before, as the caller promises.
                unsafe { &*core::ptr::from_ref(self).cast() }
            }

            fn put(&mut self, inner: $inner) {
                // SAFETY: large enough and aligned; what was there before needs no drop.
                unsafe { core::ptr::from_mut(self).cast::<$inner>().write(inner) };
            }
        }
    };
}
use storage;

/// The same for what is changed in place, which a law is not.
macro_rules! changed {
    ($name:ident, $inner:ty) => {
        impl $name {
            fn inner_mut(&mut self) -> &mut $inner {
                // SAFETY: large enough, aligned, and written by `put` before, as the caller promises.
                unsafe { &mut *core::ptr::from_mut(self).cast() }
            }
        }
    };
}
use changed;
