//! The watchdog: fed by every tick that met its deadline, and by nothing else.
//!
//! The CMSDK APB watchdog (Arm DDI 0479, 3.7) counts down with the core's clock. At zero it raises the NMI, which reports
//! and stops; were that not to run, the second zero resets the board. Other boards have none here: theirs goes in its
//! place.

// Registers of a peripheral are addresses.
#![allow(unsafe_code)]

use gimbal_firmware::board;

/// A running watchdog, or none.
#[derive(Debug)]
pub(crate) struct Watchdog(Option<u32>);

const LOAD: u32 = 0x000;
const CONTROL: u32 = 0x008;
const CLEAR: u32 = 0x00C;
/// Interrupt at the first zero, reset at the second.
const INTERRUPT_AND_RESET: u32 = 3;
/// Twenty missed ticks in a row.
const PATIENCE: u32 = board::COUNTER_HZ / 50;

impl Watchdog {
    /// Starts the board's watchdog.
    pub(crate) fn start() -> Self {
        let watchdog = Self(board::WATCHDOG);
        watchdog.write(LOAD, PATIENCE);
        watchdog.write(CONTROL, INTERRUPT_AND_RESET);
        watchdog
    }

    /// Starts its count again.
    pub(crate) fn feed(&self) {
        self.write(CLEAR, 1);
    }

    fn write(&self, register: u32, value: u32) {
        if let Some(base) = self.0 {
            // SAFETY: the board's file gives the address of this peripheral, and nothing else uses it.
            unsafe { ((base + register) as *mut u32).write_volatile(value) };
        }
    }
}

/// The watchdog was not fed: a flight computer would go to its safe state here.
#[cfg(target_arch = "arm")]
#[cortex_m_rt::exception]
unsafe fn NonMaskableInt() -> ! {
    gimbal_firmware::fatal!("watchdog: not fed for {} ms", PATIENCE / (board::COUNTER_HZ / 1_000));
    gimbal_firmware::semihosting::process::exit(1)
}
