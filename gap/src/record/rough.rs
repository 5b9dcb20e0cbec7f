//! White noise of a series, whatever else there is.

/// Rms of white noise from third differences.
pub(crate) fn rough(values: &[f64], valid: &[bool]) -> f64 {
    let mut steps: Vec<f64> = (3..values.len())
        .filter(|&k| valid[k - 3..=k].iter().all(|valid| *valid))
        .map(|k| (values[k] - 3.0 * values[k - 1] + 3.0 * values[k - 2] - values[k - 3]).abs())
        .collect();
    if steps.is_empty() {
        return 1.0;
    }
    let middle = steps.len() / 2;
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    (*median / 0.6745 / 20.0_f64.sqrt()).max(1e-12)
}
