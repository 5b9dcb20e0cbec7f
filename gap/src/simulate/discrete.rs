//! One step of the chain, exact for inputs that run along a line.

use nalgebra::DMatrix;

use super::chain::{Chain, INPUTS};

/// `x(h) = A x + B0 u(0) + B1 u(h)`, column by column.
#[derive(Debug, Clone)]
pub(crate) struct Step<const N: usize> {
    pub(crate) state: [[f64; N]; N],
    pub(crate) start: [[f64; N]; INPUTS],
    pub(crate) end: [[f64; N]; INPUTS],
}

impl<const N: usize> Step<N> {
    pub(crate) fn new(chain: &Chain, step_s: f64) -> Self {
        // d/dt (x, u, h u') = (A x + B u, u' h / h, 0)
        let mut block = DMatrix::zeros(N + 2 * INPUTS, N + 2 * INPUTS);
        block.view_mut((0, 0), (N, N)).copy_from(&(step_s * &chain.slope));
        block.view_mut((0, N), (N, INPUTS)).copy_from(&(step_s * &chain.drive));
        for input in 0..INPUTS {
            block[(N + input, N + INPUTS + input)] = 1.0;
        }
        let exact = exponential(&block);
        let column = |from: usize| -> [f64; N] { std::array::from_fn(|row| exact[(row, from)]) };
        let ramp: [[f64; N]; INPUTS] = std::array::from_fn(|input| column(N + INPUTS + input));
        let held: [[f64; N]; INPUTS] = std::array::from_fn(|input| column(N + input));
        Self {
            state: std::array::from_fn(column),
            start: std::array::from_fn(|input| std::array::from_fn(|row| held[input][row] - ramp[input][row])),
            end: ramp,
        }
    }

    /// `A x + B0 u`.
    #[inline(always)]
    pub(crate) fn free(&self, x: &[f64; N], u: &[f64; INPUTS]) -> [f64; N] {
        let mut next = [0.0; N];
        for (column, value) in self.state.iter().zip(x) {
            add(&mut next, column, *value);
        }
        for (column, value) in self.start.iter().zip(u) {
            if *value != 0.0 {
                add(&mut next, column, *value);
            }
        }
        next
    }
}

/// `next += value * column`.
#[inline(always)]
pub(crate) fn add<const N: usize>(next: &mut [f64; N], column: &[f64; N], value: f64) {
    for (next, column) in next.iter_mut().zip(column) {
        *next += column * value;
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
