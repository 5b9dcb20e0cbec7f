//! Holds the instruction counter to sequences of known length; fails when one count is off by one.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
gimbal_firmware::program!(target::run);

#[cfg(target_os = "none")]
mod target {
    // Functions of known length are written in assembly.
    #![allow(unsafe_code)]

    use core::arch::naked_asm;
    use core::ptr::null_mut;
    use gimbal_firmware::{board, counter::Counter, semihosting::println};

    #[cfg(target_arch = "arm")]
    macro_rules! ret {
        () => {
            "bx lr"
        };
    }
    #[cfg(target_arch = "riscv32")]
    macro_rules! ret {
        () => {
            "ret"
        };
    }

    /// `$count` times one instruction that does nothing, and the return.
    macro_rules! straight {
        ($name:ident, $count:literal) => {
            #[unsafe(naked)]
            extern "C" fn $name(_: *mut ()) {
                naked_asm!(concat!(".rept ", $count), "nop", ".endr", ret!())
            }
        };
    }

    straight!(none, "0");
    straight!(one, "1");
    straight!(two, "2");
    straight!(hundred, "100");
    straight!(three_thousand, "3000");

    /// Two instructions to start, two for each of 1,000 turns, and the return.
    #[cfg(target_arch = "arm")]
    #[unsafe(naked)]
    extern "C" fn turns(_: *mut ()) {
        naked_asm!("movs r0, #250", "lsls r0, r0, #2", "2:", "subs r0, r0, #1", "bne 2b", "bx lr")
    }

    #[cfg(target_arch = "riscv32")]
    #[unsafe(naked)]
    extern "C" fn turns(_: *mut ()) {
        naked_asm!("li a0, 250", "slli a0, a0, 2", "2:", "addi a0, a0, -1", "bnez a0, 2b", "ret")
    }

    pub(crate) fn run() -> Result<(), &'static str> {
        let mut counter = Counter::start();
        let cases: [(extern "C" fn(*mut ()), u32); 6] =
            [(none, 1), (one, 2), (two, 3), (hundred, 101), (three_thousand, 3001), (turns, 2003)];
        let mut wrong = 0_u32;
        for (function, expected) in cases {
            // Repeated at odd distances, so that the reading falls on every fraction of a tick.
            for gap in 0..40_u32 {
                for _ in 0..gap {
                    core::hint::black_box(gap);
                }
                // SAFETY: the functions above use no argument.
                let counted = unsafe { counter.count_at(function as *const (), null_mut()) };
                if counted != expected {
                    wrong += 1;
                    println!("counted {counted} instructions where there are {expected}");
                }
            }
            println!("{} calibrate {expected} ok", board::NAME);
        }
        let mut closure_runs = 0_u32;
        if counter.count(|| closure_runs += 1) == 0 || closure_runs != 1 {
            return Err("a closure is not counted");
        }
        if wrong == 0 { Ok(()) } else { Err("the counter is off") }
    }
}
