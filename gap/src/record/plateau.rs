//! The stop, as the pick-off shows it: a plateau at its largest excursion.

/// Share of its largest excursion within which the pick-off counts as on the stop.
const SHARE: f64 = 4e-3;
/// How far the rate before it would have carried the float until its middle, over that share: less than five for the
/// smooth peak of any parabola.
const ONWARD: f64 = 7.0;
/// Shortest plateau [s].
const SHORTEST_S: f64 = 0.008;

/// Time on the stop.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plateau {
    /// Its angle.
    pub(crate) level_rad: f64,
    /// Rows on it.
    pub(crate) on_stop: Vec<bool>,
}

/// Largest excursion of a pick-off.
pub(crate) fn peak_rad(theta_rad: &[f64]) -> f64 {
    theta_rad.iter().copied().filter(|value| value.is_finite()).fold(0.0, |a: f64, b| a.max(b.abs()))
}

/// Where a pick-off stands still at its largest excursion.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
pub(crate) fn plateau(theta_rad: &[f64], period_s: f64) -> Option<Plateau> {
    let peak = peak_rad(theta_rad);
    let least = (SHORTEST_S / period_s) as usize;
    let mut on_stop = vec![false; theta_rad.len()];
    let mut level = Vec::new();
    let mut start = 0_usize;
    for k in 0..=theta_rad.len() {
        if k < theta_rad.len() && theta_rad[k].abs() > peak * (1.0 - SHARE) {
            continue;
        }
        // it comes in with a rate, and stands still at once
        let came = start.checked_sub(least).map_or(0.0, |before| peak - theta_rad[before].abs());
        let onward = came * 0.5 * (k - start) as f64 / least as f64;
        if k - start > least && came > 10.0 * SHARE * peak && onward > ONWARD * SHARE * peak {
            level.extend(theta_rad[start..k].iter().map(|value| value.abs()));
            on_stop[start..k].fill(true);
        }
        start = k + 1;
    }
    level.sort_by(f64::total_cmp);
    level.get(level.len() / 2).map(|&level_rad| Plateau { level_rad, on_stop })
}
