//! Bytes of a line, as both sides take them: what is accepted stands in the stream as it would be sent, and the next
//! whole frame behind a delimiter is always accepted.

#![no_main]

use gimbal_wire::{FRAME_LEN, Frame, Message, Receiver};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut receiver = Receiver::default();
    let mut accepted = 0;
    for (at, &byte) in bytes.iter().enumerate() {
        let Some(frame) = receiver.push(byte) else { continue };
        accepted += 1;
        assert_eq!(frame.emit(), bytes[at + 1 - FRAME_LEN..=at], "{frame:?}");
    }
    let delimiters = bytes.iter().filter(|byte| **byte == 0).count() as u32;
    assert_eq!(receiver.counts().accepted, accepted);
    assert!(accepted + receiver.counts().refused() <= delimiters);
    let next = Frame { sequence: 1, tick: 2, message: Message::Stop };
    let after: Vec<Frame> = [0].into_iter().chain(next.emit()).filter_map(|byte| receiver.push(byte)).collect();
    assert_eq!(after.last().map(Frame::emit), Some(next.emit()));
});
