//! Fields of a payload, one after the other, little-endian.

use crate::frame::PAYLOAD_LEN;

/// Puts fields into a payload; what is not put stays zero.
pub(crate) struct Writer {
    payload: [u8; PAYLOAD_LEN],
    at: usize,
}

impl Writer {
    pub(crate) fn new() -> Self {
        Self { payload: [0; PAYLOAD_LEN], at: 0 }
    }

    pub(crate) fn put<const L: usize>(mut self, bytes: [u8; L]) -> Self {
        for (place, byte) in self.payload.iter_mut().skip(self.at).zip(bytes) {
            *place = byte;
        }
        self.at = self.at.saturating_add(L);
        self
    }

    pub(crate) fn byte(self, value: u8) -> Self {
        self.put([value])
    }

    pub(crate) fn half(self, value: u16) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(crate) fn word(self, value: u32) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(crate) fn long(self, value: u64) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(crate) fn real<const L: usize>(self, values: [f32; L]) -> Self {
        values.into_iter().fold(self, |writer, value| writer.put(value.to_le_bytes()))
    }

    pub(crate) fn double<const L: usize>(self, values: [f64; L]) -> Self {
        values.into_iter().fold(self, |writer, value| writer.put(value.to_le_bytes()))
    }

    pub(crate) fn payload(self) -> [u8; PAYLOAD_LEN] {
        self.payload
    }
}

/// Takes fields out of a payload.
pub(crate) struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub(crate) fn new(payload: &'a [u8; PAYLOAD_LEN]) -> Self {
        Self { rest: payload }
    }

    pub(crate) fn take<const L: usize>(&mut self) -> Option<[u8; L]> {
        let (head, tail) = self.rest.split_first_chunk::<L>()?;
        self.rest = tail;
        Some(*head)
    }

    pub(crate) fn byte(&mut self) -> Option<u8> {
        self.take().map(|[byte]| byte)
    }

    pub(crate) fn half(&mut self) -> Option<u16> {
        self.take().map(u16::from_le_bytes)
    }

    pub(crate) fn word(&mut self) -> Option<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub(crate) fn long(&mut self) -> Option<u64> {
        self.take().map(u64::from_le_bytes)
    }

    pub(crate) fn real<const L: usize>(&mut self) -> Option<[f32; L]> {
        let mut values = [0.0; L];
        for value in &mut values {
            *value = f32::from_le_bytes(self.take()?);
        }
        Some(values)
    }

    pub(crate) fn double<const L: usize>(&mut self) -> Option<[f64; L]> {
        let mut values = [0.0; L];
        for value in &mut values {
            *value = f64::from_le_bytes(self.take()?);
        }
        Some(values)
    }

    /// `true` or `false`, and no other byte.
    pub(crate) fn flag(&mut self) -> Option<bool> {
        match self.byte()? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }

    /// The message, if nothing but zeros is left.
    pub(crate) fn end<T>(self, message: T) -> Option<T> {
        self.rest.iter().all(|byte| *byte == 0).then_some(message)
    }
}
