//! Evidence that one stretch of a log carries alone: a launch, a bump, whatever the noise is not known for there. An
//! effect that acts all the time brings some elsewhere too.
//!
//! ```text
//! g_b = sum over b of (r_0^2 - r_1^2) / 2        cost = max over b (g_b - max(12, sum - g_b)), 0 to 60        [nats]
//! ```

use crate::fit::Fit;

/// Pieces of the log; a stretch is two that follow each other.
const PIECES: usize = 20;
/// What one stretch may bring by itself [nats].
const ALONE: f64 = 12.0;
/// What noise that is not known may bring at the most [nats].
const MOST: f64 = 60.0;
/// The same where it is a whole log among others [nats].
const MOST_OF_LOG: f64 = 12.0;

/// What of the gain of a fit over another counts for nothing [nats].
pub(crate) fn carried_alone(from: &Fit, to: &Fit) -> f64 {
    let length = from.residual.len().div_ceil(PIECES).max(1);
    let gain = |(from, to): (&[f64], &[f64])| -> f64 {
        from.iter().zip(to).map(|(from, to)| from * from - to * to).sum::<f64>() / 2.0
    };
    let gains: Vec<f64> = from.residual.chunks(length).zip(to.residual.chunks(length)).map(gain).collect();
    let best = gains.windows(2).map(|pair| pair[0] + pair[1]).fold(0.0, f64::max);
    for_nothing(best, gains.iter().sum(), MOST)
}

/// The same of one log's stretches among those of several logs, from the powers of both residuals piece by piece, in
/// nats.
pub(crate) fn carried_by_one_stretch(gains: &[Vec<f64>]) -> f64 {
    let pairs = gains.iter().flat_map(|log| log.windows(2).map(|pair| pair[0] + pair[1]));
    for_nothing(pairs.fold(0.0, f64::max), gains.iter().flatten().sum(), MOST)
}

/// The same of whole logs.
pub(crate) fn carried_by_one_log(gains: &[Vec<f64>]) -> f64 {
    let logs = gains.iter().map(|log| log.iter().sum::<f64>());
    for_nothing(logs.fold(0.0, f64::max), gains.iter().flatten().sum(), MOST_OF_LOG)
}

/// Half the squares of a residual, piece by piece.
pub(crate) fn pieces(residual: &[f64]) -> Vec<f64> {
    let length = residual.len().div_ceil(PIECES).max(1);
    residual.chunks(length).map(|piece| 0.5 * piece.iter().map(|value| value * value).sum::<f64>()).collect()
}

/// What of a gain counts for nothing where the best part of it is so large.
fn for_nothing(best: f64, all: f64, most: f64) -> f64 {
    (best - (all - best).max(ALONE)).clamp(0.0, most)
}
