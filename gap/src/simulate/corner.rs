//! The corners of the friction's clamp at the slip rate, and what they have more where they are round.

use super::lanes::within;

/// So many slip rates away a round corner is none any more.
pub(super) const NO_CORNER: f64 = 3.0;

/// What round corners have more than a clamp: `x (27 + x^2) / (27 + 9 x^2)` up to 3, a hyperbolic tangent within 2.4 %, and 1
/// from there.
#[inline(always)]
pub(super) fn rounding(x: f64) -> f64 {
    let near = within(x, NO_CORNER);
    let square = near * near;
    near * (27.0 + square) / (27.0 + 9.0 * square) - within(x, 1.0)
}

/// Its integral from 0 to a rate that is not below.
pub(super) fn rounded_area(x: f64) -> f64 {
    let near = x.min(NO_CORNER);
    let round = (0.5 * near * near + 12.0 * (near * near / 3.0).ln_1p()) / 9.0;
    let hard = if near > 1.0 { near - 0.5 } else { 0.5 * near * near };
    round - hard
}

#[cfg(test)]
mod tests {
    use super::{NO_CORNER, rounded_area, rounding};
    use crate::simulate::lanes::within;

    #[test]
    fn closed_form_round_corners_are_a_hyperbolic_tangent_and_end() {
        for x in [-2.7, -1.0, -0.3, 0.0, 0.5, 1.0, 1.7, 2.9, 3.0, 7.0] {
            let round = rounding(x) + within(x, 1.0);
            assert!((round - f64::tanh(x)).abs() < 0.024, "{x}: {round}");
        }
        assert!(rounding(NO_CORNER).abs() < 1e-15 && rounding(1e3).abs() < 1e-15);
    }

    #[test]
    fn closed_form_their_area_is_what_they_add_up_to() {
        let step = 1e-4;
        let mut area = 0.0;
        for k in 0..50_000 {
            let x = step * f64::from(k);
            assert!((rounded_area(x) - area).abs() < 1e-7, "{x}");
            area += step * rounding(x + 0.5 * step);
        }
    }
}
