//! Samples that stand alone: a sensor's outliers, one row each. What a platform does lasts longer.
//!
//! ```text
//! e(k) = x(k) - (4 (x(k-1) + x(k+1)) - x(k-2) - x(k+2)) / 6        0 for any cubic
//! ```

use super::converter::least_noise;
use super::rough::rough;

/// Over white noise, the scatter of e; and over that, what stands out.
const SCATTER: f64 = 1.394;
const STANDS_OUT: f64 = 7.0;
/// Share of the samples from which on outliers are none.
const MANY: f64 = 0.03;

/// Rows whose sample stands out of its neighbours, which go on without it, and what these say; none where there are many.
pub(super) fn spikes(values: &[f64], valid: &[bool]) -> Vec<(usize, f64)> {
    let noise = rough(values, valid).max(least_noise(values, valid));
    let limit = STANDS_OUT * SCATTER * noise;
    let off = |k: usize| values[k] - (4.0 * (values[k - 1] + values[k + 1]) - values[k - 2] - values[k + 2]) / 6.0;
    let alone = |&k: &usize| {
        let own = off(k);
        let without = |neighbour: usize| (off(neighbour) + own * 4.0 / 6.0).abs() < limit;
        own.abs() > limit && valid[k - 3..=k + 3].iter().all(|valid| *valid) && without(k - 1) && without(k + 1)
    };
    let rows = 3..values.len().saturating_sub(3);
    let found: Vec<(usize, f64)> = rows.filter(alone).map(|k| (k, values[k] - off(k))).collect();
    if found.len() as f64 > MANY * values.len() as f64 { Vec::new() } else { found }
}

#[cfg(test)]
mod tests {
    use super::spikes;

    fn swing(step: f64) -> Vec<f64> {
        let noise = |k: usize| (((k * 7919) % 1000) as f64 / 500.0 - 1.0) * 5e-7;
        let angle = |k: usize| 1e-3 * (k as f64 * 1e-2).sin() + noise(k);
        (0..4000).map(|k| (angle(k) / step).round() * step).collect()
    }

    #[test]
    fn closed_form_one_sample_stands_alone_and_a_step_does_not() {
        let valid = vec![true; 4000];
        let mut values = swing(1e-12);
        assert!(spikes(&values, &valid).is_empty());
        let was = values[700];
        values[700] += 2e-5;
        values[2000..].iter_mut().for_each(|value| *value += 2e-5);
        let found = spikes(&values, &valid);
        assert_eq!(found.iter().map(|(row, _)| *row).collect::<Vec<_>>(), [700]);
        assert!((found[0].1 - was).abs() < 2e-6);
    }

    #[test]
    fn closed_form_steps_of_a_converter_are_no_outliers() {
        let valid = vec![true; 4000];
        for step in [1e-6, 1e-5, 1e-4] {
            assert!(spikes(&swing(step), &valid).is_empty(), "{step}");
        }
    }
}
