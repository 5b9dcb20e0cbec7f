//! One step of the chain, exact for inputs that run along a line.

use std::cell::OnceCell;

use nalgebra::DMatrix;

use super::Physics;
use super::chain::{Chain, INPUTS};
use super::lanes::Lanes;

/// Longest full step [s].
const LONGEST_STEP_S: f64 = 1.2e-3;
/// Into how many steps a full one is divided.
pub(super) const DIVISIONS: [u32; 3] = [1, 6, 16];

/// The steps of one prediction.
#[allow(clippy::struct_field_names, reason = "full steps are one kind of them")]
pub(super) struct Steps<'a, const N: usize> {
    pub(super) physics: &'a Physics,
    period_s: f64,
    /// Full steps a row.
    pub(super) full_steps: u32,
    /// By division.
    pub(super) free: [Step<N, 1>; 3],
    held: OnceCell<[Step<N, 1>; 3]>,
    /// The row that gives the motor's command.
    pub(super) command: [f64; N],
    /// `T_m` jumps by this where theta' does [N m s/rad].
    pub(super) jump: f64,
}

impl<'a, const N: usize> Steps<'a, N> {
    pub(super) fn new(physics: &'a Physics, period_s: f64) -> Self {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few")]
        let full_steps = (period_s / LONGEST_STEP_S).ceil().max(1.0) as u32;
        let chain = Chain::new(physics, false);
        let command = std::array::from_fn(|state| chain.command[state]);
        let free = Self::divided(&chain, period_s / f64::from(full_steps));
        Self { physics, period_s, full_steps, free, held: OnceCell::new(), command, jump: chain.jump }
    }

    /// The same with the float on a stop.
    pub(super) fn held(&self) -> &[Step<N, 1>; 3] {
        let full_s = self.period_s / f64::from(self.full_steps);
        self.held.get_or_init(|| Self::divided(&Chain::new(self.physics, true), full_s))
    }

    fn divided(chain: &Chain, full_s: f64) -> [Step<N, 1>; 3] {
        DIVISIONS.map(|parts| Step::new(chain, full_s / f64::from(parts)))
    }
}

/// `x(h) = A x + B0 u(0) + B1 u(h)`, column by column.
#[derive(Debug, Clone)]
pub(super) struct Step<const N: usize, const L: usize> {
    pub(super) state: [[Lanes<L>; N]; N],
    pub(super) start: [[Lanes<L>; N]; INPUTS],
    pub(super) end: [[Lanes<L>; N]; INPUTS],
}

impl<const N: usize> Step<N, 1> {
    pub(super) fn new(chain: &Chain, step_s: f64) -> Self {
        // d/dt (x, u, h u') = (A x + B u, u' h / h, 0)
        let mut block = DMatrix::zeros(N + 2 * INPUTS, N + 2 * INPUTS);
        block.view_mut((0, 0), (N, N)).copy_from(&(step_s * &chain.slope));
        block.view_mut((0, N), (N, INPUTS)).copy_from(&(step_s * &chain.drive));
        for input in 0..INPUTS {
            block[(N + input, N + INPUTS + input)] = 1.0;
        }
        let exact = exponential(&block);
        let of = |row: usize, column: usize| Lanes::all(exact[(row, column)]);
        let (held, ramp) = (N, N + INPUTS);
        Self {
            state: columns(of),
            start: columns(|row, input| of(row, held + input) - of(row, ramp + input)),
            end: columns(|row, input| of(row, ramp + input)),
        }
    }
}

/// Columns from their elements by row and column.
fn columns<const N: usize, const M: usize, const L: usize>(
    of: impl Fn(usize, usize) -> Lanes<L>,
) -> [[Lanes<L>; N]; M] {
    std::array::from_fn(|column| std::array::from_fn(|row| of(row, column)))
}

#[allow(clippy::needless_range_loop, reason = "column by column, as the equation has it")]
impl<const N: usize, const L: usize> Step<N, L> {
    /// Side by side.
    pub(super) fn beside(steps: [&Step<N, 1>; L]) -> Self {
        let beside = |of: &dyn Fn(&Step<N, 1>) -> f64| Lanes::each(|lane| of(steps[lane]));
        Self {
            state: columns(|row, column| beside(&|step| step.state[column][row][0])),
            start: columns(|row, column| beside(&|step| step.start[column][row][0])),
            end: columns(|row, column| beside(&|step| step.end[column][row][0])),
        }
    }

    /// `A x + B0 u`.
    #[inline(always)]
    pub(super) fn free(&self, x: &[Lanes<L>; N], u: &[Lanes<L>; INPUTS]) -> [Lanes<L>; N] {
        let mut next = [Lanes::all(0.0); N];
        for column in 0..N {
            add(&mut next, &self.state[column], x[column]);
        }
        for input in 0..INPUTS {
            if u[input].any(u[input], |value, _| value != 0.0) {
                add(&mut next, &self.start[input], u[input]);
            }
        }
        next
    }
}

/// `next += value * column`.
#[allow(clippy::needless_range_loop, reason = "row by row, as the compiler's vectors have it")]
#[inline(always)]
pub(super) fn add<const N: usize, const L: usize>(next: &mut [Lanes<L>; N], column: &[Lanes<L>; N], value: Lanes<L>) {
    for row in 0..N {
        next[row] = column[row].mul_add(value, next[row]);
    }
}

/// Matrix exponential: scaling, Taylor series, squaring.
fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let n = matrix.nrows();
    let norm = matrix.abs().row_sum().max();
    let mut squarings = 0;
    let mut scale = 1.0;
    while norm * scale > 0.25 {
        scale *= 0.5;
        squarings += 1;
    }
    let small = matrix * scale;
    let mut term = DMatrix::identity(n, n);
    let mut sum = term.clone();
    for order in 1..=12 {
        term = &term * &small / f64::from(order);
        sum += &term;
    }
    for _ in 0..squarings {
        sum = &sum * &sum;
    }
    sum
}
