//! [`Fixed`]: 32-bit fractions of a full scale `2^exponent` that the law knows.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "bits are moved between words of known size"
)]

use core::ops::{Add, Mul, Neg, Sub};

use super::Number;
use super::product::product;
use crate::stored::{Reader, Stored, Writer, load_signal, store_signal};
use crate::table::SqrtTable;

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

impl Add for Fixed {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

impl Sub for Fixed {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

impl Neg for Fixed {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.saturating_neg())
    }
}

impl Mul<Fixed> for Coef {
    type Output = Wide;
    #[inline(always)]
    fn mul(self, signal: Fixed) -> Wide {
        Wide(product(self.0, signal.0))
    }
}

impl Add for Wide {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl Sub for Wide {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }
}

impl Number for Fixed {
    type Coef = Coef;
    type Wide = Wide;
    type Carry = i64;
    type CountScale = u32;

    const ZERO: Self = Self(0);
    const ONE: Self = Self(LARGEST);
    const HALF_BIT: Wide = Wide(1 << 30);
    const SQRT_LOWEST: f64 = 0.25;
    const SQRT_GAIN: f64 = core::f64::consts::FRAC_1_SQRT_2;
    const HAS_SCALES: bool = true;
    const TAG: u8 = b'q';

    #[inline(always)]
    fn head(wide: Wide) -> Self {
        Self((wide.0 >> 31) as i32)
    }

    #[inline(always)]
    fn as_words<const L: usize>(values: [Self; L]) -> [Self; L] {
        core::hint::black_box(values)
    }

    #[inline(always)]
    fn exceeds(wide: Wide, limit: u32) -> bool {
        // The upper word alone, in which a sum beyond the full scale has room.
        Self((wide.0 >> 32) as i32).beyond(limit >> 1)
    }

    #[inline(always)]
    fn narrow(wide: Wide) -> Self {
        Self::saturate(wide.0 >> 31)
    }

    #[inline(always)]
    fn narrow_shifted(wide: Wide, shift: u32) -> Self {
        Self::saturate(wide.0 >> (31 - shift.min(31)))
    }

    #[inline(always)]
    fn widen_shifted(wide: Wide, shift: u32) -> Wide {
        Wide(wide.0 << shift.min(31))
    }

    #[inline(always)]
    fn confine(wide: Wide) -> Wide {
        Wide(wide.0.clamp(-FULL, FULL))
    }

    #[inline(always)]
    fn is_full(wide: Wide) -> bool {
        !(-FULL + 1..FULL).contains(&wide.0)
    }

    #[inline(always)]
    fn kept(wide: Wide, _head: Self) -> Wide {
        Wide(wide.0 & i64::from(LARGEST))
    }

    #[inline(always)]
    fn widen(self) -> Wide {
        Wide(i64::from(self.0) << 31)
    }

    #[inline(always)]
    fn product(self, other: Self) -> Wide {
        Wide(product(self.0, other.0))
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        // -1 does not exist: the product is a fraction.
        Self::head(self.product(other))
    }

    #[inline(always)]
    fn shift_down(self, shift: u32) -> Self {
        Self(self.0.wrapping_shr(shift))
    }

    #[inline(always)]
    fn shift_up(self, shift: u32) -> Self {
        Self::saturate(i64::from(self.0) << shift.min(31))
    }

    #[inline(always)]
    fn times_power(self, shift: u32) -> Self {
        Self(self.0.wrapping_shl(shift))
    }

    /// The reciprocal of the normalised divisor to 16 bits by one 32-bit division, to 30 bits by one Newton step.
    #[inline(always)]
    fn ratio(self, divisor: Self) -> Self {
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

    #[inline(always)]
    fn half(self) -> Self {
        Self(self.0 >> 1)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.saturating_abs())
    }

