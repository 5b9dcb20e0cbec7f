//! Noise and quantisation of a signal by its samples alone.

/// Steps between neighbouring values that show whether they lie on a grid, how far off it one is, and how many may be.
const MOST_STEPS: f64 = 5.5;
const OFF_GRID: f64 = 0.15;
const MAY_BE_OFF: f64 = 0.3;

/// Noise of a sampled signal that is smooth between rows: third differences, the largest tenth left out.
pub(super) fn noise(values: &[f64]) -> f64 {
    let mut squares: Vec<f64> = values.windows(4).map(|w| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).powi(2)).collect();
    if squares.is_empty() {
        return 0.0;
    }
    squares.sort_by(f64::total_cmp);
    let kept = squares.len() * 9 / 10 + 1;
    // a Gaussian without its largest tenth keeps 44 % of its power per sample
    let trimmed = squares.iter().take(kept).sum::<f64>() / kept.min(squares.len()) as f64;
    (trimmed / 20.0 / 0.62).sqrt().max(step(values) / 12_f64.sqrt())
}

/// Step of the grid that values lie on: the quantisation, where there is one. Values of a fine grid, few of which were met,
/// lie at any distance from one another, and that is no step.
pub(super) fn step(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    let mut steps: Vec<f64> = sorted.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    // the tenth percentile is not misled by roundings in a file
    let step = steps.get(steps.len() / 10).copied().unwrap_or(0.0);
    let near = &steps[..steps.partition_point(|gap| *gap < MOST_STEPS * step)];
    let off = near.iter().filter(|gap| (**gap / step - (**gap / step).round()).abs() > OFF_GRID).count();
    if off as f64 > MAY_BE_OFF * near.len() as f64 { 0.0 } else { step }
}

#[cfg(test)]
mod tests {
    use super::step;

    #[test]
    fn a_coarse_grid_has_a_step_and_a_fine_one_has_none() {
        let sweep = |grid: f64| -> Vec<f64> {
            let at = |k: u32| 1.3 * (1.7e-3 * f64::from(k)).sin() + 0.2 * (3.1e-4 * f64::from(k)).cos();
            (0..20_000).map(|k| (at(k) / grid).round() * grid).collect()
        };
        assert!((step(&sweep(1e-3)) - 1e-3).abs() < 1e-9, "{}", step(&sweep(1e-3)));
        assert!(step(&sweep(1e-8)) < 1e-12);
    }
}
