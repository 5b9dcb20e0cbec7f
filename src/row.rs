//! Sums of products: one row of a matrix times signals of different full scales.

use crate::number::Number;

/// `sum of coefficient * signal`, each signal with its own full scale, the sum with another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Row<N: Number, const L: usize> {
    coefs: [N::Coef; L],
    /// The coefficients are `2^shift` too small, so that fractions can hold them.
    shift: u32,
}

impl<N: Number, const L: usize> Row<N, L> {
    /// Quantises factors in SI for signals of the full scales `2^from` and a sum of the full scale `2^to`.
    pub(crate) fn build(factors: [f64; L], from: [i32; L], to: i32) -> Self {
        let scaled: [f64; L] = core::array::from_fn(|i| N::rescaled(factors[i], from[i] - to));
        let largest = scaled.iter().fold(0.0, |most: f64, factor| most.max(factor.abs()));
        let shift = N::exponent(largest).clamp(0, 31);
        Self { coefs: scaled.map(|factor| N::coef(N::rescaled(factor, -shift))), shift: shift.unsigned_abs() }
    }

    /// The sum, rounded once.
    #[inline(always)]
    pub(crate) fn at(&self, signals: &[N; L]) -> N {
        N::narrow_shifted(self.products(signals), self.shift)
    }

    /// The sum with all its bits, to be added to a state.
    #[inline(always)]
    pub(crate) fn increment(&self, signals: &[N; L]) -> N::Wide {
        N::widen_shifted(self.products(signals), self.shift)
    }

    #[inline(always)]
    fn products(&self, signals: &[N; L]) -> N::Wide {
        let [first, rest @ ..] = &self.coefs[..] else { return N::Wide::default() };
        let mut sum = *first * signals[0];
        for (coef, signal) in rest.iter().zip(&signals[1..]) {
            sum = sum + *coef * *signal;
        }
        sum
    }
}
