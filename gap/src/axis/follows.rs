//! How one signal follows another: scale, likeness, lateness.

use super::table::AxisLog;

/// Rows to either side in which a shift is looked for, and in which it is where the likest shift is at the end of those.
const SHIFT: i32 = 12;
const FAR: i32 = 60;
/// Two signals are of one scale within this.
const SAME: f64 = 0.02;
/// Standard errors by which scales must differ more than that, and a rate be late.
pub(super) const SURE: f64 = 3.0;
/// Share of what a delay leaves that a filter may.
const CLEARLY: f64 = 0.25;
/// Parts of the log that tell the error of a lateness and of a scale.
const PARTS: usize = 8;

/// How one signal follows another: `b = slope * a`, `b` late by `late_rows`.
pub(super) struct Follows {
    pub(super) slope: f64,
    /// Standard error of the slope, from what it is without each eighth of the log.
    slope_error: f64,
    pub(super) correlation: f64,
    pub(super) late_rows: f64,
}

impl Follows {
    /// Whether the two are of one scale: noise of `a` makes the slope of `b` on `a` too small, noise of `b` that of `a`
    /// on `b`, and the truth is in between. A slope that changes along the log is no scale.
    pub(super) fn is_of_one_scale(&self) -> bool {
        let other = self.slope / self.correlation.powi(2).max(1e-6);
        let same = SAME + SURE * self.slope_error;
        self.slope.min(other) < 1.0 + same && self.slope.max(other) > 1.0 - same
    }
}

/// Sums of `a b`, `a a` and `b b`, `b` taken `shift` rows later.
fn sums(a: &[f64], b: &[f64], valid: &[bool], shift: i32, rows: std::ops::Range<usize>) -> [f64; 3] {
    let mut sums = [0.0, 1e-300, 1e-300];
    for k in rows.filter(|k| valid[*k]) {
        let other = b[k.saturating_add_signed(shift as isize)];
        sums[0] += a[k] * other;
        sums[1] += a[k] * a[k];
        sums[2] += other * other;
    }
    sums
}

pub(super) fn follows(a: &[f64], b: &[f64], valid: &[bool]) -> Follows {
    let near = within(a, b, valid, SHIFT);
    if near.late_rows.abs() < f64::from(SHIFT) - 0.5 { near } else { within(a, b, valid, FAR) }
}

/// How `b` follows `a`, at most `most` rows early or late.
fn within(a: &[f64], b: &[f64], valid: &[bool], most: i32) -> Follows {
    let span = most.unsigned_abs() as usize + 1;
    let rows = span..a.len().saturating_sub(span).max(span);
    let of = |shift: i32| {
        let [ab, aa, bb] = sums(a, b, valid, shift, rows.clone());
        ab / (aa * bb).sqrt()
    };
    let best = (-most..=most).max_by(|x, y| of(*x).abs().total_cmp(&of(*y).abs())).unwrap_or(0);
    // vertex of the parabola through three shifts
    let (low, middle, high) = (of(best - 1).abs(), of(best).abs(), of(best + 1).abs());
    let curve = low - 2.0 * middle + high;
    let vertex = if best.abs() < most && curve < 0.0 { 0.5 * (low - high) / curve } else { 0.0 };
    let parts: Vec<[f64; 3]> = (0..PARTS)
        .map(|part| {
            let at = |part: usize| rows.start + part * rows.len() / PARTS;
            sums(a, b, valid, best, at(part)..at(part + 1))
        })
        .collect();
    let whole = |place: usize| parts.iter().map(|part| part[place]).sum::<f64>();
    let (ab, aa) = (whole(0), whole(1));
    let slope = ab / aa;
    let without = parts.iter().map(|part| (ab - part[0]) / (aa - part[1]).max(1e-300) - slope);
    let slope_error = (without.map(|change| change * change).sum::<f64>() * (1.0 - 1.0 / PARTS as f64)).sqrt();
    Follows { slope, slope_error, correlation: of(best), late_rows: f64::from(best) + vertex.clamp(-0.5, 0.5) }
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
    let span = FAR.unsigned_abs() as usize + 1;
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

/// Time constant in rows of the filter of first order that `b` is of `a`, where that leaves less of it than a delay does:
///
/// ```text
/// a - b = T db/dt
/// ```
pub(super) fn first_order(a: &[f64], b: &[f64], both: &Follows, valid: &[bool]) -> Option<f64> {
    let span = FAR.unsigned_abs() as usize + 1;
    let rows = || (span..a.len().saturating_sub(span)).filter(|k| valid[*k]);
    let change = |k: usize| 0.5 * (b[k + 1] - b[k - 1]);
    let (with, square) = rows()
        .fold((0.0, 1e-300), |(with, square), k| (with + (a[k] - b[k]) * change(k), square + change(k) * change(k)));
    let constant = with / square;
    let mut earlier = b.to_vec();
    advance(&mut earlier, both.late_rows);
    let left = |of: &dyn Fn(usize) -> f64| rows().map(|k| of(k).powi(2)).sum::<f64>();
    let filtered = left(&|k| a[k] - b[k] - constant * change(k));
    let delayed = left(&|k| a[k] - earlier[k] / both.slope);
    (constant > 0.0 && filtered < CLEARLY * delayed).then_some(constant)
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
        let later: Vec<f64> = (0..wave.len()).map(|k| (0.01 * (k as f64 - 18.0)).sin()).collect();
        assert!((follows(&wave, &later, &valid).late_rows - 18.0).abs() < 0.1);
    }

    #[test]
    fn a_filter_of_first_order_is_told_from_a_delay() {
        let wave = |k: f64| (0.01 * k).sin() + 0.3 * (0.037 * k).sin();
        let rows = || (0..6000).map(f64::from);
        let given: Vec<f64> = rows().map(wave).collect();
        let valid = vec![true; given.len()];
        let mut level = 0.0;
        let filtered: Vec<f64> = given
            .iter()
            .map(|value| {
                level += (value - level) / 20.0;
                level
            })
            .collect();
        let constant = |b: &[f64]| first_order(&given, b, &follows(&given, b, &valid), &valid);
        assert!(constant(&filtered).is_some_and(|rows| (rows - 19.3).abs() < 0.5));
        assert_eq!(constant(&rows().map(|k| wave(k - 19.5)).collect::<Vec<_>>()), None);
    }

    #[test]
    fn a_slope_that_changes_along_the_log_is_no_scale() {
        let (wave, _) = wave_and_noise();
        let changing: Vec<f64> = wave.iter().enumerate().map(|(k, wave)| (1.3 - 6e-5 * k as f64) * wave).collect();
        let valid = vec![true; wave.len()];
        let both = follows(&wave, &changing, &valid);
        assert!(both.slope > 1.05 && both.is_of_one_scale(), "{}", both.slope);
    }
}
