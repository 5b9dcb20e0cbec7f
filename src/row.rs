//! Sums of products: one row of a matrix times signals of different full scales.

use crate::number::Number;
use crate::stored::stored;

/// `sum of coefficient * signal`, each signal with its own full scale, the sum with one that holds it and every term.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(transparent)]
pub(crate) struct Row<N: Number, const L: usize> {
    pub(crate) coefs: [N::Coef; L],
}

stored!([N: Number, const L: usize] Row<N, L> { coefs });

impl<N: Number, const L: usize> Row<N, L> {
    /// Quantises factors in SI for signals of the full scales `2^from` and a sum of the full scale `2^to`, which must hold
    /// each factor times its signal's full scale ([`Row::exponent`]).
    pub(crate) fn build(factors: [f64; L], from: [i32; L], to: i32) -> Self {
        Self { coefs: core::array::from_fn(|i| N::coef(N::rescaled(factors[i], from[i] - to))) }
    }

    /// Exponent of the smallest full scale that a row of these factors may have.
    pub(crate) fn exponent(factors: [f64; L], from: [i32; L]) -> i32 {
        let terms = factors.iter().zip(from).map(|(factor, from)| N::exponent(N::rescaled(factor.abs(), from)));
        terms.fold(i32::MIN, i32::max)
    }

    /// The sum, rounded once.
    #[inline(always)]
    pub(crate) fn at(&self, signals: &[N; L]) -> N {
        N::head(self.increment(signals))
    }

    /// The sum above `base`, rounded once.
    #[inline(always)]
    pub(crate) fn above(&self, base: N::Wide, signals: &[N; L]) -> N {
        N::head(self.coefs.iter().zip(signals).fold(base, |sum, (coef, signal)| sum + *coef * *signal))
    }

    /// The sum with all its bits, to be added to a state.
    #[inline(always)]
    pub(crate) fn increment(&self, signals: &[N; L]) -> N::Wide {
        let mut products = self.coefs.iter().zip(signals).map(|(coef, signal)| *coef * *signal);
        let first = products.next().unwrap_or_default();
        products.fold(first, |sum, product| sum + product)
    }
}

/// A row whose terms may be larger than its sum's full scale; it saturates. Off the straight path: a loop that is not
/// unrolled, for the sake of the program's size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ScaledRow<N: Number, const L: usize> {
    pub(crate) coefs: [N::Coef; L],
    /// The coefficients are `2^shift` too small, so that fractions can hold them.
    pub(crate) shift: u32,
}

stored!([N: Number, const L: usize] ScaledRow<N, L> { coefs, shift });

impl<N: Number, const L: usize> ScaledRow<N, L> {
    /// As [`Row::build`], for any full scale of the sum.
    pub(crate) fn build(factors: [f64; L], from: [i32; L], to: i32) -> Self {
        let shift = (Row::<N, L>::exponent(factors, from) - to).clamp(0, 31);
        Self { coefs: Row::<N, L>::build(factors, from, to + shift).coefs, shift: shift.unsigned_abs() }
    }

    /// The sum, rounded once.
    #[inline(always)]
    pub(crate) fn at(&self, signals: &[N; L]) -> N {
        N::narrow_shifted(self.sum(signals), self.shift)
    }

    /// The sum with all its bits, to be added to a state.
    #[inline(always)]
    pub(crate) fn increment(&self, signals: &[N; L]) -> N::Wide {
        N::widen_shifted(self.sum(signals), self.shift)
    }

    #[inline(always)]
    fn sum(&self, signals: &[N; L]) -> N::Wide {
        // A call takes more than two products.
        if L > 2 { sum_of_products(&self.coefs, signals) } else { Row { coefs: self.coefs }.increment(signals) }
    }
}

/// The sums of several rows for the same signals, before their shifts: the signals stay in registers from row to row.
#[inline(never)]
pub(crate) fn sums<N: Number, const L: usize>(rows: &[ScaledRow<N, L>], signals: &[N; L], to: &mut [N::Wide]) {
    // A compiler that knew how many there are would unroll them all.
    for (sum, row) in core::hint::black_box(to).iter_mut().zip(core::hint::black_box(rows)) {
        *sum = Row { coefs: row.coefs }.increment(signals);
        keep_rolled();
    }
}

impl<N: Number> ScaledRow<N, 1> {
    /// The sum of one product, on the straight path.
    #[inline(always)]
    pub(crate) fn times(&self, signal: N) -> N {
        let [coef] = self.coefs;
        N::narrow_shifted(coef * signal, self.shift)
    }
}

#[inline(never)]
fn sum_of_products<N: Number>(coefs: &[N::Coef], signals: &[N]) -> N::Wide {
    let mut products = coefs.iter().zip(signals).map(|(coef, signal)| *coef * *signal);
    let first = products.next().unwrap_or_default();
    products.fold(first, |sum, product| sum + product)
}

/// In a loop off the straight path: the compiler does not repeat its body, for the sake of the program's size. No
/// instruction.
#[inline(always)]
pub(crate) fn keep_rolled() {
    core::hint::black_box(());
}
