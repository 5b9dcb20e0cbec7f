//! `f32` as a [`Number`]: signals in SI units, every full scale 1.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "quantisation to f32, and bits moved between words of known size"
)]

use super::Number;
use crate::stored::{Reader, Stored, Writer, load_signal, store_signal};
use crate::table::SqrtTable;

const SIGN: u32 = 1 << 31;
const EXPONENT_SHIFT: u32 = 23;

/// A sum of two squares, `m 4^k` with `1/2 <= m < 2`.
#[derive(Clone, Copy)]
pub(crate) struct Square {
    /// Segment of m in its table, in the lowest six bits.
    pub(crate) segment: u32,
    /// m
    pub(crate) mantissa: f32,
    /// 2^(k - 64), or 0 for a sum below 2^-125; the table's root has the rest.
    pub(crate) power: f32,
}

impl Square {
    #[inline(always)]
    pub(crate) fn of_sum(one: f32, other: f32) -> Self {
        let square = one * one + other * other;
        // The exponent's lowest bit is the parity that m keeps.
        let bits = square.to_bits();
        // Above it comes the exponent of 1/2: all ones, and one in bit 30.
        Self {
            segment: bits >> 18,
            mantissa: f32::from_bits((bits | 0xFF00_0000).wrapping_add(1 << 30)),
            power: f32::from_bits((bits >> 24) << EXPONENT_SHIFT),
        }
    }
}

impl Number for f32 {
    type Coef = f32;
    type Wide = f32;
    type Carry = f32;
    type CountScale = f32;

    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const HALF_BIT: f32 = 0.0;
    const SQRT_LOWEST: f64 = 0.5;
    const SQRT_GAIN: f64 = 18_446_744_073_709_551_616.0;
    const HAS_SCALES: bool = false;
    const TAG: u8 = b'f';

    #[inline(always)]
    fn head(wide: f32) -> f32 {
        wide
    }

    #[inline(always)]
    fn as_words<const L: usize>(values: [f32; L]) -> [f32; L] {
        values
    }

    #[inline(always)]
    fn exceeds(wide: f32, limit: u32) -> bool {
        wide.beyond(limit)
    }

    #[inline(always)]
    fn narrow(wide: f32) -> f32 {
        wide
    }

    #[inline(always)]
    fn narrow_shifted(wide: f32, _shift: u32) -> f32 {
        wide
    }

    #[inline(always)]
    fn widen_shifted(wide: f32, _shift: u32) -> f32 {
        wide
    }

    #[inline(always)]
    fn confine(wide: f32) -> f32 {
        wide
    }

    #[inline(always)]
    fn is_full(wide: f32) -> bool {
        !wide.within(1.0)
    }

    #[inline(always)]
    fn kept(_wide: f32, head: f32) -> f32 {
        head
    }

    #[inline(always)]
    fn widen(self) -> f32 {
        self
    }

    #[inline(always)]
    fn product(self, other: f32) -> f32 {
        self * other
    }

    #[inline(always)]
    fn times(self, other: f32) -> f32 {
        self * other
    }

    #[inline(always)]
    fn shift_down(self, _shift: u32) -> f32 {
        self
    }

    #[inline(always)]
    fn shift_up(self, _shift: u32) -> f32 {
        self
    }

    #[inline(always)]
    fn times_power(self, _shift: u32) -> f32 {
        self
    }

    #[inline(always)]
    fn ratio(self, divisor: f32) -> f32 {
        self / divisor
    }

    #[inline(always)]
    fn half(self) -> f32 {
        0.5 * self
    }

    #[inline(always)]
    fn abs(self) -> f32 {
        f32::from_bits(self.to_bits() & !SIGN)
    }

    /// With `s = m 4^k`, `1/2 <= m < 2`: the table's chord at m, times 2^k.
    #[inline(always)]
    fn hypot(self, other: f32, table: &SqrtTable<f32>) -> f32 {
        let Square { segment, mantissa, power } = Square::of_sum(self, other);
        table.chord(segment, mantissa) * power
    }

    #[inline(always)]
    fn sixteenth(self) -> i32 {
        (self.to_bits() >> 19) as i32
    }

    #[inline(always)]
    fn sixteenth_start(step: i32) -> f32 {
        f32::from_bits((step as u32) << 19)
    }

    #[inline(always)]
    fn within(self, limit: f32) -> bool {
        // As integers, in which a NaN is larger than every limit.
        self.to_bits() & !SIGN <= limit.to_bits()
    }

    #[inline(always)]
    fn is_number(self) -> bool {
        self.is_finite()
    }

    fn limit(self) -> u32 {
        self.to_bits() << 1
    }

    fn of_limit(limit: u32) -> f32 {
        f32::from_bits(limit >> 1)
    }

    #[inline(always)]
    fn beyond(self, limit: u32) -> bool {
        // Without its sign, as an integer, in which a NaN is larger than every limit.
        self.to_bits() << 1 > limit
    }

    #[inline(always)]
    fn stirred(self) -> f32 {
        self + 1e-25
    }

    #[inline(always)]
    fn count_scaled(signal: f32, scale: f32) -> f32 {
        signal * scale
    }

    #[inline(always)]
    fn count(left: f32, scaled: f32, carry: &mut f32) -> i32 {
        let exact = left * scaled + *carry;
        let whole = exact as i32;
        // A whole f32 above 2^24 has no fraction to lose.
        *carry = exact - whole as f32;
        whole
    }

    fn count_scale(exponent: i32, _product: i32) -> f32 {
        libm::ldexp(1.0, -exponent) as f32
    }

    #[inline(always)]
    fn coarse_scaled(signal: f32, scale: f32) -> f32 {
        Self::count_scaled(signal, scale)
    }

    #[inline(always)]
    fn count_coarse(left: f32, scaled: f32, _scale: f32, carry: &mut f32) -> i32 {
        Self::count(left, scaled, carry)
    }

    fn carried(carry: f32, _scale: f32) -> f64 {
        f64::from(carry)
    }

    fn carry_to_bits(carry: f32) -> u64 {
        u64::from(carry.to_bits())
    }

    fn carry_from_bits(bits: u64) -> f32 {
        f32::from_bits(bits as u32)
    }

    fn exponent(_bound: f64) -> i32 {
        0
    }

    fn quantise(value: f64, _exponent: i32) -> f32 {
        value as f32
    }

    fn to_f64(self, _exponent: i32) -> f64 {
        f64::from(self)
    }

    fn rescaled(value: f64, _exponent: i32) -> f64 {
        value
    }

    fn decay_coef(change: f64) -> f32 {
        Self::coef(change)
    }

    fn coef(value: f64) -> f32 {
        value as f32
    }

    #[inline(always)]
    fn to_bits(self) -> u32 {
        f32::to_bits(self)
    }

    #[inline(always)]
    fn from_bits(bits: u32) -> f32 {
        f32::from_bits(bits)
    }

    fn wide_to_bits(wide: f32) -> u64 {
        u64::from(wide.to_bits())
    }

    fn wide_from_bits(bits: u64) -> f32 {
        f32::from_bits(bits as u32)
    }
}

impl Stored for f32 {
    const LEN: usize = 4;
    const BLANK: Self = 0.0;

    fn store(&self, writer: &mut Writer<'_>) {
        store_signal(*self, writer);
    }

    fn load(&mut self, reader: &mut Reader<'_>) {
        *self = load_signal(reader);
    }
}
