//! [`Fixed`]: 32-bit fractions of a full scale `2^exponent` that the law knows.

#![allow(clippy::cast_possible_truncation, reason = "bits are moved between words of known size")]

mod functions;
mod number;
mod operators;
mod stored;

/// A signal as a 32-bit fraction, -1..1, of its full scale. Sums saturate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub struct Fixed(i32);

/// A coefficient: a 32-bit fraction, -1..1.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct Coef(i32);

/// A sum of products, 62 fraction bits. Sums wrap, so that the order of their terms does not matter: the law's full
/// scales hold every final sum.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct Wide(i64);

/// -1 is left out, so that a product of two fractions is a fraction and `-x` exists for every x.
const LARGEST: i32 = i32::MAX;

/// What a value that is not finite becomes; no arithmetic makes it.
const NOT_A_NUMBER: Fixed = Fixed(i32::MIN);

/// 1 as a sum.
const FULL: i64 = 1 << 62;

impl Fixed {
    /// The fraction `raw / 2^31`.
    #[must_use]
    pub const fn from_raw(raw: i32) -> Self {
        Self(if raw == i32::MIN { -LARGEST } else { raw })
    }

    /// The fraction times 2^31.
    #[must_use]
    pub const fn raw(self) -> i32 {
        self.0
    }

    #[inline(always)]
    fn saturate(value: i64) -> Self {
        let low = value as i32;
        if i64::from(low) == value { Self::from_raw(low) } else { Self(if value < 0 { -LARGEST } else { LARGEST }) }
    }
}
