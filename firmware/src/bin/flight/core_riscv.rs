//! RISC-V: the tick in the machine timer's interrupt, the sensor in the software interrupt; both by a core-local
//! interruptor (CLINT). Interrupts do not nest: the tick may wait for the sensor's, which is a few dozen instructions
//! long and asked for at the tick's end.

// Registers of a peripheral are addresses, and enabling an interrupt is a promise to the hardware.
#![allow(unsafe_code)]

use crate::{sensor, tick};
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use gimbal_firmware::board;
use riscv::interrupt::Interrupt;
pub(crate) use riscv::singleton;

/// Rate of [`since_tick`] [1/s].
pub(crate) const TIMER_HZ: u32 = match board::CLINT {
    Some((_, hz)) => hz,
    None => 1_000_000,
};
const PERIOD: u32 = TIMER_HZ / tick::TICK_HZ;

const SOFTWARE_INTERRUPT: u32 = 0x0000;
const COMPARE: u32 = 0x4000;
const TIME: u32 = 0xBFF8;

/// When the last tick was due, lower word: a minute does not wrap it.
static DUE: AtomicU32 = AtomicU32::new(0);

/// Starts the timer and lets both interrupts come; `None` if the board has none.
pub(crate) fn start() -> Option<()> {
    board::CLINT?;
    write(COMPARE + 4, 0);
    next_tick(read(TIME));
    // SAFETY: no critical section relies on these being masked.
    unsafe {
        riscv::interrupt::enable_interrupt(Interrupt::MachineTimer);
        riscv::interrupt::enable_interrupt(Interrupt::MachineSoft);
        riscv::interrupt::enable();
    }
    Some(())
}

fn next_tick(after: u32) {
    write(COMPARE, after.wrapping_add(PERIOD));
}

#[riscv_rt::core_interrupt(Interrupt::MachineTimer)]
fn machine_timer() {
    let due = read(COMPARE);
    DUE.store(due, Relaxed);
    next_tick(due);
    tick::tick();
}

#[riscv_rt::core_interrupt(Interrupt::MachineSoft)]
fn machine_software() {
    write(SOFTWARE_INTERRUPT, 0);
    sensor::receive();
}

/// Counts since the tick was due.
pub(crate) fn since_tick() -> u32 {
    read(TIME).wrapping_sub(DUE.load(Relaxed))
}

/// Whether the next tick already waits.
pub(crate) fn next_tick_waits() -> bool {
    since_tick() >= PERIOD
}

/// Makes the sensor's interrupt come.
pub(crate) fn pend_receive() {
    write(SOFTWARE_INTERRUPT, 1);
}

/// Until an interrupt has come.
pub(crate) fn sleep() {
    riscv::asm::wfi();
}

fn write(register: u32, value: u32) {
    if let Some((base, _)) = board::CLINT {
        // SAFETY: the board's file gives the address of this peripheral, and nothing else uses it.
        unsafe { ((base + register) as *mut u32).write_volatile(value) };
    }
}

fn read(register: u32) -> u32 {
    // SAFETY: as above.
    board::CLINT.map_or(0, |(base, _)| unsafe { ((base + register) as *const u32).read_volatile() })
}
