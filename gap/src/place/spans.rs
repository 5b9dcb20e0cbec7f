//! When: half-second windows in which what the effects contribute stands out of the noise.

/// Length of a window [s].
const WINDOW_S: f64 = 0.5;

/// A stretch of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Since the first row [s].
    pub from_s: f64,
    /// Since the first row [s].
    pub to_s: f64,
    /// Share of the whole contribution.
    pub share: f64,
}

/// Windows in which the contribution (whitened, row after row) exceeds three standard deviations of its own norm.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
pub fn spans(contribution: &[f64], channels: usize, period_s: f64) -> Vec<Span> {
    let rows = contribution.len() / channels.max(1);
    let length = ((WINDOW_S / period_s) as usize).max(1);
    let all: f64 = contribution.iter().map(|value| value * value).sum();
    let mut found: Vec<Span> = Vec::new();
    let mut start = 0;
    while start < rows {
        let end = (start + length).min(rows);
        let power: f64 = contribution[start * channels..end * channels].iter().map(|value| value * value).sum();
        if power > 9.0 {
            let (from_s, to_s) = (start as f64 * period_s, end as f64 * period_s);
            let share = power / all.max(1e-30);
            match found.last_mut() {
                Some(last) if (last.to_s - from_s).abs() < 0.5 * period_s => {
                    last.to_s = to_s;
                    last.share += share;
                }
                _ => found.push(Span { from_s, to_s, share }),
            }
        }
        start = end;
    }
    found
}
