//! Vectors from one gimbal's axes into the next one's.
//!
//! A vector outside of a gimbal is the one inside, turned by the gimbal's angle. The vehicle's rate w turns the bearings:
//! with the stable member at rest
//!
//! ```text
//! w = r_o e_o + r_m e_m + r_i e_i      r_o = w_o / cos b      r_m = w_m      r_i = w_i - r_o (e_o . e_i)
//! ```
//!
//! in the axes of the middle gimbal, b its angle; r is the rate of what carries a gimbal against it, about its axis.

use super::turn::Turn;
use crate::number::Number;

/// Places of the outer, the middle and the inner gimbal's axis in a vector.
pub(crate) type Order = [usize; 3];

/// The gimbal angles of one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Resolver<N> {
    pub(crate) outer: Turn<N>,
    pub(crate) middle: Turn<N>,
    pub(crate) inner: Turn<N>,
}

impl<N: Number> Resolver<N> {
    /// Specific force in the axes of the outer, the middle and the inner gimbal.
    pub(crate) fn forces(&self, [_, middle, inner]: Order, accel: [N; 3]) -> [[N; 3]; 3] {
        let of_middle = self.inner.outward(accel, inner);
        [self.middle.outward(of_middle, middle), of_middle, accel]
    }

    /// Rates of the outer, the middle and the inner bearing; `least` is the least cosine of the middle angle that counts.
    pub(crate) fn bearing_rates(&self, order: Order, vehicle_rate: [N; 3], least: N) -> [N; 3] {
        let [outer, middle, inner] = order;
        let rate = self.middle.inward(self.outer.inward(vehicle_rate, outer), middle);
        let mut unit = [N::ZERO; 3];
        unit[outer] = N::ONE;
        let along = self.middle.inward(unit, middle);
        let cosine = self.middle.cosine;
        let of_outer = if cosine < N::ZERO {
            quotient(-rate[outer], (-cosine).most(least))
        } else {
            quotient(rate[outer], cosine.most(least))
        };
        [of_outer, rate[middle], rate[inner] - of_outer.times(along[inner])]
    }
}

/// Saturates where a signal of fractions would overflow.
fn quotient<N: Number>(value: N, divisor: N) -> N {
    if N::HAS_SCALES && value.abs() > divisor {
        return if value < N::ZERO { -N::ONE } else { N::ONE };
    }
    value.ratio(divisor)
}
