//! Velocity and position error, equation (7), in sums that do not drift.
//!
//! ```text
//! dv = (a_y phi, -a_x phi)      v = integral dv dt      p = integral v dt                (7)
//! ```
//!
//! Both integrals are trapezoidal. Each product is counted in whole units, what is left over is carried to the next
//! period, and the counts are added as 64-bit and 128-bit integers: hours of small increments lose nothing. The sums
//! saturate.

use crate::number::Number;
use crate::units::Units;

/// Sums of one axis pair.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct State<N: Number> {
    /// What the last count left over.
    carry: [N; 2],
    /// Counts of the last row.
    last: [i32; 2],
    sums: Sums,
}

/// Velocity and position error as whole counts: exact, comparable, and turned into SI by
/// [`Law`](crate::Law)'s `velocity_error_mps` and `position_error_m`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Sums {
    /// Velocity error, two halves to a count times the period.
    pub velocity: [i64; 2],
    /// Position error, four quarters to a count times the period squared.
    pub position: [i128; 2],
}

/// How counts are made and read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// Counts in a product of 1 m/s2 and 1 rad.
    scale: N::Coef,
    /// One count [m/s2].
    count_mps2: f64,
    period_s: f64,
}

impl<N: Number> Law<N> {
    pub(crate) fn build(units: &Units, largest_accel: f64, period_s: f64) -> Self {
        // The same count in both number systems: 2^-31 of the full scales' product.
        let exponent = libm::frexp(largest_accel).1.max(units.accel + units.gimbal_angle) - 31;
        Self { scale: N::coef(libm::ldexp(1.0, -exponent)), count_mps2: libm::ldexp(1.0, exponent), period_s }
    }

    /// Takes the first row: no interval yet.
    pub(crate) fn start(&self, state: &mut State<N>, accel: [N; 2], gimbal_angle: N) {
        state.last = self.count(state, accel, gimbal_angle);
    }

    /// Adds one period; false if a sum saturated.
    #[inline(always)]
    pub(crate) fn step(&self, state: &mut State<N>, accel: [N; 2], gimbal_angle: N) -> bool {
        let now = self.count(state, accel, gimbal_angle);
        let mut exact = true;
        let Sums { velocity, position } = &mut state.sums;
        let pairs = velocity.iter_mut().zip(position).zip(state.last.iter().zip(&now));
        for ((velocity, position), (last, now)) in pairs {
            let (next, velocity_over) = velocity.overflowing_add(i64::from(*last) + i64::from(*now));
            let (sum, position_over) = position.overflowing_add(i128::from(*velocity) + i128::from(next));
            if velocity_over || position_over {
                exact = false;
            } else {
                *velocity = next;
                *position = sum;
            }
        }
        state.last = now;
        exact
    }

    #[inline(always)]
    fn count(&self, state: &mut State<N>, [accel_x, accel_y]: [N; 2], gimbal_angle: N) -> [i32; 2] {
        [
            N::count(accel_y, gimbal_angle, self.scale, &mut state.carry[0]),
            N::count(-accel_x, gimbal_angle, self.scale, &mut state.carry[1]),
        ]
    }

    /// v [m/s].
    pub(crate) fn velocity_error_mps(&self, sums: &Sums) -> [f64; 2] {
        sums.velocity.map(|halves| halves as f64 * (0.5 * self.count_mps2 * self.period_s))
    }

    /// p [m].
    pub(crate) fn position_error_m(&self, sums: &Sums) -> [f64; 2] {
        sums.position.map(|quarters| quarters as f64 * (0.25 * self.count_mps2 * self.period_s * self.period_s))
    }
}

impl<N: Number> State<N> {
    pub(crate) fn sums(&self) -> Sums {
        self.sums
    }

    /// Every field, for saving.
    pub(crate) fn parts(&mut self) -> (&mut [N; 2], &mut [i32; 2], &mut Sums) {
        (&mut self.carry, &mut self.last, &mut self.sums)
    }
}
