//! Which block: every block's effects together, shared out by Shapley's rule over all orders of the blocks.

use gimbal_plant::{Block, Effect};

use crate::fit::{Problem, drive, slices, solve};

/// The blocks in the order of the report.
const BLOCKS: [Block; 6] =
    [Block::Friction, Block::Disturbance, Block::Servo, Block::Gyro, Block::Structure, Block::Measurement];

/// Share of each block in what the library explains of a residual.
#[must_use]
pub fn shares(problem: &Problem, residual: &[f64]) -> Vec<(String, f64)> {
    let in_block = |block: Block| -> Vec<usize> {
        (0..problem.candidates.len())
            .filter(|&index| Effect::from_name(problem.candidates[index].effect).is_some_and(|e| e.block() == block))
            .collect()
    };
    let members: Vec<Vec<usize>> = BLOCKS.iter().map(|block| in_block(*block)).collect();
    let drive = drive(&slices(&problem.whitened), residual);
    let gain: Vec<f64> = (0..1 << BLOCKS.len())
        .map(|subset: usize| {
            let set: Vec<usize> =
                (0..BLOCKS.len()).filter(|b| subset >> b & 1 == 1).flat_map(|b| members[b].clone()).collect();
            let (chosen, precision) = problem.chosen(&set);
            solve(&problem.gram, &drive, &chosen, &precision).map_or(0.0, |solution| solution.gain)
        })
        .collect();
    let factorial = |n: usize| (1..=n).product::<usize>().max(1) as f64;
    let n = BLOCKS.len();
    let mut shares: Vec<f64> = (0..n)
        .map(|block| {
            (0..1_usize << n)
                .filter(|subset| subset >> block & 1 == 0)
                .map(|subset| {
                    let size = subset.count_ones() as usize;
                    let weight = factorial(size) * factorial(n - size - 1) / factorial(n);
                    weight * (gain[subset | 1 << block] - gain[subset]).max(0.0)
                })
                .sum()
        })
        .collect();
    let all: f64 = shares.iter().sum::<f64>().max(1e-30);
    for share in &mut shares {
        *share /= all;
    }
    BLOCKS.iter().map(ToString::to_string).zip(shares).collect()
}
