//! Values as bytes, one after the other: little-endian, of the same length in both number systems.
//!
//! A structure's bytes are those of its fields in the order in which [`stored`] lists them; a field that is not listed
//! does not compile.

use crate::number::Number;

/// A value that an image holds.
pub trait Stored: Sized {
    /// Its length in bytes.
    const LEN: usize;
    /// Zero.
    const BLANK: Self;
    /// Writes its bytes.
    fn store(&self, writer: &mut Writer<'_>);
    /// Takes the value of its bytes; where they are none of this type, the reader says so. In place: a small target's
    /// stack does not hold a law twice.
    fn load(&mut self, reader: &mut Reader<'_>);
}

/// Bytes still to be written.
#[derive(Debug)]
pub struct Writer<'a> {
    pub(crate) rest: &'a mut [u8],
}

impl Writer<'_> {
    pub(crate) fn put(&mut self, bytes: &[u8]) {
        let rest = core::mem::take(&mut self.rest);
        // Lengths are sums over all fields; a short buffer would drop bytes, which the round trip's test shows.
        let (head, tail) = rest.split_at_mut(bytes.len().min(rest.len()));
        head.copy_from_slice(&bytes[..head.len()]);
        self.rest = tail;
    }
}

/// Bytes still to be read.
#[derive(Debug)]
pub struct Reader<'a> {
    pub(crate) rest: &'a [u8],
    /// Whether some bytes were no value of their type.
    pub(crate) impossible: bool,
}

impl Reader<'_> {
    pub(crate) fn take<const L: usize>(&mut self) -> [u8; L] {
        if let Some((head, tail)) = self.rest.split_first_chunk::<L>() {
            self.rest = tail;
            *head
        } else {
            self.impossible = true;
            [0; L]
        }
    }

    /// The next word. Read in one place: unrolled, a law's hundreds of words are more code than the law.
    #[inline(never)]
    fn word(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    /// Notes that `possible` does not hold.
    pub(crate) fn require(&mut self, possible: bool) {
        self.impossible |= !possible;
    }
}

/// Implements [`Stored`] for a structure, field by field in the order of the list:
/// `stored!([N: Number] Law<N> { first, second })`.
macro_rules! stored {
    ([$($generics:tt)*] $law:ty { $($field:ident),+ $(,)? }) => {
        impl<$($generics)*> $crate::stored::Stored for $law {
            const LEN: usize = 0 $(+ $crate::stored::len_of::<Self, _>(|law| &law.$field))+;
            const BLANK: Self = Self { $($field: $crate::stored::Stored::BLANK),+ };

            fn store(&self, writer: &mut $crate::stored::Writer<'_>) {
                let Self { $($field),+ } = self;
                $($crate::stored::Stored::store($field, writer);)+
            }

            fn load(&mut self, reader: &mut $crate::stored::Reader<'_>) {
                let Self { $($field),+ } = self;
                $($crate::stored::Stored::load($field, reader);)+
            }
        }
    };
}
pub(crate) use stored;

/// Length of a field.
pub(crate) const fn len_of<S, T: Stored>(_: fn(&S) -> &T) -> usize {
    T::LEN
}

impl<T: Stored, const L: usize> Stored for [T; L] {
    const LEN: usize = L * T::LEN;
    const BLANK: Self = [T::BLANK; L];

    fn store(&self, writer: &mut Writer<'_>) {
        for value in self {
            value.store(writer);
        }
    }

    #[inline(never)]
    fn load(&mut self, reader: &mut Reader<'_>) {
        for value in self {
            value.load(reader);
        }
    }
}

/// Limits, shifts and counts: any bits.
impl Stored for u32 {
    const LEN: usize = 4;
    const BLANK: Self = 0;

    fn store(&self, writer: &mut Writer<'_>) {
        writer.put(&self.to_le_bytes());
    }

    fn load(&mut self, reader: &mut Reader<'_>) {
        *self = reader.word();
    }
}

/// Exponents and places in a table: far from where their sums would overflow.
impl Stored for i32 {
    const LEN: usize = 4;
    const BLANK: Self = 0;

    fn store(&self, writer: &mut Writer<'_>) {
        writer.put(&self.to_le_bytes());
    }

    fn load(&mut self, reader: &mut Reader<'_>) {
        *self = Self::from_le_bytes(reader.word().to_le_bytes());
        reader.require((-0x1_0000..=0x1_0000).contains(self));
    }
}

impl Stored for bool {
    const LEN: usize = 1;
    const BLANK: Self = false;

    fn store(&self, writer: &mut Writer<'_>) {
        writer.put(&[u8::from(*self)]);
    }

    fn load(&mut self, reader: &mut Reader<'_>) {
        let [byte] = reader.take();
        reader.require(byte <= 1);
        *self = byte == 1;
    }
}

/// Moved as it is: no double is computed with.
impl Stored for f64 {
    const LEN: usize = 8;
    const BLANK: Self = 0.0;

    fn store(&self, writer: &mut Writer<'_>) {
        writer.put(&self.to_bits().to_le_bytes());
    }

    fn load(&mut self, reader: &mut Reader<'_>) {
        const EXPONENT: u64 = 0x7FF << 52;
        let bits = u64::from_le_bytes(reader.take());
        reader.require(bits & EXPONENT != EXPONENT);
        *self = Self::from_bits(bits);
    }
}

/// Writes the bytes of a signal.
pub(crate) fn store_signal<N: Number>(signal: N, writer: &mut Writer<'_>) {
    writer.put(&signal.to_bits().to_le_bytes());
}

/// The signal of these bytes.
pub(crate) fn load_signal<N: Number>(reader: &mut Reader<'_>) -> N {
    let signal = N::from_bits(reader.word());
    reader.require(signal.is_number());
    signal
}
