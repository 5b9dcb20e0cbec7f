//! The flight computer behind a bench: frames over the serial port (`docs/wire.md`), model and estimator, answers.
//!
//! Both directions are polled, because nothing else runs; a byte is never waited for. `SysTick` watches for a bench
//! that has fallen silent: its clock is the bench's own, and stands still when the bench does.

#![cfg_attr(target_os = "none", no_std, no_main)]

gimbal_firmware::arm_program!(target::run, "hil");

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    use cortex_m::peripheral::syst::SystClkSource;
    use cortex_m::{Peripherals, singleton};
    use gimbal_computer::Computer;
    use gimbal_firmware::{Native, board};
    use heapless::Deque;

    /// Time without a byte after which the output goes to its safe value [ms]: a bench in lockstep may pause.
    const SILENCE_MS: u32 = 5_000;
    /// Bytes that wait to be sent: two ticks' answers.
    const WAITING: usize = 256;

    pub(crate) fn run() -> Result<(), &'static str> {
        const TAKEN: &str = "started twice";
        let mut timer = Peripherals::take().ok_or(TAKEN)?.SYST;
        let uart = uart::Uart::start(board::UART.ok_or("the board's file gives no serial port")?);
        let computer = singleton!(: Computer<Native> = Computer::new()).ok_or(TAKEN)?;
        let waiting = singleton!(: Deque<u8, WAITING> = Deque::new()).ok_or(TAKEN)?;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(board::COUNTER_HZ / 1_000 - 1);
        timer.clear_current();
        timer.enable_counter();
        let mut silent_ms = 0;
        loop {
            // Taken while there is room for a frame, so that none is cut.
            if waiting.capacity() - waiting.len() >= gimbal_wire::FRAME_LEN {
                for byte in computer.take().into_iter().flatten() {
                    let _ = waiting.push_back(byte);
                }
            }
            if waiting.front().is_some_and(|byte| uart.send(*byte)) {
                let _ = waiting.pop_front();
            }
            if let Some(byte) = uart.receive() {
                computer.receive_byte(byte);
                silent_ms = 0;
            } else if timer.has_wrapped() {
                silent_ms += 1;
                if silent_ms >= SILENCE_MS {
                    computer.silence();
                    silent_ms = 0;
                }
            }
        }
    }

    /// The CMSDK APB UART (Arm DDI 0479, 4.3).
    mod uart {
        // Registers of a peripheral are addresses.
        #![allow(unsafe_code)]

        const DATA: u32 = 0x00;
        const STATE: u32 = 0x04;
        const CONTROL: u32 = 0x08;
        const DIVIDER: u32 = 0x10;
        const SEND_FULL: u32 = 1;
        const RECEIVE_FULL: u32 = 2;
        /// Sender and receiver on, no interrupts.
        const ON: u32 = 3;
        /// 25 MHz / 25: 1 Mbaud.
        const ONE_MEGABAUD: u32 = 25;

        pub(super) struct Uart(u32);

        impl Uart {
            pub(super) fn start(address: u32) -> Self {
                let uart = Self(address);
                uart.write(DIVIDER, ONE_MEGABAUD);
                uart.write(CONTROL, ON);
                uart
            }

            /// Whether the byte is under way.
            pub(super) fn send(&self, byte: u8) -> bool {
                let free = self.read(STATE) & SEND_FULL == 0;
                if free {
                    self.write(DATA, u32::from(byte));
                }
                free
            }

            pub(super) fn receive(&self) -> Option<u8> {
                let [byte, ..] = (self.read(STATE) & RECEIVE_FULL != 0).then(|| self.read(DATA).to_le_bytes())?;
                Some(byte)
            }

            fn read(&self, register: u32) -> u32 {
                // SAFETY: the board's file gives the address of this peripheral, and nothing else uses it.
                unsafe { ((self.0 + register) as *const u32).read_volatile() }
            }

            fn write(&self, register: u32, value: u32) {
                // SAFETY: as above.
                unsafe { ((self.0 + register) as *mut u32).write_volatile(value) };
            }
        }
    }
}
