//! A body under a checksum that fits: what is parsed is emitted in the same bytes, so nothing hides in a frame.

#![no_main]

use gimbal_fuzz::{body, stuffed};
use gimbal_wire::{FRAME_LEN, Frame, View};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let body = body(bytes);
    let view = View::new(&body).expect("the checksum fits");
    let line = stuffed(&body);
    let parsed = Frame::parse(line[..FRAME_LEN - 1].try_into().expect("a frame's length"));
    assert_eq!(parsed.is_ok(), view.message().is_some());
    if let Ok(frame) = parsed {
        assert_eq!(frame.emit().as_slice(), line, "{frame:?}");
    }
});
