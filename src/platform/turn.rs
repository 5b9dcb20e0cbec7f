//! Sine and cosine of a gimbal angle, and turns about one axis.
//!
//! ```text
//! sin(pi/2 v) = v (pi/2 - (pi/2)^3 v^2 / 3! + ... - (pi/2)^11 v^10 / 11!)      |v| <= 1      to 6e-8
//! ```

use core::f64::consts::{FRAC_PI_2, PI};

use crate::number::Number;
use crate::row::ScaledRow;

/// Full scale of gimbal angles: 4 rad.
pub(crate) const ANGLE_SCALE: i32 = 2;

/// Sine and cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turn<N> {
    sine: N,
    pub(crate) cosine: N,
}

/// The series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// Quarter turns, of the full scale 2.
    quarters: ScaledRow<N, 1>,
    /// Factors of `v^2, v^4 ... v^10`, and `pi/2 - 1`.
    terms: [N; 5],
    first: N,
    half_turn: N,
    one: N,
    two: N,
}

impl<N: Number> Law<N> {
    pub(crate) fn build() -> Self {
        let mut term = FRAC_PI_2;
        let terms = core::array::from_fn(|k| {
            let order = 2.0 * (k as f64) + 2.0;
            term *= -FRAC_PI_2 * FRAC_PI_2 / (order * (order + 1.0));
            N::quantise(term, 0)
        });
        Self {
            quarters: ScaledRow::build([1.0 / FRAC_PI_2], [ANGLE_SCALE], 1),
            terms,
            first: N::quantise(FRAC_PI_2 - 1.0, 0),
            half_turn: N::quantise(PI + 1e-6, ANGLE_SCALE),
            one: N::quantise(1.0, 1),
            two: N::quantise(2.0, 1),
        }
    }

    /// Whether an angle is a number within a half turn.
    pub(crate) fn admits(&self, angle: N) -> bool {
        angle.within(self.half_turn)
    }

    /// Of an angle within a half turn.
    pub(crate) fn of(&self, angle: N) -> Turn<N> {
        let quarters = self.quarters.times(angle);
        let size = quarters.abs();
        let folded = if size > self.one { self.two - size } else { size };
        let sine = self.sine(folded.shift_up(1));
        Turn { sine: if quarters < N::ZERO { -sine } else { sine }, cosine: self.sine((self.one - size).shift_up(1)) }
    }

    /// `sin(pi/2 v)`.
    fn sine(&self, v: N) -> N {
        let square = v.times(v);
        let [a, b, c, d, e] = self.terms;
        let tail = a + square.times(b + square.times(c + square.times(d + square.times(e))));
        v + v.times(self.first + square.times(tail))
    }
}

impl<N: Number> Turn<N> {
    pub(crate) const NONE: Self = Self { sine: N::ZERO, cosine: N::ONE };

    /// What an axis fixed inside sees, from outside: `v` turned right-handed about axis `about`.
    pub(crate) fn outward(&self, v: [N; 3], about: usize) -> [N; 3] {
        self.turn(v, about, self.sine)
    }

    /// The other way.
    pub(crate) fn inward(&self, v: [N; 3], about: usize) -> [N; 3] {
        self.turn(v, about, -self.sine)
    }

    fn turn(&self, v: [N; 3], about: usize, sine: N) -> [N; 3] {
        let (i, j) = across(about);
        let mut turned = v;
        turned[i] = N::narrow(v[i].product(self.cosine) - v[j].product(sine));
        turned[j] = N::narrow(v[i].product(sine) + v[j].product(self.cosine));
        turned
    }

    /// [`Turn::inward`] with all bits, of a small change to be added up.
    pub(crate) fn inward_wide(&self, v: [N; 3], about: usize) -> [N::Wide; 3] {
        let (i, j) = across(about);
        let mut turned = v.map(N::widen);
        turned[i] = v[i].product(self.cosine) + v[j].product(self.sine);
        turned[j] = v[j].product(self.cosine) - v[i].product(self.sine);
        turned
    }
}

/// The two axes across one, in cyclic order.
pub(crate) fn across(axis: usize) -> (usize, usize) {
    ((axis + 1) % 3, (axis + 2) % 3)
}
