//! Times of ticks, and waiting for their time.

use std::time::{Duration, Instant};

/// Times from a tick's first byte down to its last byte up.
#[derive(Debug, Clone, Default)]
pub struct Deadlines {
    /// Sorted [s].
    pub latencies_s: Vec<f32>,
    /// Answers that came after the next tick was due.
    pub late: u32,
    /// How late ticks began, sorted; in real time only [s].
    pub starts_s: Vec<f32>,
}

impl Deadlines {
    /// A quantile of the latencies [s].
    #[must_use]
    pub fn latency_s(&self, share: f64) -> Option<f64> {
        quantile(&self.latencies_s, share)
    }

    /// A quantile of the delays of starts [s].
    #[must_use]
    pub fn start_s(&self, share: f64) -> Option<f64> {
        quantile(&self.starts_s, share)
    }
}

fn quantile(sorted: &[f32], share: f64) -> Option<f64> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
    let at = (share * sorted.len() as f64).ceil() as usize;
    sorted.get(at.saturating_sub(1)).map(|value| f64::from(*value))
}

/// Sleeps for most of the time, and turns for the rest: a sleep may end a fraction of a millisecond late.
pub(super) fn wait_until(due: Instant) {
    const CLOSE: Duration = Duration::from_micros(200);
    let left = due.saturating_duration_since(Instant::now());
    if left > CLOSE {
        std::thread::sleep(left.saturating_sub(CLOSE));
    }
    while Instant::now() < due {
        std::hint::spin_loop();
    }
}
