//! `pickoff_quantisation` in the samples themselves: angles on a grid of step q make `mean exp(2 pi i theta / q)`
//! larger than that of the predicted angles. All steps at once: the transform of two histograms.

use std::f64::consts::{PI, TAU};

use realfft::RealFftPlanner;

/// Finest step that is tried, over the noise: any converter has steps, and finer ones drown. Coarsest step [rad].
const FINEST: f64 = 2.5;
const COARSEST_RAD: f64 = 3e-5;
/// Bins of the histograms over the finest step, and their number.
const BINS_A_STEP: f64 = 8.0;
const BINS: usize = 1 << 17;
/// Share of the strongest line from which on the first is no chance.
const HARMONIC: f64 = 0.7;
/// Share of the samples, all in step, that a line must stand out by.
const STANDS_OUT: f64 = 0.2;
/// Fewest samples that are looked at.
const LEAST_ROWS: usize = 2000;
/// Median over rms of the difference of two even errors, over that of noise: `(1 - 1 / sqrt 2) sqrt 6 / 0.6745`.
const EVEN: f64 = 1.064;
/// Steps that are tried for the smallest, one over the last.
const COARSER: f64 = 1.03;

/// The step of the pick-off, if its samples lie on a grid that stands out of their noise [rad].
#[must_use]
pub(crate) fn step_rad(theta: &[f64], predicted: &[f64], valid: &[bool], noise_rad: f64) -> Option<f64> {
    let finest_rad = FINEST * noise_rad;
    let bin_rad = finest_rad / BINS_A_STEP;
    let mut measured = vec![0.0; BINS];
    let mut expected = vec![0.0; BINS];
    let mut count = 0.0;
    for k in (0..theta.len()).filter(|&k| valid[k]) {
        if let (Some(a), Some(b)) = (bin(theta[k] / bin_rad), bin(predicted[k] / bin_rad)) {
            measured[a] += 1.0;
            expected[b] += 1.0;
            count += 1.0;
        }
    }
    if count < LEAST_ROWS as f64 {
        return None;
    }
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(BINS);
    let (mut a, mut b) = (transform.make_output_vec(), transform.make_output_vec());
    transform.process(&mut measured, &mut a).ok()?;
    transform.process(&mut expected, &mut b).ok()?;
    let step = 1.0 / (BINS as f64 * bin_rad);
    let strength = |line: usize| (a[line].norm() - b[line].norm()) / count;
    let lines = (0..a.len()).filter(|&line| {
        let inverse = line as f64 * step;
        inverse > 1.0 / COARSEST_RAD && inverse < 1.0 / finest_rad
    });
    let strongest = lines.clone().map(strength).fold(0.0, f64::max);
    if strongest < STANDS_OUT {
        return None;
    }
    // a grid has lines at the multiples of its first, all as strong
    let first = lines.clone().find(|line| strength(*line) > HARMONIC * strongest)?;
    let near = lines.filter(|line| line.abs_diff(first) <= 2);
    let best = near.max_by(|x, y| strength(*x).total_cmp(&strength(*y)))?;
    Some(1.0 / (best as f64 * step))
}

/// What a step adds to the noise of an angle that passes over many, as the median of third differences shows it [rad].
pub(crate) fn rough_rad(step_rad: f64) -> f64 {
    EVEN * step_rad / 12.0_f64.sqrt()
}

/// The smallest step that would be found in angles with white noise [rad]:
/// `exp(-2 (pi noise / q)^2) - |mean exp(2 pi i theta / q)|` large enough.
#[must_use]
pub(crate) fn smallest_rad(predicted: &[f64], valid: &[bool], noise_rad: f64) -> Option<f64> {
    let counted: Vec<f64> = (0..predicted.len()).filter(|&k| valid[k]).map(|k| predicted[k]).collect();
    if counted.len() < LEAST_ROWS {
        return None;
    }
    let own = |step_rad: f64| {
        let waves = counted.iter().map(|angle| (TAU * angle / step_rad).sin_cos());
        let (sin, cos) = waves.fold((0.0, 0.0), |sum, (sin, cos)| (sum.0 + sin, sum.1 + cos));
        f64::hypot(sin, cos) / counted.len() as f64
    };
    let found = |step_rad: &f64| {
        let drowns = *step_rad < FINEST * noise_rad.hypot(rough_rad(*step_rad));
        !drowns && (-2.0 * (PI * noise_rad / step_rad).powi(2)).exp() - own(*step_rad) > STANDS_OUT
    };
    let steps = std::iter::successors(Some(FINEST * noise_rad), |step_rad| Some(COARSER * step_rad));
    steps.take_while(|step_rad| *step_rad < COARSEST_RAD).find(found)
}

/// The bin of an angle over their width, about the middle.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the bins")]
fn bin(angle: f64) -> Option<usize> {
    let place = (angle + BINS as f64 / 2.0).floor();
    (place >= 0.0 && place < BINS as f64).then_some(place as usize)
}
