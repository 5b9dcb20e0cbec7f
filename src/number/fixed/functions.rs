//! Quotient, root and logarithmic grid of fractions.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "bits are moved between words of known size"
)]

use super::{Fixed, LARGEST};
use crate::number::product::product;
use crate::table::SqrtTable;

impl Fixed {
    /// `self / divisor`. The reciprocal of the normalised divisor to 16 bits by one 32-bit division, to 30 bits by one Newton step.
    #[inline(always)]
    pub(super) fn quotient(self, divisor: Self) -> Self {
        // 1 keeps the normalisation defined; the quotient then saturates.
        let positive = divisor.0.max(1) as u32;
        let zeros = positive.leading_zeros();
        let normal = positive << zeros;
        // The leading one is there already; said once more, the compiler sees that nothing is divided by zero.
        let guess = u32::MAX / (normal >> 16 | 1 << 15);
        let error = (1_i64 << 48) - (u64::from(normal) * u64::from(guess)) as i64;
        // Both are words: the guess has 17 bits, and so has what is left of its error.
        let reciprocal = (i64::from(guess) << 14) + (product(guess as i32, (error >> 16) as i32) >> 18);
        Self::saturate((i64::from(self.0) * reciprocal) >> (31 - zeros))
    }

    /// Root of the sum of two squares s. With `s = m / 4^k`, `1/4 <= m < 1`: the table's chord at m, over 2^k.
    #[inline(always)]
    pub(super) fn root_of_squares(self, other: Self, table: &SqrtTable<Self>) -> Self {
        let square = product(self.0, self.0) + product(other.0, other.0);
        // Two components near the full scale have a root beyond it: the upper word has room up to 2, as 30 bits of
        // fraction, and never its sign bit. A one more at the end keeps the leading one defined.
        let positive = (square >> 32) as u32 | 1;
        // An even shift that brings the leading one to bit 29 or 30.
        let shift = (positive.leading_zeros() - 1) & !1;
        let mantissa = positive << shift;
        let segment = if mantissa < 1 << 30 { (mantissa >> 24) - 32 } else { mantissa >> 25 };
        // The table has half of the root of twice the mantissa; doubled, it saturates.
        let half = Self(table.chord(segment, Self(mantissa as i32)).0 >> (shift / 2));
        half + half
    }

    /// Position on the grid of sixteen steps an octave.
    #[inline(always)]
    pub(super) fn grid_position(self) -> i32 {
        // A one more at the end keeps the leading one defined.
        let positive = self.0 as u32 | 1;
        let zeros = positive.leading_zeros();
        // The leading one itself counts as 16.
        ((31 - zeros) * 16 + (positive << zeros >> 27)) as i32 - 16
    }

    /// Smallest value at a step of that grid.
    #[inline(always)]
    pub(super) fn grid_start(step: i32) -> Self {
        let octave = (step >> 4).clamp(0, 30);
        let mantissa = (16 + (step & 15)) as u32;
        Self::from_raw(((u64::from(mantissa) << octave) >> 4).min(LARGEST as u64) as i32)
    }
}
