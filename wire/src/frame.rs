//! One frame: checked view, plain value, and the way between them.
//!
//! | bytes | content |
//! |---|---|
//! | 0 | protocol version |
//! | 1 | kind |
//! | 2-3 | sequence number of the sender |
//! | 4-7 | tick |
//! | 8-39 | payload, by kind; unused bytes are zero |
//! | 40-43 | CRC-32 of bytes 0-39 |
//!
//! The checksum is CRC-32/ISO-HDLC (IEEE 802.3). At this length it detects every error of up to four bits and every
//! burst of up to 32 bits; of all others it lets one in 2^32 pass (P. Koopman, *32-bit cyclic redundancy codes for
//! Internet applications*, DSN 2002).

use crc::{CRC_32_ISO_HDLC, Crc};

use crate::VERSION;
use crate::cobs::{STUFFED_LEN, stuff, unstuff};
use crate::message::{Kind, Message};

/// Length of a payload [bytes].
pub const PAYLOAD_LEN: usize = 32;
/// Length of a body: header, payload, checksum [bytes].
pub const BODY_LEN: usize = HEADER_LEN + PAYLOAD_LEN + 4;
/// Length of a frame on the wire: the stuffed body and the closing zero [bytes].
pub const FRAME_LEN: usize = BODY_LEN + 2;
const HEADER_LEN: usize = 8;

const CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Why bytes between two delimiters are not a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// Too few, too many, or stuffed wrongly.
    Structure,
    /// The checksum does not fit.
    Checksum,
    /// The frame is of another version of the protocol.
    Version,
    /// The frame is whole, but its kind or a value in it does not exist.
    Meaning,
}

/// A frame: who it is, when, and what it says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Counts the sender's frames; wraps.
    pub sequence: u16,
    /// Tick of the sender's clock; wraps after 49 days of milliseconds.
    pub tick: u32,
    /// What it says.
    pub message: Message,
}

impl Frame {
    /// The frame as it goes over the wire.
    #[must_use]
    pub fn emit(&self) -> [u8; FRAME_LEN] {
        stuff(&self.body())
    }

    fn body(&self) -> [u8; BODY_LEN] {
        let [s0, s1] = self.sequence.to_le_bytes();
        let [t0, t1, t2, t3] = self.tick.to_le_bytes();
        let header = [VERSION, self.message.kind() as u8, s0, s1, t0, t1, t2, t3];
        let mut body = [0; BODY_LEN];
        let content = header.into_iter().chain(self.message.payload());
        for (place, byte) in body.iter_mut().zip(content) {
            *place = byte;
        }
        if let Some((content, checksum)) = body.split_last_chunk_mut::<4>() {
            *checksum = CHECKSUM.checksum(content).to_le_bytes();
        }
        body
    }

    /// The frame of the bytes between two delimiters.
    ///
    /// # Errors
    /// Why they are none.
    pub fn parse(stuffed: &[u8; STUFFED_LEN]) -> Result<Self, Refusal> {
        let body = unstuff(stuffed).ok_or(Refusal::Structure)?;
        let view = View::new(&body)?;
        let message = view.message().ok_or(Refusal::Meaning)?;
        Ok(Self { sequence: view.sequence(), tick: view.tick(), message })
    }
}

/// A body whose checksum fits and whose version is ours.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    kind: u8,
    sequence: [u8; 2],
    tick: [u8; 4],
    payload: &'a [u8; PAYLOAD_LEN],
}

impl<'a> View<'a> {
    /// Checks a body.
    ///
    /// # Errors
    /// The checksum does not fit, or the version is another one.
    pub fn new(body: &'a [u8; BODY_LEN]) -> Result<Self, Refusal> {
        let (content, checksum) = body.split_last_chunk::<4>().ok_or(Refusal::Structure)?;
        if CHECKSUM.checksum(content).to_le_bytes() != *checksum {
            return Err(Refusal::Checksum);
        }
        let ([version, kind, s0, s1, t0, t1, t2, t3], payload) =
            content.split_first_chunk::<HEADER_LEN>().ok_or(Refusal::Structure)?;
        let payload = payload.first_chunk::<PAYLOAD_LEN>().ok_or(Refusal::Structure)?;
        if *version != VERSION {
            return Err(Refusal::Version);
        }
        Ok(Self { kind: *kind, sequence: [*s0, *s1], tick: [*t0, *t1, *t2, *t3], payload })
    }

    /// Sequence number.
    #[must_use]
    pub fn sequence(&self) -> u16 {
        u16::from_le_bytes(self.sequence)
    }

    /// Tick.
    #[must_use]
    pub fn tick(&self) -> u32 {
        u32::from_le_bytes(self.tick)
    }

    /// What it says; `None` if the kind or a value in it does not exist.
    #[must_use]
    pub fn message(&self) -> Option<Message> {
        Message::parse(Kind::from_byte(self.kind)?, self.payload)
    }
}
