//! The INS sums of all lanes: 64-bit parts since the last time they were added to the whole.
//!
//! With `r0`, `q0` the whole at that time and s the sum of counts since then, `r = r0 + s` and, n rows later,
//! `q = q0 + n r0 + sum s`. A count is at most 2^31, so that 2^16 rows of parts stay below 2^62.

use crate::ins;
use crate::state::State;

/// Rows after which parts are added to the whole.
const ROWS: u32 = 1 << 16;

/// Parts of the sums.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(super) struct Sums<const L: usize> {
    velocity: [[i64; L]; 2],
    position: [[i64; L]; 2],
    /// Rows since all lanes were added to the whole, and how many of them a lane's whole has already.
    rows: u32,
    had: [u32; L],
}

impl<const L: usize> Sums<L> {
    pub(super) fn new() -> Self {
        Self { velocity: [[0; L]; 2], position: [[0; L]; 2], rows: 0, had: [0; L] }
    }

    /// Adds a lane's parts to the whole.
    pub(super) fn complete(&self, lane: usize, state: &mut ins::State<f32>) {
        let rows = i64::from(self.rows - self.had[lane]);
        for (axis, sums) in state.0.iter_mut().enumerate() {
            let position = sums.velocity.wrapping_mul(rows).wrapping_add(self.position[axis][lane]);
            sums.position = sums.position.wrapping_add(position);
            sums.velocity = sums.velocity.wrapping_add(self.velocity[axis][lane]);
        }
    }

    /// A lane's whole has the row to come, too.
    pub(super) fn restart(&mut self, lane: usize) {
        self.had[lane] = self.rows + 1;
        for axis in 0..2 {
            self.velocity[axis][lane] = 0;
            self.position[axis][lane] = 0;
        }
    }

    /// Adds the counts of a row.
    #[inline(always)]
    pub(super) fn add(&mut self, counts: &[[f32; L]; 2], wholes: &mut [State<f32>; L]) {
        for ((velocity, position), counts) in self.velocity.iter_mut().zip(&mut self.position).zip(counts) {
            for lane in 0..L {
                velocity[lane] += integer(counts[lane]);
                position[lane] += velocity[lane];
            }
        }
        self.rows += 1;
        if self.rows == ROWS {
            self.complete_all(wholes);
        }
    }

    #[cold]
    #[inline(never)]
    fn complete_all(&mut self, wholes: &mut [State<f32>; L]) {
        for (lane, whole) in wholes.iter_mut().enumerate() {
            self.complete(lane, &mut whole.ins);
        }
        *self = Self::new();
    }
}

/// A whole number below 2^51, read from the fraction of a double that is 1.5 * 2^52 larger.
#[allow(clippy::cast_possible_wrap, reason = "two's complement is meant")]
#[inline(always)]
fn integer(whole: f32) -> i64 {
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    (f64::from(whole) + SHIFT).to_bits().wrapping_sub(SHIFT.to_bits()) as i64
}
