//! How far the gap shrinks: fitted on every other block, scored on the rest, both ways round.

use crate::fit::{BLOCKS, Fit, Problem, raw_residual, refit};
use crate::record::Signal;
use crate::simulate::{Prediction, predict};

/// Resamples of the bootstrap.
const RESAMPLES: usize = 400;
/// Pieces that are resampled.
const PIECES: usize = 40;

/// One signal before and after.
#[derive(Debug, Clone, PartialEq)]
pub struct ShrinkSignal {
    /// Column of the log.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Rms of measured less nominal.
    pub before: f64,
    /// Rms on blocks that were not fitted.
    pub after: f64,
    /// Rms of the noise.
    pub noise_floor: f64,
    /// What falls away of what is above the noise.
    pub reduction_percent: f64,
    /// Its 95 % interval.
    pub ci95_percent: [f64; 2],
}

/// All signals, and the velocity error.
#[derive(Debug, Clone)]
pub struct Shrink {
    /// Signals.
    pub signals: Vec<ShrinkSignal>,
    /// Velocity error that the gap makes over the log [m/s].
    pub velocity_before_mps: f64,
    /// What the fit leaves open of it [m/s].
    pub velocity_after_mps: f64,
    /// Prediction of the nominal model from the estimated beginning.
    pub nominal: Prediction,
}

/// Compares the nominal model with a fit on held-out blocks.
#[must_use]
pub fn shrink(problem: &Problem, fit: &Fit) -> Shrink {
    let record = problem.record;
    let nominal = predict(&problem.base, &record.inputs, &fit.begin, usize::MAX);
    let before = raw_residual(record, &nominal);
    let odd: Vec<usize> = (0..BLOCKS).filter(|block| block % 2 == 1).collect();
    let even: Vec<usize> = (0..BLOCKS).filter(|block| block % 2 == 0).collect();
    // fitted without the odd blocks, scored on them, and the other way round
    let folds: [Prediction; 2] = rayon::join(|| refit(problem, fit, &odd), || refit(problem, fit, &even)).into();
    let residuals = folds.each_ref().map(|prediction| raw_residual(record, prediction));
    let rows = record.rows();
    let signals = record
        .channels
        .iter()
        .enumerate()
        .map(|(place, channel)| {
            let floor = problem.noise[place];
            // squares of before and after, piece by piece
            let mut pieces = vec![(0.0, 0.0, 0.0); PIECES];
            for k in (0..rows).filter(|&k| channel.valid[k]) {
                let fold = usize::from((k * BLOCKS / rows).is_multiple_of(2));
                let piece = &mut pieces[k * PIECES / rows];
                piece.0 += before[place][k] * before[place][k];
                piece.1 += residuals[fold][place][k] * residuals[fold][place][k];
                piece.2 += 1.0;
            }
            let sums = |pick: &mut dyn FnMut(usize) -> usize| {
                let mut sum = (0.0, 0.0, 0.0);
                for piece in 0..PIECES {
                    let piece = pieces[pick(piece)];
                    sum = (sum.0 + piece.0, sum.1 + piece.1, sum.2 + piece.2);
                }
                sum
            };
            let reduction = |(before, after, count): (f64, f64, f64)| {
                let floor = floor * floor * count;
                let gap = before - floor;
                if gap > 1e-3 * floor { 100.0 * (1.0 - (after - floor) / gap) } else { 0.0 }
            };
            let all = sums(&mut |piece| piece);
            let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
            let mut values: Vec<f64> = (0..RESAMPLES)
                .map(|_| {
                    reduction(sums(&mut |_| {
                        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                        (seed >> 33) as usize % PIECES
                    }))
                })
                .collect();
            values.sort_by(f64::total_cmp);
            ShrinkSignal {
                name: channel.signal.column().name(),
                unit: channel.signal.column().unit(),
                before: (all.0 / all.2.max(1.0)).sqrt(),
                after: (all.1 / all.2.max(1.0)).sqrt(),
                noise_floor: floor,
                reduction_percent: reduction(all),
                ci95_percent: [values[RESAMPLES / 40], values[RESAMPLES - 1 - RESAMPLES / 40]],
            }
        })
        .collect();
    let velocity = |a: &Prediction, b: &Prediction| velocity_mps(problem, a, b);
    Shrink {
        signals,
        velocity_before_mps: velocity(&nominal, &fit.prediction),
        velocity_after_mps: velocity(&folds[0], &folds[1]) / 2.0,
        nominal,
    }
}

/// Velocity error from the difference of two attitudes, at the end of the log [m/s].
fn velocity_mps(problem: &Problem, a: &Prediction, b: &Prediction) -> f64 {
    let inputs = &problem.record.inputs;
    let (mut x, mut y) = (0.0, 0.0);
    let offset = b.gimbal_angle_rad[0] - a.gimbal_angle_rad[0];
    for k in 0..a.gimbal_angle_rad.len() {
        let tilt = b.gimbal_angle_rad[k] - a.gimbal_angle_rad[k] - offset;
        x += inputs.accel_mps2[1][k] * tilt * inputs.period_s;
        y -= inputs.accel_mps2[0][k] * tilt * inputs.period_s;
    }
    debug_assert!(problem.record.channel(Signal::GyroAngle).is_some());
    x.hypot(y)
}
