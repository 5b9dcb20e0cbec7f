//! Response of an exponential to a straight line, for any part of a period.

use crate::number::Number;
use crate::stored::{Reader, Stored, Writer};

/// `(e^(x h) - 1 - x h) / (x h)^2` for `0 <= h <= 1`, a polynomial in h.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Curve<N: Number>([N; CURVE]);

impl<N: Number> Stored for Curve<N> {
    const LEN: usize = <[N; CURVE]>::LEN;
    const BLANK: Self = Self(Stored::BLANK);

    fn store(&self, writer: &mut Writer<'_>) {
        self.0.store(writer);
    }

    fn load(&mut self, reader: &mut Reader<'_>) {
        self.0.load(reader);
    }
}

const CURVE: usize = 7;
/// Curves and exponents are held in a full scale of 8.
const CURVE_SCALE: i32 = 3;
/// Takes a product with a curve back to the other factor's full scale.
pub(super) const CURVE_SHIFT: u32 = CURVE_SCALE.unsigned_abs();

impl<N: Number> Curve<N> {
    /// Interpolates at Chebyshev's points of 0..1; a lag faster than an eighth of the period counts as one of that.
    pub(super) fn build(exponent: f64) -> Self {
        let x = exponent.max(-8.0);
        let exact = |h: f64| {
            let y = x * h;
            if y > -1e-3 { 0.5 + y / 6.0 + y * y / 24.0 } else { (libm::expm1(y) - y) / (y * y) }
        };
        let node = |i: usize| 0.5 - 0.5 * libm::cos(core::f64::consts::PI * (i as f64 + 0.5) / CURVE as f64);
        // Newton's divided differences, then the polynomial's own coefficients from the innermost bracket outwards.
        let mut differences: [f64; CURVE] = core::array::from_fn(|i| exact(node(i)));
        for level in 1..CURVE {
            for i in (level..CURVE).rev() {
                differences[i] = (differences[i] - differences[i - 1]) / (node(i) - node(i - level));
            }
        }
        let mut powers = [0.0; CURVE];
        for i in (0..CURVE).rev() {
            for j in (1..CURVE).rev() {
                powers[j] = powers[j - 1] - node(i) * powers[j];
            }
            powers[0] = differences[i] - node(i) * powers[0];
        }
        Self(powers.map(|power| N::quantise(power, CURVE_SCALE)))
    }

    pub(super) fn at(&self, rest: N) -> N {
        let mut value = N::ZERO;
        for power in self.0.iter().rev() {
            value = value.times(rest) + *power;
        }
        value
    }
}
