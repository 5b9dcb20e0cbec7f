//! One cell of numbers, from its bytes.

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Cell {
    /// A finite number.
    Number(f64),
    /// Nothing, or NaN.
    Missing,
    /// An infinity, or a number beyond a double.
    NotFinite,
    /// Anything else.
    Text,
}

/// Reads the cell at the front of a record, and returns it with the number of bytes up to the comma or the end.
///
/// The straight way: a number that ends at the comma. Everything else is looked at again by [`whole`].
#[inline]
pub(crate) fn leading(record: &[u8]) -> (Cell, usize) {
    if let Ok((value, used)) = fast_float2::parse_partial::<f64, _>(record)
        && value.is_finite()
        && (used == record.len() || record[used] == b',')
    {
        return (Cell::Number(value), used);
    }
    let used = memchr::memchr(b',', record).unwrap_or(record.len());
    (whole(&record[..used]), used)
}

/// Reads a cell that stands by itself.
pub(crate) fn whole(bytes: &[u8]) -> Cell {
    let bytes = bytes.trim_ascii();
    if bytes.is_empty() {
        return Cell::Missing;
    }
    match fast_float2::parse::<f64, _>(bytes) {
        Ok(value) if value.is_finite() => Cell::Number(value),
        Ok(value) if value.is_nan() => Cell::Missing,
        Ok(_) => Cell::NotFinite,
        Err(_) => Cell::Text,
    }
}

#[cfg(test)]
mod tests {
    use super::{Cell, leading, whole};

    #[test]
    fn contract_cells_are_numbers_missing_or_wrong() {
        assert_eq!(leading(b"1.5,2"), (Cell::Number(1.5), 3));
        assert_eq!(leading(b" -2e-3 ,2"), (Cell::Number(-2e-3), 7));
        assert_eq!(leading(b",2"), (Cell::Missing, 0));
        assert_eq!(leading(b"NaN,2"), (Cell::Missing, 3));
        assert_eq!(leading(b"1.5x,2"), (Cell::Text, 4));
        assert_eq!(whole(b"-inf"), Cell::NotFinite);
        assert_eq!(whole(b"1e999"), Cell::NotFinite);
        assert_eq!(whole(b"1,5"), Cell::Text);
        assert_eq!(whole(b"+1"), Cell::Number(1.0));
    }

    #[test]
    fn cross_numbers_read_as_the_standard_library_reads_them() {
        for text in ["0.1", "1e-320", "179769313486231570000e288", "123456789.123456789", "-0", "9007199254740993"] {
            let expected: f64 = text.parse().expect("a number");
            assert_eq!(whole(text.as_bytes()), Cell::Number(expected), "{text}");
        }
    }
}
