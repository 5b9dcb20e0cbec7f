//! `pickoff_quantisation` in the samples themselves: angles on a grid of step q make `mean exp(2 pi i theta / q)`
//! larger than that of the predicted angles. All steps at once: the transform of two histograms.

use realfft::RealFftPlanner;

/// Steps that are tried [rad].
const FINEST_RAD: f64 = 8e-7;
const COARSEST_RAD: f64 = 3e-5;
/// Width of a bin of the histograms [rad], and their number.
const BIN_RAD: f64 = 1e-7;
const BINS: usize = 1 << 16;
/// Share of the samples, all in step, that a line must stand out by.
const STANDS_OUT: f64 = 0.2;

/// The step of the pick-off, if its samples lie on a grid.
#[must_use]
pub(crate) fn step_rad(theta: &[f64], predicted: &[f64], valid: &[bool]) -> Option<f64> {
    let mut measured = vec![0.0; BINS];
    let mut expected = vec![0.0; BINS];
    let mut count = 0.0;
    for k in (0..theta.len()).filter(|&k| valid[k]) {
        if let (Some(a), Some(b)) = (bin(theta[k]), bin(predicted[k])) {
            measured[a] += 1.0;
            expected[b] += 1.0;
            count += 1.0;
        }
    }
    if count < 2000.0 {
        return None;
    }
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(BINS);
    let (mut a, mut b) = (transform.make_output_vec(), transform.make_output_vec());
    transform.process(&mut measured, &mut a).ok()?;
    transform.process(&mut expected, &mut b).ok()?;
    let step = 1.0 / (BINS as f64 * BIN_RAD);
    let strength = |line: usize| (a[line].norm() - b[line].norm()) / count;
    let lines = (0..a.len()).filter(|&line| {
        let inverse = line as f64 * step;
        inverse > 1.0 / COARSEST_RAD && inverse < 1.0 / FINEST_RAD
    });
    let best = lines.max_by(|x, y| strength(*x).total_cmp(&strength(*y)))?;
    (strength(best) > STANDS_OUT).then(|| 1.0 / (best as f64 * step))
}

/// The bin of an angle, about the middle.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the bins")]
fn bin(angle_rad: f64) -> Option<usize> {
    let place = (angle_rad / BIN_RAD + BINS as f64 / 2.0).floor();
    (place >= 0.0 && place < BINS as f64).then_some(place as usize)
}
