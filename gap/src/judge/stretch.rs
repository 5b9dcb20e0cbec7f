//! Evidence that one stretch of the log carries alone: a launch, a bump, whatever the noise is not known for there. An
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

/// What of the gain of a fit over another counts for nothing [nats].
pub(crate) fn carried_alone(from: &Fit, to: &Fit) -> f64 {
    let length = from.residual.len().div_ceil(PIECES).max(1);
    let gain = |(from, to): (&[f64], &[f64])| -> f64 {
        from.iter().zip(to).map(|(from, to)| from * from - to * to).sum::<f64>() / 2.0
    };
    let gains: Vec<f64> = from.residual.chunks(length).zip(to.residual.chunks(length)).map(gain).collect();
    let all: f64 = gains.iter().sum();
    let best = gains.windows(2).map(|pair| pair[0] + pair[1]).fold(0.0, f64::max);
    (best - (all - best).max(ALONE)).clamp(0.0, MOST)
}
