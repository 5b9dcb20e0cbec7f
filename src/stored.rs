//! Values as bytes, one after the other: little-endian, of the same length in both number systems.
//!
//! A structure's bytes are those of its fields in the order in which [`stored`] lists them; a field that is not listed
//! does not compile.

use crate::number::Number;

/// A value that an image holds.
pub trait Stored: Sized {
    /// Its length in bytes.
    const LEN: usize;
    /// Writes its bytes.
    fn store(&self, writer: &mut Writer<'_>);
    /// Reads its bytes; where they are no value of this type, the reader says so.
    fn load(reader: &mut Reader<'_>) -> Self;
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

            fn store(&self, writer: &mut $crate::stored::Writer<'_>) {
                let Self { $($field),+ } = self;
                $($crate::stored::Stored::store($field, writer);)+
            }

            fn load(reader: &mut $crate::stored::Reader<'_>) -> Self {
                Self { $($field: $crate::stored::Stored::load(reader)),+ }
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

    fn store(&self, writer: &mut Writer<'_>) {
        self.iter().for_each(|value| value.store(writer));
    }

    fn load(reader: &mut Reader<'_>) -> Self {
        core::array::from_fn(|_| T::load(reader))
    }
}

/// Limits, shifts and counts: any bits.
impl Stored for u32 {
    const LEN: usize = 4;

    fn store(&self, writer: &mut Writer<'_>) {
        writer.put(&self.to_le_bytes());
    }

    fn load(reader: &mut Reader<'_>) -> Self {
        Self::from_le_bytes(reader.take())
    }
}

/// Exponents and places in a table: far from where their sums would overflow.
impl Stored for i32 {
    const LEN: usize = 4;

    fn store(&self, writer: &mut Writer<'_>) {
        writer.put(&self.to_le_bytes());
    }

    fn load(reader: &mut Reader<'_>) -> Self {
        let value = Self::from_le_bytes(reader.take());
        reader.require((-0x1_0000..=0x1_0000).contains(&value));
        value
    }
}

impl Stored for bool {
    const LEN: usize = 1;

    fn store(&self, writer: &mut Writer<'_>) {
        writer.put(&[u8::from(*self)]);
    }

    fn load(reader: &mut Reader<'_>) -> Self {
        let [byte] = reader.take();
        reader.require(byte <= 1);
        byte == 1
    }
}

/// Moved as it is: no double is computed with.
impl Stored for f64 {
    const LEN: usize = 8;

    fn store(&self, writer: &mut Writer<'_>) {
        writer.put(&self.to_bits().to_le_bytes());
    }

    fn load(reader: &mut Reader<'_>) -> Self {
        const EXPONENT: u64 = 0x7FF << 52;
        let bits = u64::from_le_bytes(reader.take());
        reader.require(bits & EXPONENT != EXPONENT);
        Self::from_bits(bits)
    }
}

/// The bytes of a signal.
pub(crate) fn store_signal<N: Number>(signal: N, writer: &mut Writer<'_>) {
    writer.put(&signal.to_bits().to_le_bytes());
}

/// The signal of these bytes.
pub(crate) fn load_signal<N: Number>(reader: &mut Reader<'_>) -> N {
    let signal = N::from_bits(u32::from_le_bytes(reader.take()));
    reader.require(signal.is_number());
    signal
}
