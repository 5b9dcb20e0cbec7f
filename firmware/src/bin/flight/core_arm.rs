//! Cortex-M: the tick in `SysTick`, the sensor in an interrupt below it.

// An interrupt's number is a promise to the hardware, and enabling one or setting its priority is too.
#![allow(unsafe_code)]

use crate::{sensor, tick};
use cortex_m::Peripherals;
use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::scb::SystemHandler;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{NVIC, SCB, SYST};
pub(crate) use cortex_m::singleton;
use cortex_m_rt::exception;
use gimbal_firmware::board;

/// Rate of [`since_tick`] [1/s].
pub(crate) const TIMER_HZ: u32 = board::COUNTER_HZ;
const RELOAD: u32 = TIMER_HZ / tick::TICK_HZ - 1;

/// The port's receive interrupt, or the first one.
#[derive(Clone, Copy)]
struct Receive;

// SAFETY: the board's file gives the number; every core has an interrupt 0.
unsafe impl InterruptNumber for Receive {
    fn number(self) -> u16 {
        board::SENSOR.map_or(0, |(_, interrupt)| interrupt)
    }
}

/// Starts the timer and lets both interrupts come; `None` if that has been done.
pub(crate) fn start() -> Option<()> {
    let mut peripherals = Peripherals::take()?;
    // SAFETY: no critical section relies on a priority.
    unsafe { peripherals.SCB.set_priority(SystemHandler::SysTick, 0) };
    // SAFETY: the same; only this interrupt is used, and the tick is above it.
    unsafe { peripherals.NVIC.set_priority(Receive, 0x80) };
    // SAFETY: no critical section relies on the interrupt being masked.
    unsafe { NVIC::unmask(Receive) };
    let mut timer = peripherals.SYST;
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(RELOAD);
    timer.clear_current();
    timer.enable_counter();
    timer.enable_interrupt();
    Some(())
}

#[exception]
fn SysTick() {
    tick::tick();
}

/// The interrupts' handler; the sensor's is the only one enabled.
#[exception]
unsafe fn DefaultHandler(_number: i16) {
    sensor::receive();
}

/// Counts since the tick was due.
pub(crate) fn since_tick() -> u32 {
    RELOAD - SYST::get_current()
}

/// Whether the timer has passed zero again: the next tick already waits.
pub(crate) fn next_tick_waits() -> bool {
    SCB::is_pendst_pending()
}

/// Makes the sensor's interrupt come, where no port does.
pub(crate) fn pend_receive() {
    NVIC::pend(Receive);
}

/// Until an interrupt has come.
pub(crate) fn sleep() {
    cortex_m::asm::wfi();
}
