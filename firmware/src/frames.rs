//! Frames of the wire as a board takes them.

use gimbal_wire::{Frame, Receiver};

/// The last frame that these bytes complete, taken one by one.
#[inline(always)]
pub fn receive(receiver: &mut Receiver, bytes: &[u8]) -> Option<Frame> {
    let mut came = None;
    for byte in bytes {
        if let Some(frame) = receiver.push(*byte) {
            came = Some(frame);
        }
    }
    came
}
