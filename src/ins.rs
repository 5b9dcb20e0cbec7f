//! Velocity and position error, equation (7), in sums that do not drift.
//!
//! ```text
//! dv = (a_y phi, -a_x phi)      v = integral dv dt      p = integral v dt                (7)
//! ```
//!
//! Both integrals are trapezoidal. Each product is counted in whole units, what is left over is carried to the next
//! row, and the counts are added as 64-bit and 128-bit integers: hours of small increments lose nothing. What is added
//! are plain sums, `r = sum g` of the products g and `q = sum r`; the trapezoids' half ends are taken out when a result
//! is read, `v = T (r - g/2)` and `p = T^2 (q - r/2) - T v/2`, since the first product is zero.
//!
//! A count is at most 2^30, so that the sums are full after 2^33 rows: 99 days at 1 kHz.

use crate::number::Number;
use crate::units::Units;

/// Sums of one axis pair.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct State<N: Number> {
    /// What the last count left over.
    carry: [N; 2],
    sums: Sums,
}

/// Plain sums of whole counts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Sums {
    /// r
    pub(crate) velocity: [i64; 2],
    /// q
    pub(crate) position: [i128; 2],
}

/// How counts are made and read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// Counts in a product of 1 m/s2 and 1 rad.
    pub(crate) scale: N::Coef,
    /// One count [m/s2].
    count_mps2: f64,
    period_s: f64,
}

impl<N: Number> Law<N> {
    pub(crate) fn build(units: &Units, largest_accel: f64, period_s: f64) -> Self {
        // The same count in both number systems: 2^-30 of the full scales' product.
        let exponent = libm::frexp(largest_accel).1.max(units.accel + units.gimbal_angle) - 30;
        Self { scale: N::coef(libm::ldexp(1.0, -exponent)), count_mps2: libm::ldexp(1.0, exponent), period_s }
    }

    /// Adds the product at one row.
    #[inline(always)]
    pub(crate) fn step(&self, state: &mut State<N>, [accel_x, accel_y]: [N; 2], gimbal_angle: N) {
        let scaled = N::count_scaled(gimbal_angle, self.scale);
        let counts = [N::count(accel_y, scaled, &mut state.carry[0]), N::count(-accel_x, scaled, &mut state.carry[1])];
        let Sums { velocity, position } = &mut state.sums;
        for ((velocity, position), count) in velocity.iter_mut().zip(position).zip(counts) {
            *velocity = velocity.wrapping_add(i64::from(count));
            *position = position.wrapping_add(i128::from(*velocity));
        }
    }

    /// v [m/s]; `products` are the products at the last row [rad m/s2].
    pub(crate) fn velocity_error_mps(&self, state: &State<N>, products: [f64; 2]) -> [f64; 2] {
        core::array::from_fn(|axis| {
            let sum = state.sums.velocity[axis] as f64 * self.count_mps2;
            self.period_s * (sum - 0.5 * products[axis])
        })
    }

    /// p [m].
    pub(crate) fn position_error_m(&self, state: &State<N>, products: [f64; 2]) -> [f64; 2] {
        let velocity = self.velocity_error_mps(state, products);
        core::array::from_fn(|axis| {
            let halves = 2 * state.sums.position[axis] - i128::from(state.sums.velocity[axis]);
            0.5 * self.period_s * (self.period_s * self.count_mps2 * halves as f64 - velocity[axis])
        })
    }
}

impl<N: Number> State<N> {
    /// Every field, for saving.
    pub(crate) fn parts(&mut self) -> (&mut [N; 2], &mut Sums) {
        (&mut self.carry, &mut self.sums)
    }
}
