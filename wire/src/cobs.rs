//! Consistent overhead byte stuffing for bodies of one length: no zero within a frame, one at its end.
//!
//! S. Cheshire, M. Baker, *Consistent Overhead Byte Stuffing*, IEEE/ACM Transactions on Networking 7 (1999), 159. A body
//! shorter than 254 bytes grows by one byte, whatever it holds.

use crate::frame::{BODY_LEN, FRAME_LEN};

/// The body between two delimiters: its stuffed form without the closing zero.
pub(crate) const STUFFED_LEN: usize = FRAME_LEN - 1;

/// The stuffed body and the closing zero.
pub(crate) fn stuff(body: &[u8; BODY_LEN]) -> [u8; FRAME_LEN] {
    let mut frame = [0; FRAME_LEN];
    // Distance to the next zero, counted from the end: the body's end counts as one.
    let mut distance: u8 = 1;
    for (place, &byte) in frame.iter_mut().skip(1).zip(body).rev() {
        if byte == 0 {
            *place = distance;
            distance = 1;
        } else {
            *place = byte;
            distance = distance.saturating_add(1);
        }
    }
    if let Some(first) = frame.first_mut() {
        *first = distance;
    }
    frame
}

/// The body of a stuffed one; `None` if a zero's distance leads anywhere but from zero to zero and to the end.
pub(crate) fn unstuff(stuffed: &[u8; STUFFED_LEN]) -> Option<[u8; BODY_LEN]> {
    let mut body = [0; BODY_LEN];
    let mut left = stuffed.first()?.checked_sub(1)?;
    for (place, &byte) in body.iter_mut().zip(stuffed.iter().skip(1)) {
        if byte == 0 {
            return None;
        }
        if left == 0 {
            left = byte - 1;
        } else {
            *place = byte;
            left -= 1;
        }
    }
    (left == 0).then_some(body)
}
