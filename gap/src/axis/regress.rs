//! Least squares over sets of columns from Gram matrices made once, block by block: fits, held-out errors and
//! bootstrap are small solves.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::motion::BLOCKS;

/// Folds of held-out blocks; a fold is a run of neighbouring blocks.
pub(super) const FOLDS: usize = 8;

/// Gram matrices of all columns and the regressand, which stands last.
#[derive(Debug)]
pub(super) struct Grams {
    blocks: Vec<DMatrix<f64>>,
    total: DMatrix<f64>,
    training: Vec<DMatrix<f64>>,
    /// Rows of each block.
    pub(super) counts: Vec<f64>,
    /// Precision of a prior about zero, column by column.
    pub(super) precision: Vec<f64>,
}

impl Grams {
    /// Makes them; every column has the length of `target`.
    pub(super) fn new(columns: &[Vec<f64>], target: &[f64], block: &[usize]) -> Self {
        let size = columns.len() + 1;
        let mut blocks = vec![DMatrix::zeros(size, size); BLOCKS];
        let mut counts = vec![0.0; BLOCKS];
        let mut start = 0;
        while start < block.len() {
            let index = block[start];
            let end = block[start..].iter().position(|b| *b != index).map_or(block.len(), |length| start + length);
            let part = DMatrix::from_fn(end - start, size, |row, column| {
                if column < columns.len() { columns[column][start + row] } else { target[start + row] }
            });
            blocks[index] += part.transpose() * &part;
            counts[index] += (end - start) as f64;
            start = end;
        }
        let total = blocks.iter().fold(DMatrix::zeros(size, size), |sum, block| sum + block);
        let training = (0..FOLDS)
            .map(|fold| {
                let held = blocks.iter().enumerate().filter(|(index, _)| fold_of(*index) == fold);
                held.fold(total.clone(), |rest, (_, block)| rest - block)
            })
            .collect();
        Self { blocks, total, training, counts, precision: vec![0.0; size - 1] }
    }

    fn solve(&self, gram: &DMatrix<f64>, set: &[usize]) -> Option<DVector<f64>> {
        let last = gram.nrows() - 1;
        let scale: Vec<f64> = set.iter().map(|&i| self.total[(i, i)].max(1e-300).sqrt()).collect();
        let matrix = DMatrix::from_fn(set.len(), set.len(), |r, c| {
            let own = if r == c { self.precision[set[r]] / (scale[r] * scale[r]) + 1e-9 } else { 0.0 };
            gram[(set[r], set[c])] / (scale[r] * scale[c]) + own
        });
        let right = DVector::from_fn(set.len(), |r, _| gram[(set[r], last)] / scale[r]);
        let mut solution = Cholesky::new(matrix)?.solve(&right);
        solution.iter_mut().zip(&scale).for_each(|(value, scale)| *value /= scale);
        Some(solution)
    }

    fn square(gram: &DMatrix<f64>, set: &[usize], amplitudes: &DVector<f64>) -> f64 {
        let last = gram.nrows() - 1;
        let mut square = gram[(last, last)];
        for (r, &row) in set.iter().enumerate() {
            square -= 2.0 * amplitudes[r] * gram[(row, last)];
            for (c, &column) in set.iter().enumerate() {
                square += amplitudes[r] * amplitudes[c] * gram[(row, column)];
            }
        }
        square.max(0.0)
    }

    /// Square of the regressand.
    pub(super) fn square_of_target(&self) -> f64 {
        let last = self.total.nrows() - 1;
        self.total[(last, last)]
    }

    /// Amplitudes from all blocks.
    pub(super) fn fit(&self, set: &[usize]) -> Vec<f64> {
        self.solve(&self.total, set).map_or_else(|| vec![0.0; set.len()], |s| s.iter().copied().collect())
    }

    /// Squared error of the fit to all blocks, on all blocks.
    pub(super) fn square_of_fit(&self, set: &[usize]) -> f64 {
        let fit = DVector::from_vec(self.fit(set));
        Self::square(&self.total, set, &fit)
    }

