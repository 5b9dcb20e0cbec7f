//! How far the gap shrinks on blocks that were not fitted.

use crate::axis::motion::{BLOCKS, Motion};
use crate::axis::regress::Draws;

/// Before and after, of one signal of one log.
#[derive(Debug, Clone, PartialEq)]
pub struct Shrunk {
    /// Signal, and the log where it is another one.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Root mean square of the residual of the nominal model.
    pub before: f64,
    /// With the effects.
    pub after: f64,
    /// What noise leaves.
    pub noise_floor: f64,
    /// Share of the gap gone.
    pub reduction_percent: f64,
    /// Its interval.
    pub ci95_percent: [f64; 2],
}

/// Before and after from squared errors of blocks, with an interval by bootstrap over blocks.
pub(in crate::axis) fn shrunk(
    name: String,
    unit: &str,
    before: &[f64],
    after: &[f64],
    counts: &[f64],
    floor: f64,
) -> Shrunk {
    let closed = |times: &[f64]| {
        let sum = |squares: &[f64]| squares.iter().zip(times).map(|(s, t)| s * t).sum::<f64>();
        let rows: f64 = counts.iter().zip(times).map(|(c, t)| c * t).sum::<f64>().max(1.0);
        let (before, after) = (sum(before) / rows, sum(after) / rows);
        // what is below the floor is noise: no gap is closed there
        let noise = floor.powi(2).min(after);
        // an effort within the noise has no gap to close
        let gone = if before > floor.powi(2).max(1e-300) { 1.0 - (after - noise) / (before - noise) } else { 0.0 };
        (before.sqrt(), after.sqrt(), 100.0 * gone)
    };
    let all: Vec<f64> = vec![1.0; counts.len()];
    let (whole_before, whole_after, reduction_percent) = closed(&all);
    let mut draws = Draws::new();
    let mut drawn: Vec<f64> = (0..1000).map(|_| closed(&draws.draw(counts)).2).collect();
    drawn.sort_by(f64::total_cmp);
    Shrunk {
        name,
        unit: unit.to_owned(),
        before: whole_before,
        after: whole_after,
        noise_floor: floor,
        reduction_percent,
        ci95_percent: [drawn[24], drawn[974]],
    }
}

/// Squares of values summed over blocks.
pub(in crate::axis) fn by_block(values: &[f64], motion: &Motion) -> Vec<f64> {
    let mut squares = vec![0.0; BLOCKS];
    for (value, &block) in values.iter().zip(&motion.block) {
        squares[block] += value * value;
    }
    squares
}
