//! Counts the instructions of a function, exactly and repeatably, under `qemu -icount shift=10`.
//!
//! There every instruction takes 1,024 ns of virtual time, and a counter that runs in virtual time counts instructions:
//! SysTick at 25 MHz 25.6 ticks each, which is why a difference of two readings, divided and rounded, is exact.
//! On silicon the same readings are time.
//!
//! The function is called from assembly between the two readings, so that the compiler can move nothing across them;
//! what is counted is its every instruction up to and with the return. What the harness adds is known by construction
//! and held true by the program `calibrate`.

// The readings must be adjacent to the call, and the counter is a register: neither can be said in safe Rust.
#![allow(unsafe_code)]

use crate::board::COUNTER_HZ;

/// Virtual time of one instruction under `-icount shift=10` [ns].
const INSTRUCTION_NS: u64 = 1 << 10;

/// Instructions from one reading to the next besides those of the function: the call, and one of the readings.
const HARNESS_INSTRUCTIONS: u32 = 2;

/// The instruction counter.
#[derive(Debug)]
pub struct Counter(());

impl Counter {
    /// Starts it; SysTick is taken.
    #[must_use]
    pub fn start() -> Self {
        start();
        Self(())
    }

    /// Instructions of `work`, from the first one to its return.
    pub fn count<F: FnMut()>(&mut self, mut work: F) -> u32 {
        /// Gives the closure an address and a known way to be called.
        extern "C" fn call<F: FnMut()>(work: *mut F) {
            // SAFETY: `count_at` hands over the pointer made from `&mut work` below, while that borrow lasts.
            unsafe { (*work)() }
        }
        // SAFETY: `call::<F>` takes the pointer that is handed over with it.
        unsafe { self.count_at(call::<F> as *const (), (&raw mut work).cast()) }
    }

    /// Instructions of the function at address `function`, called with `argument`.
    ///
    /// # Safety
    /// `function` must be an `extern "C"` function of one pointer, and `argument` one that it may be called with.
    pub unsafe fn count_at(&mut self, function: *const (), argument: *mut ()) -> u32 {
        // SAFETY: the caller's promise.
        let ticks = unsafe { ticks_of_call(function, argument) };
        to_instructions(ticks) - HARNESS_INSTRUCTIONS
    }
}

/// Ticks of the counter, rounded to whole instructions.
fn to_instructions(ticks: u32) -> u32 {
    let per_tick_ns_times_hz = 1_000_000_000_u64;
    let per_instruction = INSTRUCTION_NS * u64::from(COUNTER_HZ);
    let instructions = (u64::from(ticks) * per_tick_ns_times_hz + per_instruction / 2) / per_instruction;
    u32::try_from(instructions).unwrap_or(u32::MAX)
}

/// SysTick counts 24 bits, downwards.
#[cfg(target_arch = "arm")]
const SYSTICK_MASK: u32 = 0x00FF_FFFF;

#[cfg(target_arch = "arm")]
fn start() {
    use cortex_m::peripheral::syst::SystClkSource;
    // SAFETY: the programs that count use SysTick for nothing else.
    let mut systick = unsafe { cortex_m::Peripherals::steal() }.SYST;
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(SYSTICK_MASK);
    systick.clear_current();
    systick.enable_counter();
}

/// The difference of two readings of SysTick around a call.
#[cfg(target_arch = "arm")]
unsafe fn ticks_of_call(function: *const (), argument: *mut ()) -> u32 {
    /// Calls `function(argument)` between two readings of SysTick.
    #[unsafe(naked)]
    unsafe extern "C" fn difference(function: *const (), argument: *mut ()) -> u32 {
        core::arch::naked_asm!(
            "push {{r4, r5, r6, lr}}",
            "mov r5, r0",
            "mov r0, r1",
            "ldr r6, =0xE000E018", // current value, Armv7-M Architecture Reference Manual B3.3
            "ldr r4, [r6]",
            "blx r5",
            "ldr r6, [r6]",
            "subs r0, r4, r6",
            "pop {{r4, r5, r6, pc}}",
            ".ltorg",
        )
    }
    // SAFETY: the caller promises that the call is sound; SysTick may be read at any time.
    unsafe { difference(function, argument) & SYSTICK_MASK }
}

#[cfg(target_arch = "riscv32")]
fn start() {}

/// The difference of two readings of `minstret` around a call.
#[cfg(target_arch = "riscv32")]
unsafe fn ticks_of_call(function: *const (), argument: *mut ()) -> u32 {
    /// Calls `function(argument)` between two readings of `minstret`.
    #[unsafe(naked)]
    unsafe extern "C" fn difference(function: *const (), argument: *mut ()) -> u32 {
        core::arch::naked_asm!(
            "addi sp, sp, -16",
            "sw ra, 12(sp)",
            "sw s0, 8(sp)",
            "mv t0, a0",
            "mv a0, a1",
            "csrr s0, minstret",
            "jalr t0",
            "csrr a0, minstret",
            "sub a0, a0, s0",
            "lw s0, 8(sp)",
            "lw ra, 12(sp)",
            "addi sp, sp, 16",
            "ret",
        )
    }
    // SAFETY: the caller promises that the call is sound; the counter may be read at any time.
    unsafe { difference(function, argument) }
}
