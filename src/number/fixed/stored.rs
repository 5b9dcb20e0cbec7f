//! Signals, coefficients and sums in images.

use super::{Coef, Fixed, Wide};
use crate::stored::{Reader, Stored, Writer, load_signal, store_signal};

impl Stored for Fixed {
    const LEN: usize = 4;
    const BLANK: Self = Self(0);

    fn store(&self, writer: &mut Writer<'_>) {
        store_signal(*self, writer);
    }

    fn load(&mut self, reader: &mut Reader<'_>) {
        *self = load_signal(reader);
    }
}

impl Stored for Coef {
    const LEN: usize = 4;
    const BLANK: Self = Self(0);

    fn store(&self, writer: &mut Writer<'_>) {
        store_signal(Fixed(self.0), writer);
    }

    fn load(&mut self, reader: &mut Reader<'_>) {
        self.0 = load_signal::<Fixed>(reader).0;
    }
}

impl Stored for Wide {
    const LEN: usize = 8;
    const BLANK: Self = Self(0);

    fn store(&self, writer: &mut Writer<'_>) {
        writer.put(&self.0.to_le_bytes());
    }

    fn load(&mut self, reader: &mut Reader<'_>) {
        self.0 = i64::from_le_bytes(reader.take());
    }
}
