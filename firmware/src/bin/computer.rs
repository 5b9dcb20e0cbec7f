//! Everything that a board does with bytes from a bench: receiver, parser, commands, ticks, answers, as functions of
//! their own. `cargo xtask test --only target-hil` follows every call from them: whatever the bytes are, none leads to a
//! panic. The building of a model is left out; it is done once, on command, while nothing steps.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(all(target_os = "none", not(target_arch = "arm")))]
gimbal_firmware::program!(elsewhere);

#[cfg(all(target_os = "none", not(target_arch = "arm")))]
fn elsewhere() -> Result<(), &'static str> {
    Err("computer runs on Cortex-M alone")
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    // Symbols that the image keeps by name: unmangled names are unsafe because two could be equal.
    #![allow(unsafe_code)]

    use gimbal_computer::Computer;
    use gimbal_firmware::Native;
    use gimbal_wire::{FRAME_LEN, Frame, Receiver};

    gimbal_firmware::stop_at_panic!();
    gimbal_firmware::idle_program!();

    /// A byte of the line, and the frame that it completes.
    #[unsafe(no_mangle)]
    extern "C" fn wire_receive(receiver: &mut Receiver, byte: u8, frame: &mut Option<Frame>) {
        *frame = receiver.push(byte);
    }

    /// A frame as bytes of the line.
    #[unsafe(no_mangle)]
    extern "C" fn wire_emit(frame: &Frame, bytes: &mut [u8; FRAME_LEN]) {
        *bytes = frame.emit();
        #[cfg(feature = "bad-panic")]
        bytes.copy_within(core::hint::black_box(7)..core::hint::black_box(3), 0);
    }

    /// A byte of the line, with everything that it sets off: a command, a model that is built, a tick.
    #[unsafe(no_mangle)]
    extern "C" fn computer_receive(computer: &mut Computer<Native>, byte: u8) -> bool {
        computer.receive_byte(byte)
    }

    /// The next answer.
    #[unsafe(no_mangle)]
    extern "C" fn computer_take(computer: &mut Computer<Native>, answer: &mut Option<[u8; FRAME_LEN]>) {
        *answer = computer.take();
    }

    /// The board's own timer has seen nothing for too long.
    #[unsafe(no_mangle)]
    extern "C" fn computer_silence(computer: &mut Computer<Native>) {
        computer.silence();
    }

    type Roots = (
        extern "C" fn(&mut Receiver, u8, &mut Option<Frame>),
        extern "C" fn(&Frame, &mut [u8; FRAME_LEN]),
        extern "C" fn(&mut Computer<Native>, u8) -> bool,
        extern "C" fn(&mut Computer<Native>, &mut Option<[u8; FRAME_LEN]>),
        extern "C" fn(&mut Computer<Native>),
    );

    /// Keeps them all in the image.
    #[used]
    static ROOTS: Roots = (wire_receive, wire_emit, computer_receive, computer_take, computer_silence);
}
