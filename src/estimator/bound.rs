//! Sums of independent uncertainties.

use crate::number::Number;
use crate::stored::stored;

/// `sqrt(a^2 + b^2)` to 1.3 %, without a square, which fixed point has no room for: the larger of `m + l / 8` and
/// `27 m / 32 + 9 l / 16`, m the larger and l the smaller of the two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RootSum<N: Number> {
    eighth: N::Coef,
    most: N::Coef,
    least: N::Coef,
}

stored!([N: Number] RootSum<N> { eighth, most, least });

impl<N: Number> RootSum<N> {
    pub(crate) fn build() -> Self {
        Self { eighth: N::coef(0.125), most: N::coef(27.0 / 32.0), least: N::coef(9.0 / 16.0) }
    }

    /// Neither may be negative.
    #[inline(always)]
    pub(crate) fn of(&self, a: N, b: N) -> N {
        let (most, least) = if a > b { (a, b) } else { (b, a) };
        let slim = most + N::head(self.eighth * least);
        slim.most(N::narrow(self.most * most + self.least * least))
    }

    /// All of them.
    pub(crate) fn of_all(&self, parts: &[N]) -> N {
        parts.iter().fold(N::ZERO, |sum, part| self.of(sum, part.abs()))
    }
}
