//! The zero of a rate sensor: what it reads while the axis stands. Where no position is logged, an axis at rest would slip
//! one way for ever, and what holds it there would be friction.

use super::noise::noise;
use super::table::AxisLog;

/// Share of the rows at which the rate is at one level, within so many of its noise.
const AT_REST: f64 = 0.5;
const ALIKE: f64 = 5.0;
/// What a zero is of the largest rate at most, and of the rate's noise at least.
const OF_FASTEST: f64 = 0.01;
const OF_NOISE: f64 = 0.25;

/// Takes the zero off a logged rate, with a note; nothing where a position tells whether the axis moves.
pub(super) fn take_zero_off(log: &mut AxisLog) {
    let (None, Some(rate)) = (&log.position, &mut log.velocity) else { return };
    let Some((zero, share)) = zero_of(rate) else { return };
    for rate in rate.iter_mut() {
        *rate -= zero;
    }
    log.notes.push(format!(
        "the rate is {zero:.3e} at {:.0} % of the rows, under {:.0} % of its largest: its sensor's zero, taken off; no \
         position is logged that would tell it from motion",
        100.0 * share,
        100.0 * OF_FASTEST
    ));
}

/// The level that most of the rows are at, and their share; none where it is nothing, or a rate to be reckoned with.
fn zero_of(rate: &[f64]) -> Option<(f64, f64)> {
    let mut sorted = rate.to_vec();
    sorted.sort_by(f64::total_cmp);
    let level = *sorted.get(sorted.len() / 2)?;
    let noise = noise(rate);
    let near = rate.iter().filter(|rate| (**rate - level).abs() <= ALIKE * noise).count();
    let share = near as f64 / rate.len() as f64;
    let fastest = rate.iter().fold(0.0_f64, |most, rate| most.max((rate - level).abs()));
    (share >= AT_REST && level.abs() > OF_NOISE * noise && level.abs() < OF_FASTEST * fastest).then_some((level, share))
}

#[cfg(test)]
mod tests {
    use super::zero_of;

    /// Slow sines that follow a rest, and something small from row to row.
    fn log(level: f64, rest: usize) -> Vec<f64> {
        let small = |k: usize| 1e-3 * ((k * 7919 % 101) as f64 / 50.0 - 1.0);
        (0..2000)
            .map(|k| level + small(k) + if k < rest { 0.0 } else { 3.0 * (0.01 * (k - rest) as f64).sin() })
            .collect()
    }

    #[test]
    fn what_a_sensor_reads_at_rest_is_its_zero_and_a_slow_rate_is_none() {
        let (zero, share) = zero_of(&log(-2.2e-3, 1500)).expect("a rest of three quarters");
        assert!((zero + 2.2e-3).abs() < 2e-4 && share > 0.7, "{zero} {share}");
        assert_eq!(zero_of(&log(0.0, 1500)).map(|(zero, _)| zero.abs() > 1e-3), None);
        assert_eq!(zero_of(&log(0.3, 1500)), None, "a tenth of the largest rate is motion");
        assert_eq!(zero_of(&log(-2.2e-3, 300)), None, "it hardly rests");
    }
}
