//! What the programs share: the board, the entry point, the instruction counter.
//!
//! The programs run on boards without an operating system; on the host each has an empty `main`, so that one workspace
//! and one lock file serve both.

#![no_std]

/// The board that this program was built for: constants from its file in `boards/`.
pub mod board {
    include!(concat!(env!("OUT_DIR"), "/board.rs"));
}

pub mod cases;
pub mod corrected;
#[cfg(target_os = "none")]
pub mod counter;
pub mod effects;
#[cfg(target_os = "none")]
#[doc(hidden)]
pub mod entry;
pub mod estimates;
#[cfg(target_os = "none")]
pub mod frames;
#[cfg(target_os = "none")]
pub mod log;
pub mod minute;
pub mod noise;
pub mod onboard;
pub mod profile;

/// The number system that the core is good at.
#[cfg(all(target_os = "none", target_abi = "eabihf"))]
pub type Native = f32;
/// The number system that the core is good at.
#[cfg(all(target_os = "none", not(target_abi = "eabihf")))]
pub type Native = gimbal_servo::Fixed;

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod listen;
#[cfg(all(target_os = "none", target_arch = "arm"))]
pub use listen::listen;

/// Makes `run` the program on Cortex-M; elsewhere it says so, and on the host there is nothing.
#[macro_export]
macro_rules! arm_program {
    ($run:path, $name:literal) => {
        #[cfg(not(target_os = "none"))]
        fn main() {}

        #[cfg(all(target_os = "none", target_arch = "arm"))]
        $crate::program!($run);

        #[cfg(all(target_os = "none", not(target_arch = "arm")))]
        $crate::program!(elsewhere);

        #[cfg(all(target_os = "none", not(target_arch = "arm")))]
        fn elsewhere() -> Result<(), &'static str> {
            Err(concat!($name, " runs on Cortex-M alone"))
        }
    };
}

/// A panic handler that stops: for images that are examined and not run.
#[macro_export]
macro_rules! stop_at_panic {
    () => {
        #[panic_handler]
        fn panic(_: &core::panic::PanicInfo) -> ! {
            loop {
                core::hint::spin_loop();
            }
        }
    };
}

/// A `main` that does nothing, likewise.
#[macro_export]
macro_rules! idle_program {
    () => {
        #[$crate::start]
        fn main() -> ! {
            loop {
                core::hint::spin_loop();
            }
        }
    };
}

/// Standard output and exit status by semihosting.
#[cfg(target_os = "none")]
pub use semihosting;

#[cfg(all(target_os = "none", target_arch = "arm"))]
pub use cortex_m_rt::entry as start;
#[cfg(all(target_os = "none", target_arch = "riscv32"))]
pub use riscv_rt::entry as start;
