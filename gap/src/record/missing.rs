//! Rows that an input does not have: what they may have been, and whether that is known.
//!
//! ```text
//! x_i = r_i' C^-1 n       error_i^2 = R(0) - r_i' C^-1 r_i
//! ```
//!
//! n: the rows around, C and `r_i` their covariances with each other and with the missing one, from the covariance R of the whole
//! series (Wiener's interpolation). Where a force shakes faster than that tells, nobody knows what drove the platform meanwhile,
//! nor where it went.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector};

use super::grid::filled;
use super::is_constant;

/// Rows on each side that are asked, and most rows that are filled in by them.
const ASKED: usize = 24;
const MOST: usize = 24;
/// Times that they are filled in.
const PASSES: usize = 3;
/// Share of the variance that keeps the covariance apart from rounding.
const RIDGE: f64 = 1e-9;
/// Error of a row over that of one that is missing alone, and over the scatter of all, from which on it is not known.
const UNKNOWN: f64 = 3.0;
const LEAST_SHARE: f64 = 3e-3;

/// An input without gaps.
pub(super) struct Whole {
    pub(super) values: Vec<f64>,
    /// Rows that are not known.
    pub(super) unknown: Vec<Range<usize>>,
}

/// Fills in what is not finite.
pub(super) fn whole(raw: &[f64]) -> Whole {
    let values = filled(raw);
    let gaps = gaps(raw);
    if gaps.is_empty() || is_constant(&values) {
        return Whole { values, unknown: Vec::new() };
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let mut off: Vec<f64> = values.iter().map(|value| value - mean).collect();
    // what is filled in by lines is in the covariance of the first pass
    let mut unknown = filled_in(&mut off, &gaps);
    for _ in 1..PASSES {
        unknown = filled_in(&mut off, &gaps);
    }
    Whole { values: off.iter().map(|value| mean + value).collect(), unknown }
}

/// Fills gaps in once more, and tells which are not known.
fn filled_in(off: &mut [f64], gaps: &[Range<usize>]) -> Vec<Range<usize>> {
    let covariance = covariance(off);
    let single = ASKED..ASKED + 1;
    let alone = by_those_around(off, &covariance, &single).map_or(0.0, |(_, error)| error);
    let least = (UNKNOWN * alone).max(LEAST_SHARE * covariance[(0, 0)].sqrt());
    let before = off.to_vec();
    let is_unknown = |gap: &&Range<usize>| {
        let Some((values, error)) = by_those_around(&before, &covariance, gap) else { return true };
        off[(*gap).clone()].copy_from_slice(&values);
        error > least
    };
    gaps.iter().filter(is_unknown).cloned().collect()
}

/// Runs of rows between others that are not finite.
fn gaps(raw: &[f64]) -> Vec<Range<usize>> {
    let known = (0..raw.len()).filter(|&k| raw[k].is_finite()).collect::<Vec<_>>();
    known.windows(2).filter(|pair| pair[1] > pair[0] + 1).map(|pair| pair[0] + 1..pair[1]).collect()
}

/// Covariance of the rows of a window with each other, over all places of the window.
fn covariance(off: &[f64]) -> DMatrix<f64> {
    let span = 2 * ASKED + MOST;
    let mut covariance = DMatrix::zeros(span, span);
    let Some(places) = off.len().checked_sub(span).filter(|places| *places > 0) else { return covariance };
    let mean = |sum: f64| sum / places as f64;
    for lag in 0..span {
        let mut sum: f64 = (0..places).map(|k| off[k] * off[k + lag]).sum();
        for row in 0..span - lag {
            covariance[(row, row + lag)] = mean(sum);
            covariance[(row + lag, row)] = mean(sum);
            sum += off[row + places] * off[row + places + lag] - off[row] * off[row + lag];
        }
    }
    covariance
}

/// The rows of a gap from those around it, and the error of the one that is known least; none for a gap that is too long or
/// too near an end.
fn by_those_around(off: &[f64], covariance: &DMatrix<f64>, gap: &Range<usize>) -> Option<(Vec<f64>, f64)> {
    if gap.len() > MOST || gap.start < ASKED || gap.end + ASKED > off.len() {
        return None;
    }
    let (first, inside) = (gap.start - ASKED, ASKED..ASKED + gap.len());
    let around: Vec<usize> = (0..2 * ASKED + gap.len()).filter(|place| !inside.contains(place)).collect();
    let least = RIDGE * covariance[(0, 0)];
    let own = |i: usize, j: usize| covariance[(around[i], around[j])] + if i == j { least } else { 0.0 };
    let factor = Cholesky::new(DMatrix::from_fn(around.len(), around.len(), own))?;
    let weights = factor.solve(&DVector::from_fn(around.len(), |i, _| off[first + around[i]]));
    let mut most = 0.0_f64;
    let row = |row: usize| {
        let beside = DVector::from_fn(around.len(), |i, _| covariance[(around[i], row)]);
        most = most.max(covariance[(row, row)] - beside.dot(&factor.solve(&beside)));
        beside.dot(&weights)
    };
    let values = inside.map(row).collect();
    Some((values, most.max(0.0).sqrt()))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::whole;

    const NOISE: f64 = 1e-3;

    /// A swing, and a vibration of so many lines, under noise.
    fn shaken(lines: usize) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(6);
        let lines: Vec<[f64; 2]> = (0..lines).map(|_| [0.2 + 0.7 * rng.random::<f64>(), rng.random()]).collect();
        let vibration = |k: f64| {
            let sum: f64 = lines.iter().map(|[radians, phase]| (k * radians + TAU * phase).sin()).sum();
            sum / (lines.len() as f64).sqrt()
        };
        let mut value = |k: u32| {
            let k = f64::from(k);
            (4e-3 * k).sin() + vibration(k) + NOISE * rng.sample::<f64, _>(StandardNormal)
        };
        (0..8000).map(&mut value).collect()
    }

    #[test]
    fn a_vibration_of_a_line_is_filled_in_and_one_of_a_band_is_not_known_for_long() {
        let gap = 4000..4010;
        for (lines, is_known) in [(1, true), (300, false)] {
            let true_values = shaken(lines);
            let mut raw = true_values.clone();
            raw[gap.clone()].fill(f64::NAN);
            raw[7000] = f64::NAN;
            let own = whole(&raw);
            let worst = gap.clone().map(|k| (own.values[k] - true_values[k]).abs()).fold(0.0, f64::max);
            assert_eq!(worst < 5.0 * NOISE, is_known, "{worst}");
            assert_eq!(own.unknown.contains(&gap), !is_known, "{:?}", own.unknown);
            assert!((own.values[7000] - true_values[7000]).abs() < 5.0 * NOISE);
        }
    }

    #[test]
    fn ends_and_what_is_all_missing_stay_finite() {
        let mut raw = shaken(1);
        raw[..40].fill(f64::NAN);
        raw[7990..].fill(f64::NAN);
        let own = whole(&raw);
        assert!(own.values.iter().all(|value| value.is_finite()) && own.unknown.is_empty());
        assert!(whole(&[f64::NAN; 50]).values.iter().all(|value| value.is_finite()));
    }

    #[test]
    fn what_stands_still_or_moves_slowly_without_noise_is_known() {
        for amplitude in [0.0, 1.0] {
            let mut raw: Vec<f64> = (0..8000).map(|k| 9.8 + amplitude * (3e-3 * f64::from(k)).sin()).collect();
            raw[4000..4010].fill(f64::NAN);
            assert_eq!(whole(&raw).unknown, []);
        }
    }
}
