//! The INS correction, equation (7), from phi as estimated: cheap sums over a block of rows, exact ones from block to block.
//!
//! ```text
//! g = (a_y phi, -a_x phi)      r = sum g      q = sum r      v = T (r - g/2)      p = T^2 (q - r/2) - T v/2      (7)
//! ```
//!
//! Within a block of B rows s = sum g and t = sum s; at its end `q += B r + t`, `r += s`, as whole counts in integers of
//! 64 and 128 bits, what is left over carried on. Hours of small increments lose nothing.

use crate::number::Number;
use crate::stored::stored;
use crate::units::Units;

/// B.
pub(crate) const BLOCK: u32 = 16;
/// Each factor is as many powers of two too small, so that a block's sums fit: t is at most `B (B + 1) / 2 = 136` products. Most
/// of them are the acceleration's, whose last bits are noise.
const ACCEL_DOWN: u32 = 5;
const ANGLE_DOWN: u32 = 3;

/// Sums of one axis pair, the sign of the second turned round.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct State<N: Number> {
    /// s and t of the block that is not complete.
    velocity: [N::Wide; 2],
    position: [N::Wide; 2],
    /// What the last counts left over, of s and of t.
    carry: [[N; 2]; 2],
    /// r and q at the end of the last block, in counts.
    counted_velocity: [i64; 2],
    counted_position: [i128; 2],
}

/// How sums are counted and read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    scale: N::Coef,
    /// Exponents of the full scale of a block's sums, and of a count.
    full: i32,
    count: i32,
    period_s: f64,
}

stored!([N: Number] Law<N> { scale, full, count, period_s });

impl<N: Number> Law<N> {
    pub(crate) fn build(units: &Units, largest_accel: f64, period_s: f64) -> Self {
        let shifted = i32::try_from(ACCEL_DOWN + ANGLE_DOWN).unwrap_or_default();
        let full = if N::HAS_SCALES { units.accel + units.gimbal_angle + shifted } else { 0 };
        // The same count in both number systems, where their full scales allow.
        let count = (libm::frexp(largest_accel).1 + shifted).max(full) - 30;
        Self { scale: N::coef(libm::ldexp(1.0, -count)), full, count, period_s }
    }

    /// Adds the products at one row.
    #[inline(always)]
    pub(crate) fn step(state: &mut State<N>, [accel_x, accel_y]: [N; 2], gimbal_angle: N) {
        let angle = gimbal_angle.shift_down(ANGLE_DOWN);
        for (i, accel) in [accel_y, accel_x].into_iter().enumerate() {
            state.velocity[i] = state.velocity[i] + accel.shift_down(ACCEL_DOWN).product(angle);
            state.position[i] = state.position[i] + state.velocity[i];
        }
    }

    /// The end of a block.
    #[inline(never)]
    pub(crate) fn close(&self, state: &mut State<N>) {
        let one = N::count_scaled(N::ONE, self.scale);
        for i in 0..2 {
            let [s, t] = [state.velocity[i], state.position[i]].map(N::head);
            let counted = state.counted_velocity[i];
            let within = i128::from(N::count(t, one, &mut state.carry[1][i]));
            let before = i128::from(counted) * i128::from(BLOCK);
            state.counted_position[i] = state.counted_position[i].wrapping_add(before).wrapping_add(within);
            state.counted_velocity[i] = counted.wrapping_add(i64::from(N::count(s, one, &mut state.carry[0][i])));
            // Bits below the signal stay.
            state.velocity[i] = state.velocity[i] - s.widen();
            state.position[i] = N::Wide::default();
        }
    }

    /// v [m/s] after `rows` of a block; `products` are those at the last row [rad m/s2].
    pub(crate) fn velocity_mps(&self, state: &State<N>, products: [f64; 2]) -> [f64; 2] {
        core::array::from_fn(|i| self.period_s * (self.rate(state, i) - 0.5 * signed(products, i)) * sign(i))
    }

    /// p [m].
    pub(crate) fn position_m(&self, state: &State<N>, rows: u32, products: [f64; 2]) -> [f64; 2] {
        core::array::from_fn(|i| {
            let counts = state.counted_position[i] + i128::from(state.counted_velocity[i]) * i128::from(rows);
            let whole = libm::ldexp(counts as f64, self.count) + N::head(state.position[i]).to_f64(self.full);
            let rate = self.rate(state, i);
            let velocity = self.period_s * (rate - 0.5 * signed(products, i));
            self.period_s * (self.period_s * (whole - 0.5 * rate) - 0.5 * velocity) * sign(i)
        })
    }

    /// r, with what the last count left over; fixed point keeps that among the bits of s.
    fn rate(&self, state: &State<N>, i: usize) -> f64 {
        let left = if N::HAS_SCALES { 0.0 } else { state.carry[0][i].to_f64(0) };
        libm::ldexp(state.counted_velocity[i] as f64 + left, self.count) + N::head(state.velocity[i]).to_f64(self.full)
    }
}

/// The second component is `-a_x phi`, and the sums are of `a_x phi`.
fn sign(i: usize) -> f64 {
    if i == 0 { 1.0 } else { -1.0 }
}

fn signed(products: [f64; 2], i: usize) -> f64 {
    products[i] * sign(i)
}
