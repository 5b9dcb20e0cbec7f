//! Several predictions side by side: one number of each in a lane.
//!
//! Every operation is that of its lane alone, so that a prediction has the same bits whatever runs beside it.

use std::array;
use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Sub};

/// A number of each prediction.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lanes<const L: usize>([f64; L]);

#[allow(clippy::needless_range_loop, reason = "lane by lane, as the compiler's vectors have it")]
impl<const L: usize> Lanes<L> {
    /// The same number in all.
    #[inline(always)]
    pub(super) fn all(value: f64) -> Self {
        Self([value; L])
    }

    /// From the number of each.
    pub(super) fn each(of: impl FnMut(usize) -> f64) -> Self {
        Self(array::from_fn(of))
    }

    #[inline(always)]
    fn with(mut self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        for lane in 0..L {
            self.0[lane] = of(self.0[lane], other.0[lane]);
        }
        self
    }

    #[inline(always)]
    pub(super) fn map(mut self, of: impl Fn(f64) -> f64) -> Self {
        for lane in 0..L {
            self.0[lane] = of(self.0[lane]);
        }
        self
    }

    /// `self * by + more`, rounded once.
    #[inline(always)]
    pub(super) fn mul_add(mut self, by: Self, more: Self) -> Self {
        for lane in 0..L {
            self.0[lane] = self.0[lane].mul_add(by.0[lane], more.0[lane]);
        }
        self
    }

    #[inline(always)]
    pub(super) fn abs(self) -> Self {
        self.map(f64::abs)
    }

    /// 1 or -1.
    #[inline(always)]
    pub(super) fn signum(self) -> Self {
        self.map(|value| 1.0_f64.copysign(value))
    }

    /// 1, 0 or -1.
    #[inline(always)]
    pub(super) fn side(self) -> Self {
        self.map(side)
    }

    /// `then` where this is more than `limit`.
    #[inline(always)]
    pub(super) fn above(self, limit: Self, then: Self, other: Self) -> Self {
        let mut out = other;
        for lane in 0..L {
            if self.0[lane] > limit.0[lane] {
                out.0[lane] = then.0[lane];
            }
        }
        out
    }

    /// Between `-limit` and `limit`.
    #[inline(always)]
    pub(super) fn within(self, limit: f64) -> Self {
        self.map(|value| within(value, limit))
    }

    /// Whether something holds in any lane, of this and another one.
    #[inline(always)]
    pub(super) fn any(self, other: Self, of: impl Fn(f64, f64) -> bool) -> bool {
        let mut any = false;
        for lane in 0..L {
            any |= of(self.0[lane], other.0[lane]);
        }
        any
    }
}

/// A number between `-limit` and `limit`.
#[inline(always)]
pub(super) fn within(value: f64, limit: f64) -> f64 {
    let low = if value < -limit { -limit } else { value };
    if low > limit { limit } else { low }
}

/// 1, 0 or -1.
#[inline(always)]
pub(super) fn side(value: f64) -> f64 {
    if value > 0.0 {
        1.0
    } else if value < 0.0 {
        -1.0
    } else {
        0.0
    }
}

impl<const L: usize> Index<usize> for Lanes<L> {
    type Output = f64;
    #[inline(always)]
    fn index(&self, lane: usize) -> &f64 {
        &self.0[lane]
    }
}

impl<const L: usize> IndexMut<usize> for Lanes<L> {
    #[inline(always)]
    fn index_mut(&mut self, lane: usize) -> &mut f64 {
        &mut self.0[lane]
    }
}

macro_rules! operation {
    ($of:ident, $name:ident, $sign:tt) => {
        impl<const L: usize> $of for Lanes<L> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                self.with(other, |a, b| a $sign b)
            }
        }

        impl<const L: usize> $of<f64> for Lanes<L> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: f64) -> Self {
                self.map(|a| a $sign other)
            }
        }

        impl<const L: usize> $of<Lanes<L>> for f64 {
            type Output = Lanes<L>;
            #[inline(always)]
            fn $name(self, other: Lanes<L>) -> Lanes<L> {
                other.map(|b| self $sign b)
            }
        }
    };
}

operation!(Add, add, +);
operation!(Sub, sub, -);
operation!(Mul, mul, *);
operation!(Div, div, /);

impl<const L: usize> AddAssign for Lanes<L> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
