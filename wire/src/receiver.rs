//! Frames out of a stream of bytes, and a count of everything that was none.

use crate::cobs::STUFFED_LEN;
use crate::frame::{Frame, Refusal};

/// What has come in so far; counts stay at their largest value.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Frames accepted.
    pub accepted: u32,
    /// Bytes between two delimiters that are no stuffed body.
    pub structure: u32,
    /// Bodies whose checksum does not fit.
    pub checksum: u32,
    /// Bodies of another version.
    pub version: u32,
    /// Whole frames without a meaning.
    pub meaning: u32,
    /// Sequence numbers left out.
    pub lost: u32,
    /// Frames whose sequence number had come before.
    pub repeated: u32,
}

impl Counts {
    /// Everything refused.
    #[must_use]
    pub fn refused(&self) -> u32 {
        self.structure.saturating_add(self.checksum).saturating_add(self.version).saturating_add(self.meaning)
    }
}

/// Takes bytes one by one.
#[derive(Debug, Clone)]
pub struct Receiver {
    stuffed: [u8; STUFFED_LEN],
    /// Bytes since the last delimiter.
    length: usize,
    last_sequence: Option<u16>,
    counts: Counts,
}

impl Default for Receiver {
    fn default() -> Self {
        Self { stuffed: [0; STUFFED_LEN], length: 0, last_sequence: None, counts: Counts::default() }
    }
}

impl Receiver {
    /// Takes a byte; gives the frame that it completes.
    pub fn push(&mut self, byte: u8) -> Option<Frame> {
        if byte != 0 {
            if let Some(place) = self.stuffed.get_mut(self.length) {
                *place = byte;
            }
            self.length = self.length.saturating_add(1);
            return None;
        }
        let length = core::mem::take(&mut self.length);
        // Two delimiters in a row are no error: a sender may begin with one.
        if length == 0 {
            return None;
        }
        let parsed = if length == STUFFED_LEN { Frame::parse(&self.stuffed) } else { Err(Refusal::Structure) };
        match parsed {
            Ok(frame) => {
                add_one(&mut self.counts.accepted);
                self.follow(frame.sequence);
                Some(frame)
            }
            Err(refusal) => {
                add_one(match refusal {
                    Refusal::Structure => &mut self.counts.structure,
                    Refusal::Checksum => &mut self.counts.checksum,
                    Refusal::Version => &mut self.counts.version,
                    Refusal::Meaning => &mut self.counts.meaning,
                });
                None
            }
        }
    }

    /// Whether bytes of a frame that is not complete have come.
    #[must_use]
    pub fn is_within_frame(&self) -> bool {
        self.length > 0
    }

    /// What has come in so far.
    #[must_use]
    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// The sender begins to count anew.
    pub fn restart_sequence(&mut self, sequence: u16) {
        self.last_sequence = Some(sequence);
    }

    /// A sequence number ahead of the last leaves out those between; one behind it has come before, or late.
    fn follow(&mut self, sequence: u16) {
        let ahead = self.last_sequence.map_or(1, |last| sequence.wrapping_sub(last));
        if (1..=u16::MAX / 2).contains(&ahead) {
            self.counts.lost = self.counts.lost.saturating_add(u32::from(ahead - 1));
            self.last_sequence = Some(sequence);
        } else {
            add_one(&mut self.counts.repeated);
        }
    }
}

fn add_one(count: &mut u32) {
    *count = count.saturating_add(1);
}
