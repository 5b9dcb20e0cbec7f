//! Velocity and position error, equation (7), in sums that do not drift.
//!
//! ```text
//! dv = (a_y phi, -a_x phi)      v = integral dv dt      p = integral v dt                (7)
//! ```
//!
//! Both integrals are trapezoidal. Each product is counted in whole units, what is left over is carried to the next
//! row, and the counts are added as integers: hours of small increments lose nothing. What is added are plain sums,
//! `r = sum g` of the products g and `q = sum r`; the trapezoids' half ends are taken out when a result is read,
//! `v = T (r - g/2)` and `p = T^2 (q - r/2) - T v/2`, since the first product is zero. The sums along y are those of
//! `a_x phi`, and change sign when they are read.
//!
//! A count is the power of two at which 64 bits hold a position error of 1e8 m: 2^-16 m/s2 at 1 kHz. A velocity includes
//! what is carried; a position is off by less than a count's velocity, 1.5e-8 m/s at 1 kHz, times the time.

use crate::number::Number;
use crate::stored::stored;
use crate::units::Units;

/// Sums of one axis pair: `a_y phi`, then `a_x phi`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct State<N: Number>(pub(crate) [Sums<N>; 2]);

/// Plain sums of whole counts.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(C)]
pub(crate) struct Sums<N: Number> {
    /// r
    pub(crate) velocity: i64,
    /// q
    pub(crate) position: i64,
    /// What the last count left over.
    pub(crate) carry: N::Carry,
}

/// How counts are made and read.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Law<N: Number> {
    pub(crate) scale: N::CountScale,
    /// One count [m/s2].
    count_mps2: f64,
    period_s: f64,
}

stored!([N: Number] Law<N> { scale, count_mps2, period_s });

/// Position error that the sums hold [m].
const LARGEST_POSITION_M: f64 = 1e8;

impl<N: Number> Law<N> {
    pub(crate) fn build(units: &Units, largest_accel: f64, period_s: f64) -> Self {
        let enough = libm::frexp(LARGEST_POSITION_M / (period_s * period_s)).1 - 63;
        // A count of one product is an i32.
        let product = libm::frexp(largest_accel).1.max(units.accel + units.gimbal_angle);
        let exponent = enough.max(product - 30);
        Self {
            scale: N::count_scale(exponent, units.accel + units.gimbal_angle),
            count_mps2: libm::ldexp(1.0, exponent),
            period_s,
        }
    }

    /// Adds the product at one row.
    #[inline(always)]
    pub(crate) fn step(&self, state: &mut State<N>, [accel_x, accel_y]: [N; 2], gimbal_angle: N) {
        let scaled = N::coarse_scaled(gimbal_angle, self.scale);
        for (sums, accel) in state.0.iter_mut().zip([accel_y, accel_x]) {
            let count = N::count_coarse(accel, scaled, self.scale, &mut sums.carry);
            sums.velocity = sums.velocity.wrapping_add(i64::from(count));
            sums.position = sums.position.wrapping_add(sums.velocity);
        }
    }

    /// v [m/s]; `products` are the products at the last row [rad m/s2].
    pub(crate) fn velocity_error_mps(&self, state: &State<N>, products: [f64; 2]) -> [f64; 2] {
        core::array::from_fn(|axis| {
            let sums = &state.0[axis];
            let counts = sums.velocity as f64 + N::carried(sums.carry, self.scale);
            self.period_s * (SIGNS[axis] * counts * self.count_mps2 - 0.5 * products[axis])
        })
    }

    /// p [m].
    pub(crate) fn position_error_m(&self, state: &State<N>, products: [f64; 2]) -> [f64; 2] {
        let velocity = self.velocity_error_mps(state, products);
        core::array::from_fn(|axis| {
            let sums = &state.0[axis];
            let counts = SIGNS[axis] * (sums.position as f64 - 0.5 * sums.velocity as f64);
            self.period_s * (self.period_s * self.count_mps2 * counts - 0.5 * velocity[axis])
        })
    }
}

/// Of the sums, for (7).
const SIGNS: [f64; 2] = [1.0, -1.0];
