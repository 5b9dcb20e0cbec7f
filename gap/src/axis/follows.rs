//! How one signal follows another: scale, likeness, lateness.

use super::table::AxisLog;

/// Rows to either side in which a shift is looked for.
const SHIFT: i32 = 12;
/// Two signals are of one scale within this.
const SAME: f64 = 0.02;
/// Parts of the log that tell a lateness's error.
const PARTS: usize = 8;

/// How one signal follows another: `b = slope * a`, `b` late by `late_rows`.
pub(super) struct Follows {
    pub(super) slope: f64,
    pub(super) correlation: f64,
    pub(super) late_rows: f64,
}

impl Follows {
    /// Whether the two are of one scale: noise of `a` makes the slope of `b` on `a` too small, noise of `b` that of `a`
    /// on `b`, and the truth is in between.
    pub(super) fn is_of_one_scale(&self) -> bool {
        let other = self.slope / self.correlation.powi(2).max(1e-6);
        self.slope.min(other) < 1.0 + SAME && self.slope.max(other) > 1.0 - SAME
    }
}

pub(super) fn follows(a: &[f64], b: &[f64], valid: &[bool]) -> Follows {
    let sums = |shift: i32| {
        let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
        let span = SHIFT.unsigned_abs() as usize + 1;
        for k in (span..a.len().saturating_sub(span)).filter(|k| valid[*k]) {
            let other = b[k.saturating_add_signed(shift as isize)];
            ab += a[k] * other;
            aa += a[k] * a[k];
            bb += other * other;
        }
        (ab, aa.max(1e-300), bb.max(1e-300))
    };
    let of = |shift: i32| {
        let (ab, aa, bb) = sums(shift);
        ab / (aa * bb).sqrt()
    };
    let best = (-SHIFT..=SHIFT).max_by(|x, y| of(*x).abs().total_cmp(&of(*y).abs())).unwrap_or(0);
    // vertex of the parabola through three shifts
    let (low, middle, high) = (of(best - 1).abs(), of(best).abs(), of(best + 1).abs());
    let curve = low - 2.0 * middle + high;
    let vertex = if best.abs() < SHIFT && curve < 0.0 { 0.5 * (low - high) / curve } else { 0.0 };
    let (ab, aa, _) = sums(best);
    Follows { slope: ab / aa, correlation: of(best), late_rows: f64::from(best) + vertex.clamp(-0.5, 0.5) }
}

/// Standard error of a lateness [rows], from what eight parts of the log say of it by themselves:
///
/// ```text
/// late - late_of_all = -sum (b/slope - a) da / sum da^2
/// ```
pub(super) fn lateness_error(a: &[f64], b: &[f64], both: &Follows, log: &AxisLog) -> f64 {
    let mut earlier = b.to_vec();
    advance(&mut earlier, both.late_rows);
    let part = (a.len() / PARTS).max(3);
    let span = SHIFT.unsigned_abs() as usize + 1;
    let own: Vec<f64> = (0..PARTS)
        .map(|place| {
            let (mut with, mut square) = (0.0, 1e-300);
            let rows = (place * part).max(span)..((place + 1) * part).min(a.len().saturating_sub(span));
            for k in rows.filter(|k| log.valid[*k]) {
                let slope = 0.5 * (a[k + 1] - a[k - 1]);
                with -= (earlier[k] / both.slope - a[k]) * slope;
                square += slope * slope;
            }
            with / square
        })
        .collect();
    let mean = own.iter().sum::<f64>() / own.len() as f64;
    (own.iter().map(|late| (late - mean).powi(2)).sum::<f64>() / (own.len() * (own.len() - 1)) as f64).sqrt()
}

/// Takes a signal `rows` earlier.
pub(super) fn advance(values: &mut [f64], rows: f64) {
    let last = values.len() - 1;
    let old = values.to_vec();
    for (k, value) in values.iter_mut().enumerate() {
        let place = (k as f64 + rows).clamp(0.0, last as f64);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the rows")]
        let low = place.floor() as usize;
        let share = place - low as f64;
        *value = old[low] + share * (old[(low + 1).min(last)] - old[low]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slow wave, and a ripple for noise, a quarter of it.
    fn wave_and_noise() -> (Vec<f64>, Vec<f64>) {
        let wave = |k: f64| (0.01 * k).sin();
        let noise = |k: f64| 0.25 * (2.0 * k + 3.0 * (0.7 * k).sin()).sin();
        (0..6000).map(f64::from).map(|k| (wave(k), noise(k))).unzip()
    }

    #[test]
    fn noise_of_one_signal_is_no_other_scale() {
        let (wave, noise) = wave_and_noise();
        let noisy: Vec<f64> = wave.iter().zip(&noise).map(|(wave, noise)| wave + noise).collect();
        let valid = vec![true; wave.len()];
        let slope = |a: &[f64], b: &[f64]| follows(a, b, &valid);
        // a plain slope is 6 % too small
        assert!((slope(&noisy, &wave).slope - 0.94).abs() < 0.01);
        assert!(slope(&noisy, &wave).is_of_one_scale() && slope(&wave, &noisy).is_of_one_scale());
        let other: Vec<f64> = wave.iter().map(|wave| 1.1 * wave).collect();
        assert!(!slope(&noisy, &other).is_of_one_scale() && !slope(&other, &noisy).is_of_one_scale());
    }

    #[test]
    fn a_lateness_is_found_between_rows() {
        let (wave, _) = wave_and_noise();
        let late: Vec<f64> = (0..wave.len()).map(|k| (0.01 * (k as f64 - 2.4)).sin()).collect();
        let valid = vec![true; wave.len()];
        assert!((follows(&wave, &late, &valid).late_rows - 2.4).abs() < 0.1);
    }
}
