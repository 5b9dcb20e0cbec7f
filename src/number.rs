//! The two number systems of the flight code, behind one trait.
//!
//! Every signal of the law is a [`Number`]: an `f32` in SI units, or a [`Fixed`], a 32-bit fraction of a full scale
//! `2^exponent` that is chosen for each signal when the law is built. A coefficient times a signal gives a
//! [`Number::Wide`] value; sums are taken there, and [`Number::narrow`] alone rounds.
//!
//! Only IEEE `+ - * /`, comparisons, conversions and integer operations are used, so that the same inputs give the
//! same bits on every host and target.

mod fixed;
pub(crate) mod float;
mod product;

pub use fixed::Fixed;

use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

use crate::stored::Stored;
use crate::table::SqrtTable;

/// A signal: `f32`, or [`Fixed`] with a full scale of its own.
///
/// Sealed: the law's error budget holds for these two.
pub trait Number:
    Copy
    + Debug
    + Default
    + PartialEq
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Stored
    + sealed::Sealed
    + 'static
{
    /// What a signal is multiplied by; for [`Fixed`] a fraction in -1..1.
    type Coef: Copy + Debug + Default + PartialEq + Mul<Self, Output = Self::Wide> + Stored;
    /// Sum of products; also holds a state that accumulates small increments.
    type Wide: Copy + Debug + Default + PartialEq + Add<Output = Self::Wide> + Sub<Output = Self::Wide> + Stored;
    /// What a count has left over.
    type Carry: Copy + Debug + Default + PartialEq;
    /// Size of a count.
    type CountScale: Copy + Debug + PartialEq + Stored;

    /// Zero.
    const ZERO: Self;
    /// 1 in the full scale 2^0.
    const ONE: Self;
    /// Half of what [`Number::narrow`] drops at most; 0 for `f32`. A sum that holds it is narrowed to the nearest signal.
    const HALF_BIT: Self::Wide;

    /// Smallest mantissa of [`Number::hypot`].
    const SQRT_LOWEST: f64;
    /// What its table has of the root.
    const SQRT_GAIN: f64;
    /// Whether signals are fractions of full scales.
    const HAS_SCALES: bool;
    /// Tag of the number system in saved states and in digests.
    const TAG: u8;

    /// The signal nearest below a sum of products, for [`Fixed`]; the sum itself for `f32`. The full scale is known to
    /// hold the sum.
    fn head(wide: Self::Wide) -> Self;
    /// The values themselves. For [`Fixed`] they pass through memory as words: kept in registers for long, the compiler
    /// takes them for 64 bits and multiplies them as such.
    #[must_use]
    fn as_words<const L: usize>(values: [Self; L]) -> [Self; L];
    /// Whether a sum is not within plus and minus a limit.
    fn exceeds(wide: Self::Wide, limit: u32) -> bool;
    /// [`Number::head`] for any sum: saturates.
    fn narrow(wide: Self::Wide) -> Self;
    /// A sum times `2^shift`, saturated.
    fn narrow_shifted(wide: Self::Wide, shift: u32) -> Self;
    /// A sum times `2^shift`, with all its bits.
    fn widen_shifted(wide: Self::Wide, shift: u32) -> Self::Wide;
    /// The sum within -1..=1 of its full scale; `f32` has room.
    fn confine(wide: Self::Wide) -> Self::Wide;
    /// Whether a sum lies beyond 1 of its full scale.
    fn is_full(wide: Self::Wide) -> bool;
    /// What [`Number::decay_coef`] leaves of a state: all of it for `f32`, the bits below the signal for [`Fixed`].
    /// `head` is its signal.
    fn kept(wide: Self::Wide, head: Self) -> Self::Wide;
    /// The signal as a sum.
    fn widen(self) -> Self::Wide;
    /// Product with all its bits; its full scale is the product of the two full scales.
    fn product(self, other: Self) -> Self::Wide;
    /// Product; its full scale is the product of the two full scales.
    #[must_use]
    fn times(self, other: Self) -> Self;
    /// `self / 2^shift`: the same value in a full scale `2^shift` times larger.
    #[must_use]
    fn shift_down(self, shift: u32) -> Self;
    /// `self * 2^shift`, saturated: the same value in a full scale `2^shift` times smaller.
    #[must_use]
    fn shift_up(self, shift: u32) -> Self;
    /// `self * 2^shift` where that is known to fit.
    #[must_use]
    fn times_power(self, shift: u32) -> Self;
    /// `self / divisor` in the full scale 2^0, for `|self| <= divisor`; saturates at 1 beyond.
    #[must_use]
    fn ratio(self, divisor: Self) -> Self;
    /// Half of the value.
    #[must_use]
    fn half(self) -> Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// Square root of the sum of two squares, for values below 0.7 of the full scale, to 2e-5.
    #[must_use]
    fn hypot(self, other: Self, table: &SqrtTable<Self>) -> Self;
    /// Position of a positive value on a logarithmic grid of sixteen steps an octave.
    fn sixteenth(self) -> i32;
    /// Smallest value at step `step` of that grid.
    fn sixteenth_start(step: i32) -> Self;
    /// Whether the value is a number within `-limit..=limit`.
    fn within(self, limit: Self) -> bool;
    /// The largest value, positive, in the form that [`Number::beyond`] takes.
    fn limit(self) -> u32;
    /// The value that [`Number::limit`] was made of.
    fn of_limit(limit: u32) -> Self;
    /// Whether the value is not within plus and minus a limit; true for what is not a number.
    fn beyond(self, limit: u32) -> bool;
    /// Whether the value is finite.
    fn is_number(self) -> bool;

    /// For `f32`, plus a torque of no effect that keeps decayed modes out of subnormal numbers, on which many processors
    /// are slow.
    #[must_use]
    fn stirred(self) -> Self;

    /// A factor of [`Number::count`], for counts of `1 / scale`; as it is for [`Fixed`].
    fn count_scaled(signal: Self, scale: Self::Coef) -> Self;
    /// A product as a whole number of counts, what is left over carried to the next call. For [`Fixed`] a count is
    /// 2^-30 of the product of the full scales.
    fn count(left: Self, scaled: Self, carry: &mut Self) -> i32;

    /// How [`Number::count_coarse`] makes counts of `2^exponent` of products of the full scale `2^product`.
    fn count_scale(exponent: i32, product: i32) -> Self::CountScale;
    /// A factor of [`Number::count_coarse`]; as it is for [`Fixed`].
    fn coarse_scaled(signal: Self, scale: Self::CountScale) -> Self;
    /// [`Number::count`] with counts of any size.
    fn count_coarse(left: Self, scaled: Self, scale: Self::CountScale, carry: &mut Self::Carry) -> i32;
    /// What is carried, in counts.
    fn carried(carry: Self::Carry, scale: Self::CountScale) -> f64;
    /// The carry's bits.
    fn carry_to_bits(carry: Self::Carry) -> u64;
    /// The carry with these bits.
    fn carry_from_bits(bits: u64) -> Self::Carry;

    /// Exponent of the smallest full scale that holds `bound`; 0 for `f32`.
    fn exponent(bound: f64) -> i32;
    /// `value` as a signal of full scale `2^exponent`, saturated.
    fn quantise(value: f64, exponent: i32) -> Self;
    /// The value of a signal of full scale `2^exponent`.
    fn to_f64(self, exponent: i32) -> f64;
    /// `value * 2^exponent`: a factor between two full scales; `value` itself for `f32`.
    fn rescaled(value: f64, exponent: i32) -> f64;
    /// The coefficient c that makes `kept(x, head) + c * head` equal `(1 + change) x`.
    fn decay_coef(change: f64) -> Self::Coef;
    /// A coefficient.
    fn coef(value: f64) -> Self::Coef;

    /// The signal's bits, for saved states and digests.
    fn to_bits(self) -> u32;
    /// The signal with these bits.
    fn from_bits(bits: u32) -> Self;
    /// The sum's bits.
    fn wide_to_bits(wide: Self::Wide) -> u64;
    /// The sum with these bits.
    fn wide_from_bits(bits: u64) -> Self::Wide;

    /// The smaller of two.
    #[must_use]
    fn least(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    /// The larger of two.
    #[must_use]
    fn most(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for super::Fixed {}
}
