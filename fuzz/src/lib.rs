//! Frames made byte by byte, by other code than that of the wire.

use gimbal_wire::{BODY_LEN, VERSION};

/// CRC-32/ISO-HDLC bit by bit.
fn checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { (crc >> 1) ^ 0xEDB8_8320 } else { crc >> 1 })
    })
}

/// A body under a checksum that fits: version, then kind, sequence number, tick and payload as they come.
#[must_use]
pub fn body(content: &[u8]) -> [u8; BODY_LEN] {
    let mut body = [0; BODY_LEN];
    for (place, byte) in body.iter_mut().skip(1).take(BODY_LEN - 5).zip(content) {
        *place = *byte;
    }
    body[0] = VERSION;
    let sum = checksum(&body[..BODY_LEN - 4]);
    body[BODY_LEN - 4..].copy_from_slice(&sum.to_le_bytes());
    body
}

/// The plain way of stuffing, for bodies below 254 bytes (Cheshire and Baker, 1999), and the closing zero.
#[must_use]
pub fn stuffed(body: &[u8; BODY_LEN]) -> Vec<u8> {
    let mut line = Vec::new();
    for block in body.split(|byte| *byte == 0) {
        line.push(u8::try_from(block.len() + 1).unwrap_or(u8::MAX));
        line.extend_from_slice(block);
    }
    line.push(0);
    line
}
