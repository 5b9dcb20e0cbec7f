//! The corners of the friction's clamp at the slip rate, and what they have more where they are round.
//!
//! ```text
//! share(x) = clamp(x) + wide (tanh x - clamp(x)) + tails (x / (1 + x^2)^(1/2) - clamp(x))              x = w / w_s
//!            - sgn x (middle q(x, 1) + narrow q(x, 0.35))
//! q(x, h) = max(0, h - ||x| - 1|)^2 / (4 h)
//! ```
//!
//! tanh is Lambert's continued fraction to its eleventh place, which is 2e-9 off where it ends.
//!
//! With the three but for the tails `x / (1 + |x|^n)^(1/n)` for n from 3 on, and `ln(cosh(b (x + 1)) / cosh(b (x - 1))) / 2 b` for b from 2
//! on, are met to 0.01.

use super::lanes::Lanes;

/// So many slip rates away a round corner without tails is none any more.
pub(super) const NO_CORNER: f64 = 5.0;
/// Half widths of the corners that are round by a parabola.
const MIDDLE: f64 = 1.0;
const NARROW: f64 = 0.35;

/// How round the clamp's corners are, in shares of four shapes; the clamp as it is has none of any.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Corner {
    /// Of a hyperbolic tangent.
    pub wide: f64,
    /// Of a parabola from zero rate to twice the slip rate.
    pub middle: f64,
    /// Of a parabola a third of that.
    pub narrow: f64,
    /// Of a root, which is never quite at its end.
    pub tails: f64,
}

impl Corner {
    /// Whether it is round at all.
    pub(super) fn is_round(&self) -> bool {
        *self != Self::default()
    }

    /// Whether it goes on beyond [`NO_CORNER`].
    pub(super) fn has_tails(&self) -> bool {
        self.tails.abs() > 0.0
    }

    /// Its integral from 0 to a rate that is not below.
    pub(super) fn rounded_area(&self, x: f64) -> f64 {
        let clamp = |x: f64| if x > 1.0 { x - 0.5 } else { 0.5 * x * x };
        let near = x.min(NO_CORNER);
        let parabola = |half: f64| {
            let rising = (near - 1.0 + half).clamp(0.0, half).powi(3);
            let falling = half.powi(3) - (half - (near - 1.0).clamp(0.0, half)).powi(3);
            (rising + falling) / (12.0 * half)
        };
        let tails = if self.has_tails() { self.tails * ((1.0 + x * x).sqrt() - 1.0 - clamp(x)) } else { 0.0 };
        tails + self.wide * (near.cosh().ln() - clamp(near))
            - self.middle * parabola(MIDDLE)
            - self.narrow * parabola(NARROW)
    }
}

/// The corners of several clamps, side by side.
pub(super) struct Corners<const L: usize> {
    wide: Lanes<L>,
    middle: Lanes<L>,
    narrow: Lanes<L>,
    tails: Lanes<L>,
    is_round: bool,
    has_tails: bool,
}

impl<const L: usize> Corners<L> {
    pub(super) fn new(all: [Corner; L]) -> Self {
        let of = |of: &dyn Fn(&Corner) -> f64| Lanes::each(|lane| of(&all[lane]));
        Self {
            wide: of(&|own| own.wide),
            middle: of(&|own| own.middle),
            narrow: of(&|own| own.narrow),
            tails: of(&|own| own.tails),
            is_round: all.iter().any(Corner::is_round),
            has_tails: all.iter().any(Corner::has_tails),
        }
    }

    /// Whether any of the rates is near a round corner.
    #[inline(always)]
    pub(super) fn are_round_at(&self, x: Lanes<L>) -> bool {
        self.is_round && (self.has_tails || x.any(x, |x, _| x.abs() < NO_CORNER))
    }

