//! How far the gap shrinks: fitted on every other block, scored on the rest, both ways round.
//!
//! The interval is that of the model in the report, which was fitted on all blocks: it does no worse than what half of
//! them led to on the other half, and no better than it does on what it was fitted to. Both ends are resampled.

use crate::fit::{BLOCKS, Fit, Problem, refit};
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
    /// The rms that the fit leaves where it was fitted.
    pub fitted: f64,
    /// The reduction's 95 % interval.
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
    let before = problem.residual(&nominal);
    let odd: Vec<usize> = (0..BLOCKS).filter(|block| block % 2 == 1).collect();
    let even: Vec<usize> = (0..BLOCKS).filter(|block| block % 2 == 0).collect();
    // fitted without the odd blocks, scored on them, and the other way round
    let folds: [Prediction; 2] = rayon::join(|| refit(problem, fit, &odd), || refit(problem, fit, &even)).into();
    let residuals = folds.each_ref().map(|prediction| problem.residual(prediction));
    let fitted = problem.residual(&fit.prediction);
    let rows = record.rows();
    let signals = record
        .channels
        .iter()
        .enumerate()
        .map(|(place, channel)| {
            let floor = problem.noise[place];
            let mut pieces = vec![Squares::default(); PIECES];
            for k in (0..rows).filter(|&k| channel.valid[k]) {
                let fold = usize::from((k * BLOCKS / rows).is_multiple_of(2));
                let [before, after, fitted] = [&before, &residuals[fold], &fitted].map(|residual| residual[place][k]);
                pieces[k * PIECES / rows].add(&Squares::of(before, after, fitted));
            }
            let sum = |picks: &mut dyn Iterator<Item = usize>| {
                let mut sum = Squares::default();
                picks.for_each(|piece| sum.add(&pieces[piece]));
                sum
            };
            let all = sum(&mut (0..PIECES));
            let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
            let mut pick = || {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (seed >> 33) as usize % PIECES
            };
            let drawn: Vec<Squares> =
                (0..RESAMPLES).map(|_| sum(&mut std::iter::repeat_with(&mut pick).take(PIECES))).collect();
            let quantile = |of: fn(&Squares) -> f64, place: usize| {
                let mut values: Vec<f64> = drawn.iter().map(|sum| sum.reduction_percent(of(sum), floor)).collect();
                values.sort_by(f64::total_cmp);
                values[place]
            };
            let (low, high) = (RESAMPLES / 40, RESAMPLES - 1 - RESAMPLES / 40);
            let [after, fitted]: [fn(&Squares) -> f64; 2] = [|sum| sum.after, |sum| sum.fitted];
            ShrinkSignal {
                name: channel.signal.column().name(),
                unit: channel.signal.column().unit(),
                before: (all.before / all.count.max(1.0)).sqrt(),
                after: (all.after / all.count.max(1.0)).sqrt(),
                noise_floor: floor,
                fitted: (all.fitted / all.count.max(1.0)).sqrt(),
                reduction_percent: all.reduction_percent(all.after, floor),
                ci95_percent: [quantile(after, low), quantile(after, high).max(quantile(fitted, high))],
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

/// Squares of residuals, summed over some rows.
#[derive(Debug, Clone, Default)]
struct Squares {
    before: f64,
    /// On blocks that were not fitted, and where all were.
    after: f64,
    fitted: f64,
    count: f64,
}

impl Squares {
    fn of(before: f64, after: f64, fitted: f64) -> Self {
        Self { before: before * before, after: after * after, fitted: fitted * fitted, count: 1.0 }
    }

    fn add(&mut self, other: &Self) {
        self.before += other.before;
        self.after += other.after;
        self.fitted += other.fitted;
        self.count += other.count;
    }

    /// What falls away of what is above the noise where so much is left.
    fn reduction_percent(&self, left: f64, floor: f64) -> f64 {
        let floor = floor * floor * self.count;
        let gap = self.before - floor;
        if gap > 1e-3 * floor { 100.0 * (1.0 - (left - floor) / gap) } else { 0.0 }
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
