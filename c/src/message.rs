//! Why something failed, as text of C.

use core::ffi::c_char;
use core::fmt::{self, Write};

/// Writes `error` with a closing zero, cut where the memory ends.
///
/// # Safety
/// `text` must be writable for `bytes`; it may be null when that is 0.
pub(crate) unsafe fn write(error: &impl fmt::Display, text: *mut c_char, bytes: usize) {
    if text.is_null() || bytes == 0 {
        return;
    }
    // SAFETY: the caller's promise; a character has the size of a byte.
    let memory = unsafe { core::slice::from_raw_parts_mut(text.cast::<u8>(), bytes) };
    let mut text = Text { memory, used: 0 };
    // Cutting is no error.
    let _ = write!(text, "{error}");
    let end = text.used;
    text.memory[end] = 0;
}

struct Text<'a> {
    memory: &'a mut [u8],
    used: usize,
}

impl Write for Text<'_> {
    fn write_str(&mut self, part: &str) -> fmt::Result {
        // One byte stays for the zero.
        let room = self.memory.len() - 1 - self.used;
        let length = part.len().min(room);
        self.memory[self.used..self.used + length].copy_from_slice(&part.as_bytes()[..length]);
        self.used += length;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_message_is_cut_and_closed() {
        let mut text = [1; 8];
        // SAFETY: eight bytes are writable.
        unsafe { super::write(&"0123456789", text.as_mut_ptr(), 8) };
        assert_eq!(text.map(i32::from), [48, 49, 50, 51, 52, 53, 54, 0]);
    }
}