    /// What they have more than a clamp.
    #[inline(always)]
    pub(super) fn rounding(&self, x: Lanes<L>) -> Lanes<L> {
        let (away, clamp, zero) = (x.abs(), x.within(1.0), Lanes::all(0.0));
        let mut round = zero;
        if self.has_tails {
            round = self.tails * (x / (x * x + 1.0).map(f64::sqrt) - clamp);
        }
        if away.any(away, |away, _| away < NO_CORNER) {
            let parabola = |half: f64| {
                let near = half - (away - 1.0).abs();
                let near = near.above(zero, near, zero);
                near * near * (0.25 / half)
            };
            let parabolas = self.middle * parabola(MIDDLE) + self.narrow * parabola(NARROW);
            let near = self.wide * (tanh(x) - clamp) - x.signum() * parabolas;
            round += Lanes::all(NO_CORNER).above(away, near, zero);
        }
        round
    }
}

/// Hyperbolic tangent up to [`NO_CORNER`].
#[inline(always)]
fn tanh<const L: usize>(x: Lanes<L>) -> Lanes<L> {
    let square = x * x;
    let series = |first: f64, others: [f64; 5]| {
        let mut sum = Lanes::all(first);
        for factor in others {
            sum = sum.mul_add(square, Lanes::all(factor));
        }
        sum
    };
    let above = series(1.0, [2_145.0, 675_675.0, 64_324_260.0, 1_964_187_225.0, 13_749_310_575.0]);
    let below = series(66.0, [45_045.0, 7_567_560.0, 413_513_100.0, 6_547_290_750.0, 13_749_310_575.0]);
    x * above / below
}

#[cfg(test)]
mod tests {
    use super::{Corner, Corners, NO_CORNER, tanh};
    use crate::simulate::lanes::{Lanes, within};

    const ALL: Corner = Corner { wide: 0.7, middle: 0.4, narrow: -0.3, tails: 0.0 };

    fn rounding(corner: Corner, x: f64) -> f64 {
        Corners::new([corner]).rounding(Lanes::all(x))[0]
    }

    #[test]
    fn closed_form_round_corners_meet_other_laws_and_end() {
        let tangent = Corner { wide: 1.0, ..Corner::default() };
        let cosh = Corner { middle: 0.067, narrow: 0.789, ..Corner::default() };
        let power = Corner { wide: 0.058, narrow: 0.768, ..Corner::default() };
        let root = Corner { tails: 1.0, ..Corner::default() };
        for x in [-4.7, -1.2, -1.0, -0.8, 0.0, 0.5, 0.95, 1.0, 1.1, 1.7, 2.9, 3.0, 7.0_f64] {
            let laws = [
                (tangent, x.tanh()),
                (cosh, ((4.0 * (x + 1.0)).cosh() / (4.0 * (x - 1.0)).cosh()).ln() / 8.0),
                (power, x / (1.0 + x.abs().powi(8)).powf(0.125)),
                (root, x / (1.0 + x * x).sqrt()),
            ];
            for (corner, law) in laws {
                let round = rounding(corner, x) + within(x, 1.0);
                assert!((round - law).abs() < 0.01, "{x}: {round}, {law}");
            }
            assert!((rounding(ALL, x) + rounding(ALL, -x)).abs() < 1e-15);
        }
        for x in (0..=50).map(|k| 0.1 * f64::from(k)) {
            assert!((tanh(Lanes::<1>::all(x))[0] - x.tanh()).abs() < 2e-9, "{x}");
        }
        assert!(rounding(ALL, NO_CORNER).abs() < 1e-15 && rounding(ALL, 1e3).abs() < 1e-15);
    }

    #[test]
    fn closed_form_their_area_is_what_they_add_up_to() {
        let (all, step) = (Corner { tails: -0.2, ..ALL }, 1e-4);
        let mut area = 0.0;
        for k in 0..70_000 {
            let x = step * f64::from(k);
            assert!((all.rounded_area(x) - area).abs() < 1e-7, "{x}");
            area += step * rounding(all, x + 0.5 * step);
        }
    }
}
