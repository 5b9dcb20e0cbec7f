//! `pickoff_quantisation` in the samples themselves: angles on a grid of step q make `mean exp(2 pi i theta / q)`
//! differ from what the predicted angles and white noise give.

use std::f64::consts::TAU;

/// Steps that are tried [rad].
const FINEST_RAD: f64 = 8e-7;
const COARSEST_RAD: f64 = 3e-5;
/// Reach of the samples that are looked at, about their middle [rad].
const REACH_RAD: f64 = 2e-4;
/// Standard deviations that the line must stand out by, over all steps tried.
const STANDS_OUT: f64 = 7.5;

/// The step of the pick-off, if its samples lie on a grid.
#[must_use]
pub(crate) fn step_rad(theta: &[f64], predicted: &[f64], valid: &[bool], sigma: f64) -> Option<f64> {
    let rows = || (0..theta.len()).filter(|&k| valid[k]);
    let mut sorted: Vec<f64> = rows().step_by(16).map(|k| theta[k]).collect();
    sorted.sort_by(f64::total_cmp);
    // away from rest: where most of the samples stand still there is no grid to be seen
    let middle = *sorted.get(3 * sorted.len() / 4)?;
    let near: Vec<usize> = rows().filter(|&k| (theta[k] - middle).abs() < REACH_RAD).collect();
    let stride = (near.len() / 5000).max(1);
    let pool: Vec<(f64, f64)> = near.into_iter().step_by(stride).map(|k| (theta[k], predicted[k])).collect();
    if pool.len() < 500 {
        return None;
    }
    let strength = |inverse: f64| {
        let blur = (-0.5 * (TAU * sigma * inverse).powi(2)).exp();
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (theta, predicted) in &pool {
            let (s, c) = (TAU * theta * inverse).sin_cos();
            let (ps, pc) = (TAU * predicted * inverse).sin_cos();
            sine += s - blur * ps;
            cosine += c - blur * pc;
        }
        sine.hypot(cosine) / (pool.len() as f64 / 2.0).sqrt()
    };
    let (mut best, mut best_inverse) = (0.0, 0.0);
    let mut inverse = 1.0 / COARSEST_RAD;
    while inverse < 1.0 / FINEST_RAD {
        let value = strength(inverse);
        if value > best {
            (best, best_inverse) = (value, inverse);
        }
        inverse += 0.2 / REACH_RAD;
    }
    (best > STANDS_OUT).then(|| 1.0 / best_inverse)
}
