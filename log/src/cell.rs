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
    if let Some((value, used)) = short_decimal(record) {
        return (Cell::Number(value), used);
    }
    if let Ok((value, used)) = fast_float2::parse_partial::<f64, _>(record)
        && value.is_finite()
        && (used == record.len() || record[used] == b',')
    {
        return (Cell::Number(value), used);
    }
    let used = memchr::memchr(b',', record).unwrap_or(record.len());
    (whole(&record[..used]), used)
}

/// Powers of ten that a double holds exactly.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// Digits with a point among them, up to a comma or the end: what most cells of a log are.
///
/// Up to 15 digits and up to 22 of them behind the point, numerator and denominator are exact, so that the one division
/// rounds as a correct reader rounds.
#[inline]
fn short_decimal(record: &[u8]) -> Option<(f64, usize)> {
    let negative = record.first() == Some(&b'-');
    let start = usize::from(negative);
    let mut mantissa = 0_u64;
    let mut point = None;
    let mut at = start;
    while let Some(&byte) = record.get(at) {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            mantissa = mantissa.wrapping_mul(10) + u64::from(digit);
        } else if byte == b'.' && point.is_none() {
            point = Some(at);
        } else if byte == b',' {
            break;
        } else {
            return None;
        }
        at += 1;
    }
    let digits = at - start - usize::from(point.is_some());
    if digits == 0 || digits > 15 {
        return None;
    }
    let behind = point.map_or(0, |point| at - point - 1);
    #[allow(clippy::cast_precision_loss, reason = "15 digits are below 2^53")]
    let value = mantissa as f64 / EXACT_POWERS[behind];
    Some((if negative { -value } else { value }, at))
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
    fn cross_short_decimals_read_as_the_standard_library_reads_them() {
        let mut seed = 1_u64;
        for _ in 0..200_000 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let digits = (seed >> 20) % 10_u64.pow(u32::try_from(1 + (seed >> 60)).expect("small"));
            let text = digits.to_string();
            let at = usize::try_from((seed >> 10) % (text.len() as u64 + 1)).expect("small");
            let text = format!("{}{}.{}", if seed & 1 == 0 { "-" } else { "" }, &text[..at], &text[at..]);
            let expected: f64 = text.parse().expect("a number");
            let (cell, used) = leading(text.as_bytes());
            assert_eq!((cell, used), (Cell::Number(expected), text.len()), "{text}");
            assert!(matches!(cell, Cell::Number(value) if value.to_bits() == expected.to_bits()), "{text}");
        }
        assert_eq!(leading(b".,1"), (Cell::Text, 1));
        assert_eq!(leading(b"-,1"), (Cell::Text, 1));
        assert_eq!(leading(b"1.2.3"), (Cell::Text, 5));
    }

    #[test]
    fn cross_numbers_read_as_the_standard_library_reads_them() {
        for text in ["0.1", "1e-320", "179769313486231570000e288", "123456789.123456789", "-0", "9007199254740993"] {
            let expected: f64 = text.parse().expect("a number");
            assert_eq!(whole(text.as_bytes()), Cell::Number(expected), "{text}");
        }
    }
}
