//! The stop, as the pick-off shows it: a plateau at its largest excursion.

use super::converter::least_count;
use super::rough::rough;

/// Share of its largest excursion within which the pick-off counts as on the stop, or noise in which it does.
const SHARE: f64 = 4e-3;
const NOISES: f64 = 8.0;
/// How far the float came in as long a time as the shortest plateau has, and how far that rate would have carried it until the
/// plateau's middle, over that band: no parabola of any width has both.
const CAME: f64 = 10.0;
const ONWARD: f64 = 7.0;
/// The same over the scatter on the plateau: wherever the stop is, the float stands still on it as no peak does.
const ENTERS: f64 = 30.0;
const FLAT: f64 = 150.0;
/// The least of that over the scatter: where friction turns around, a peak can be as sudden, but it is none the less round.
const ROUND: f64 = 60.0;
/// How near the nominal stop it is the likeliest that holds a float still, and the same there.
const NEAR: f64 = 0.1;
const ENTERS_NEAR: f64 = 4.0;
const FLAT_NEAR: f64 = 60.0;
/// Least share of the nominal stop at which a plateau that scatters is one, or a stop without a plateau is looked for.
pub(crate) const LEAST_STOP: f64 = 0.2;
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

/// Where a pick-off stands still at its largest excursion, for a nominal stop.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
pub(crate) fn plateau(theta_rad: &[f64], period_s: f64, stop_rad: f64) -> Option<Plateau> {
    let peak = peak_rad(theta_rad);
    let least = (SHORTEST_S / period_s) as usize;
    let finite: Vec<bool> = theta_rad.iter().map(|value| value.is_finite()).collect();
    let noise = rough(theta_rad, &finite);
    let near = (peak / stop_rad - 1.0).abs() < NEAR;
    let (enters, lasts) = if near { (ENTERS_NEAR, FLAT_NEAR) } else { (ENTERS, FLAT) };
    let (band, least_scatter) = ((SHARE * peak).max(NOISES * noise), noise.max(least_count(theta_rad, &finite)));
    let runs = runs(theta_rad, peak - band, least);
    let stands_still = |&(start, end): &(usize, usize)| {
        // it comes in with a rate, and stands still at once; one that the log begins on it leaves with one
        let beside = start.checked_sub(least).unwrap_or(end + least);
        let came = theta_rad.get(beside).map_or(0.0, |angle| peak - angle.abs());
        let onward = came * 0.5 * (end - start) as f64 / least as f64;
        let steep = came > CAME * band && onward > ONWARD * band && peak > LEAST_STOP * stop_rad;
        let scatter = scatter_rad(&theta_rad[start..end]).max(least_scatter);
        steep && onward > ROUND * scatter || came > enters * scatter && onward > lasts * scatter
    };
    let mut still: Vec<(usize, usize)> = runs.iter().copied().filter(stands_still).collect();
    // where others are stops, so is what the log begins on, however slowly it is left
    if let (Some(&(own, _)), Some(&(first, end))) = (still.first(), runs.first())
        && first < least.min(own)
    {
        still.push((first, end));
    }
    let mut on_stop = vec![false; theta_rad.len()];
    let mut level = Vec::new();
    for (start, end) in still {
        level.extend(theta_rad[start..end].iter().map(|value| value.abs()));
        on_stop[start..end].fill(true);
    }
    level.sort_by(f64::total_cmp);
    level.get(level.len() / 2).map(|&level_rad| Plateau { level_rad, on_stop })
}

/// Rows from and to between which a pick-off stays beyond an angle, for more than so many.
fn runs(theta_rad: &[f64], beyond_rad: f64, least: usize) -> Vec<(usize, usize)> {
    let inside = (0..=theta_rad.len()).filter(|&k| !theta_rad.get(k).is_some_and(|angle| angle.abs() > beyond_rad));
    let mut start = 0;
    inside
        .filter_map(|end| {
            let run = (start, end);
            start = end + 1;
            (run.1 > run.0 + least).then_some(run)
        })
        .collect()
}

