//! [`Number`] for fractions.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "bits are moved between words of known size"
)]

use super::{Coef, FULL, Fixed, LARGEST, NOT_A_NUMBER, Wide};
use crate::number::Number;
use crate::number::product::product;
use crate::table::SqrtTable;

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

    #[inline(always)]
    fn ratio(self, divisor: Self) -> Self {
        self.quotient(divisor)
    }

    #[inline(always)]
    fn half(self) -> Self {
        Self(self.0 >> 1)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.saturating_abs())
    }

    #[inline(always)]
    fn hypot(self, other: Self, table: &SqrtTable<Self>) -> Self {
        self.root_of_squares(other, table)
    }

    #[inline(always)]
    fn sixteenth(self) -> i32 {
        self.grid_position()
    }

    #[inline(always)]
    fn sixteenth_start(step: i32) -> Self {
        Self::grid_start(step)
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
        // a proper carry never overflows it, one of an absurd image may
        let exact = product(left.0, scaled.0).wrapping_add(*carry);
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