    /// With `s = m / 4^k`, `1/4 <= m < 1`: the table's chord at m, over 2^k.
    #[inline(always)]
    fn hypot(self, other: Self, table: &SqrtTable<Self>) -> Self {
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

    #[inline(always)]
    fn sixteenth(self) -> i32 {
        // A one more at the end keeps the leading one defined.
        let positive = self.0 as u32 | 1;
        let zeros = positive.leading_zeros();
        // The leading one itself counts as 16.
        ((31 - zeros) * 16 + (positive << zeros >> 27)) as i32 - 16
    }

    #[inline(always)]
    fn sixteenth_start(step: i32) -> Self {
        let octave = (step >> 4).clamp(0, 30);
        let mantissa = (16 + (step & 15)) as u32;
        Self::from_raw(((u64::from(mantissa) << octave) >> 4).min(LARGEST as u64) as i32)
    }

    #[inline(always)]
    fn within(self, limit: Self) -> bool {
        // NOT_A_NUMBER has the largest absolute value, which no limit reaches.
        self.abs() <= limit
    }

    #[inline(always)]
    fn is_number(self) -> bool {
        self != NOT_A_NUMBER
    }

    fn limit(self) -> u32 {
        self.0 as u32
    }

    fn of_limit(limit: u32) -> Self {
        Self(limit as i32)
    }

    #[inline(always)]
    fn beyond(self, limit: u32) -> bool {
        // NOT_A_NUMBER plus any limit is above twice the limit.
        (self.0 as u32).wrapping_add(limit) > limit << 1
    }

    #[inline(always)]
    fn stirred(self) -> Self {
        self
    }

    #[inline(always)]
    fn count_scaled(signal: Self, _scale: Coef) -> Self {
        signal
    }

    #[inline(always)]
    fn count(left: Self, scaled: Self, carry: &mut Self) -> i32 {
        // The carry is the product's lower word, without sign.
        let exact = product(left.0, scaled.0) + i64::from(carry.0 as u32);
        *carry = Self(exact as i32);
        (exact >> 32) as i32
    }

    /// A product has 62 fraction bits; a count has its lowest bit at 2^32 or above.
    fn count_scale(exponent: i32, product: i32) -> u32 {
        (exponent - product + 30).clamp(0, 30).unsigned_abs()
    }

    #[inline(always)]
    fn coarse_scaled(signal: Self, _scale: u32) -> Self {
        signal
    }

    #[inline(always)]
    fn count_coarse(left: Self, scaled: Self, scale: u32, carry: &mut i64) -> i32 {
        let exact = product(left.0, scaled.0) + *carry;
        let high = (exact >> 32) as i32;
        let whole = high.wrapping_shr(scale);
        *carry = exact - (i64::from(whole.wrapping_shl(scale)) << 32);
        whole
    }

    fn carried(carry: i64, scale: u32) -> f64 {
        libm::ldexp(carry as f64, -32 - scale as i32)
    }

    fn carry_to_bits(carry: i64) -> u64 {
        carry as u64
    }

    fn carry_from_bits(bits: u64) -> i64 {
        bits as i64
    }

    fn exponent(bound: f64) -> i32 {
        // frexp: bound = m 2^e with 1/2 <= m < 1
        libm::frexp(bound).1
    }

    fn quantise(value: f64, exponent: i32) -> Self {
        if !value.is_finite() {
            return NOT_A_NUMBER;
        }
        let scaled = libm::round(libm::ldexp(value, 31 - exponent));
        Self::from_raw(scaled as i32)
    }

    fn to_f64(self, exponent: i32) -> f64 {
        libm::ldexp(f64::from(self.0), exponent - 31)
    }

    fn rescaled(value: f64, exponent: i32) -> f64 {
        libm::ldexp(value, exponent)
    }

    fn decay_coef(change: f64) -> Coef {
        Self::coef(1.0 + change)
    }

    fn coef(value: f64) -> Coef {
        Coef(Self::quantise(value, 0).0)
    }

    #[inline(always)]
    fn to_bits(self) -> u32 {
        self.0 as u32
    }

    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Self(bits as i32)
    }

    fn wide_to_bits(wide: Wide) -> u64 {
        wide.0 as u64
    }

    fn wide_from_bits(bits: u64) -> Wide {
        Wide(bits as i64)
    }
}

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