/// Scatter of most of the samples, as that of a normal distribution between its quartiles.
fn scatter_rad(theta_rad: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = theta_rad.iter().map(|value| value.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    (sizes[3 * sizes.len() / 4] - sizes[sizes.len() / 4]) / 1.349
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::plateau;

    const STOP_RAD: f64 = 8.7e-3;

    /// A swing of a fifth of a second, seen by a pick-off with a noise of 3e-7 rad, held at a level.
    fn swung(peak_rad: f64, held_rad: f64) -> Vec<f64> {
        noisy(peak_rad, held_rad, 1e-2, 3e-7)
    }

    /// A swing of so many half turns a row under noise.
    fn noisy(peak_rad: f64, held_rad: f64, half_turns: f64, noise_rad: f64) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let angle = |k: usize| peak_rad * (std::f64::consts::PI * k as f64 * half_turns).sin();
        let mut read =
            |k: usize| angle(k).clamp(-held_rad, held_rad) + noise_rad * rng.sample::<f64, _>(StandardNormal);
        (0..6000).map(&mut read).collect()
    }

    #[test]
    fn closed_form_a_float_that_stands_still_is_on_a_stop_wherever_that_is() {
        for held_rad in [6e-4, 3e-3, STOP_RAD] {
            let own = plateau(&swung(1.4 * held_rad, held_rad), 1e-3, STOP_RAD).expect("a plateau");
            assert!((own.level_rad / held_rad - 1.0).abs() < 1e-3, "{held_rad}: {}", own.level_rad);
        }
    }

    #[test]
    fn closed_form_a_stop_near_the_nominal_one_is_told_under_noise() {
        // comes onto it with a few noises a row, as another motion may where no stop is expected
        let read = noisy(1.7e-3, 1.35e-3, 2e-3, 1.4e-5);
        let own = plateau(&read, 1e-3, 1.43e-3).expect("a stop");
        assert!((own.level_rad / 1.35e-3 - 1.0).abs() < 2e-3, "{}", own.level_rad);
        assert_eq!(plateau(&read, 1e-3, STOP_RAD), None);
        assert_eq!(plateau(&noisy(1.4e-3, f64::MAX, 2e-3, 1.4e-5), 1e-3, 1.43e-3), None);
    }

    #[test]
    fn closed_form_a_log_that_begins_on_a_stop_shows_it() {
        let noise = |k: usize| 3e-7 * ((k * 7919 % 13) as f64 / 6.0 - 1.0);
        // left with 1e-4 rad a row, and so slowly that nothing tells
        for (leaves_rad, is_one) in [(1e-4, true), (1e-8, false)] {
            let leaves = |k: usize| (leaves_rad * k.saturating_sub(400) as f64).min(0.8 * STOP_RAD);
            let mut read: Vec<f64> = (0..2000).map(|k| noise(k) - STOP_RAD + leaves(k)).collect();
            let own = plateau(&read, 1e-3, STOP_RAD);
            assert_eq!(
                own.is_some_and(|own| own.on_stop[..400].iter().all(|on| *on)),
                is_one,
                "{leaves_rad} rad a row"
            );
            // it comes onto the other one
            read.extend((0..600).map(|k| noise(k) + (1e-4 * k as f64).min(STOP_RAD)));
            let own = plateau(&read, 1e-3, STOP_RAD).expect("the other stop");
            assert!(own.on_stop[..400].iter().chain(&own.on_stop[2100..]).all(|on| *on), "{leaves_rad} rad a row");
        }
    }

    #[test]
    fn closed_form_a_peak_is_no_stop_nor_are_steps_of_a_converter() {
        for peak_rad in [6e-4, 3e-3, STOP_RAD] {
            assert_eq!(plateau(&swung(peak_rad, f64::MAX), 1e-3, STOP_RAD), None, "{peak_rad}");
            let step_rad = 0.1 * peak_rad;
            let read: Vec<f64> =
                swung(peak_rad, f64::MAX).iter().map(|angle| step_rad * (angle / step_rad).round()).collect();
            assert_eq!(plateau(&read, 1e-3, 50.0 * STOP_RAD), None, "{peak_rad} in steps");
        }
    }

    #[test]
    fn closed_form_a_peak_where_friction_turns_around_is_no_stop() {
        // comes in at 2.8e-5 rad a row, is turned back within five of them, and goes slowly
        let angle = |k: usize| {
            let rows = k as f64 - 1000.0;
            let falls_rad = match rows {
                rows if rows < -5.0 => 7e-5 + 2.8e-5 * (-5.0 - rows),
                rows if rows < 0.0 => 2.8e-6 * rows * rows,
                rows => 3e-7 * rows * rows,
            };
            (4.5e-3 - falls_rad).max(0.0)
        };
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let read: Vec<f64> = (0..2000).map(|k| angle(k) + 2e-6 * rng.sample::<f64, _>(StandardNormal)).collect();
        assert_eq!(plateau(&read, 1e-3, STOP_RAD), None);
    }

    #[test]
    fn closed_form_a_noisy_peak_of_any_width_is_no_stop() {
        for half_turns in [3e-2, 1e-2, 3e-3, 1e-3] {
            for noise_rad in [1e-6, 6e-6, 2e-5] {
                let own = plateau(&noisy(2.5e-3, f64::MAX, half_turns, noise_rad), 1e-3, STOP_RAD);
                assert_eq!(own, None, "{half_turns} half turns a row, {noise_rad} rad");
            }
        }
        let own = plateau(&noisy(4e-3, 2.5e-3, 1e-2, 6e-6), 1e-3, STOP_RAD).expect("a stop");
        assert!((own.level_rad / 2.5e-3 - 1.0).abs() < 1e-2, "{}", own.level_rad);
    }
}
