//! The flight computer behind a bench, with two named pipes in place of the serial port: the emulator's semihosting
//! opens `down` and `up` in its working folder. Same frames, same computer as `hil`, and fast enough for long runs.

#![cfg_attr(target_os = "none", no_std, no_main)]

gimbal_firmware::arm_program!(target::run, "hil_fifo");

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    use cortex_m::singleton;
    use gimbal_computer::Computer;
    use gimbal_firmware::Native;
    use gimbal_firmware::semihosting::fs::File;
    use gimbal_firmware::semihosting::io::{Read, Write};
    use gimbal_wire::FRAME_LEN;
    use heapless::Vec;

    /// Answers that are written at once.
    const AT_ONCE: usize = 16 * FRAME_LEN;

    pub(crate) fn run() -> Result<(), &'static str> {
        const CLOSED: &str = "the pipe to the bench is closed";
        let mut down = File::open(c"down").map_err(|_| "no pipe `down` in the emulator's folder")?;
        let mut up = File::create(c"up").map_err(|_| "no pipe `up` in the emulator's folder")?;
        let computer = singleton!(: Computer<Native> = Computer::new()).ok_or("started twice")?;
        let mut answers: Vec<u8, AT_ONCE> = Vec::new();
        let mut bytes = [0; 1024];
        loop {
            let count = down.read(&mut bytes).map_err(|_| CLOSED)?;
            if count == 0 {
                return Ok(());
            }
            for &byte in bytes.iter().take(count) {
                if !computer.receive_byte(byte) {
                    continue;
                }
                while let Some(frame) = computer.take() {
                    if answers.extend_from_slice(&frame).is_err() {
                        up.write_all(&answers).map_err(|_| CLOSED)?;
                        answers.clear();
                        let _ = answers.extend_from_slice(&frame);
                    }
                }
            }
            if !answers.is_empty() {
                up.write_all(&answers).map_err(|_| CLOSED)?;
                answers.clear();
            }
        }
    }
}