    /// Squared error of each block by the fit that did not see its fold.
    pub(super) fn held_out(&self, set: &[usize]) -> Vec<f64> {
        let mut squares = vec![0.0; BLOCKS];
        for (fold, training) in self.training.iter().enumerate() {
            let amplitudes = self.solve(training, set);
            for (index, block) in self.blocks.iter().enumerate().filter(|(index, _)| fold_of(*index) == fold) {
                let last = block.nrows() - 1;
                squares[index] = amplitudes.as_ref().map_or(block[(last, last)] * 1e3, |a| Self::square(block, set, a));
            }
        }
        squares
    }

    /// Amplitudes from blocks drawn `times` each.
    pub(super) fn fit_drawn(&self, set: &[usize], times: &[f64]) -> Option<Vec<f64>> {
        let size = self.total.nrows();
        let mut places: Vec<usize> = set.to_vec();
        places.push(size - 1);
        let mut gram = DMatrix::zeros(size, size);
        for (block, &times) in self.blocks.iter().zip(times).filter(|(_, times)| **times > 0.0) {
            for &r in &places {
                for &c in &places {
                    gram[(r, c)] += times * block[(r, c)];
                }
            }
        }
        self.solve(&gram, set).map(|s| s.iter().copied().collect())
    }

    /// Power that a column keeps beside others, over its own.
    pub(super) fn keeps(&self, column: usize, beside: &[usize]) -> f64 {
        let set: Vec<usize> = beside.iter().copied().filter(|&other| other != column).collect();
        let own = self.total[(column, column)].max(1e-300);
        let matrix = DMatrix::from_fn(set.len(), set.len(), |r, c| {
            let scale = (self.total[(set[r], set[r])] * self.total[(set[c], set[c])]).max(1e-300).sqrt();
            self.total[(set[r], set[c])] / scale + if r == c { 1e-9 } else { 0.0 }
        });
        let right = DVector::from_fn(set.len(), |r, _| {
            self.total[(set[r], column)] / (self.total[(set[r], set[r])].max(1e-300) * own).sqrt()
        });
        Cholesky::new(matrix).map_or(1.0, |cholesky| 1.0 - right.dot(&cholesky.solve(&right))).clamp(0.0, 1.0)
    }

    /// Power of columns times amplitudes, each by itself and all together.
    pub(super) fn powers(&self, columns: &[usize], amplitudes: &[f64]) -> [f64; 2] {
        let pairs = || columns.iter().zip(amplitudes);
        let with =
            |(&row, a): (&usize, &f64)| pairs().map(|(&column, b)| a * b * self.total[(row, column)]).sum::<f64>();
        [pairs().map(|(&column, a)| a * a * self.power(column)).sum(), pairs().map(with).sum()]
    }

    /// Power of a column.
    pub(super) fn power(&self, column: usize) -> f64 {
        self.total[(column, column)]
    }
}

/// The fold that a block is held out with.
pub(super) fn fold_of(block: usize) -> usize {
    block * FOLDS / BLOCKS
}

/// Draws with replacement, the same in every run: how often each block is taken.
#[derive(Debug)]
pub(super) struct Draws {
    state: u64,
}

impl Draws {
    pub(super) fn new() -> Self {
        Self { state: 0x9e37_79b9_7f4a_7c15 }
    }

    fn next(&mut self) -> u64 {
        // splitmix64
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// One draw of as many blocks as hold rows.
    pub(super) fn draw(&mut self, counts: &[f64]) -> Vec<f64> {
        let filled: Vec<usize> = (0..counts.len()).filter(|&index| counts[index] > 0.0).collect();
        let mut times = vec![0.0; counts.len()];
        for _ in 0..filled.len() {
            #[allow(clippy::cast_possible_truncation, reason = "below the number of blocks")]
            let pick = (self.next() % filled.len().max(1) as u64) as usize;
            times[filled[pick]] += 1.0;
        }
        times
    }
}
