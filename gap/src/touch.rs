//! A stop that the float only touches: too short a plateau to be seen under the pick-off's noise, long enough for the loop to
//! answer it for as long as it remembers.

use crate::fit::Outcome;
use crate::record::{LEAST_STOP, Signal};
use crate::settle::Settled;
use crate::simulate::{Variant, predict_each};

/// Angles of a stop that are tried at once, around the largest excursion that is held, and how far apart at first: so many
/// times the pick-off's noise and that excursion.
const LEVELS: usize = 16;
const APART_NOISES: f64 = 0.5;
const APART_SHARE: f64 = 5e-4;
/// How often they are tried again around the best of them, nearer by so much.
const AGAIN: usize = 1;
const NEARER: f64 = 0.2;
/// What a stop must take away [nats], and what share of all that is beyond the noise.
const LEAST: f64 = 40.0;
const SHARE: f64 = 0.15;

/// A stop where none was seen.
pub(crate) struct Touched {
    /// Its angle, as the pick-off shows it.
    pub(crate) level_rad: f64,
    /// Rows on it.
    pub(crate) on_stop: Vec<bool>,
}

/// The stop that takes most of what the closest fit leaves; none where that is little.
pub(crate) fn touched(Settled { problem, search, .. }: &Settled) -> Option<Touched> {
    let record = problem.record;
    let closest = search.closest();
    let beyond_noise = closest.square - problem.whitener.count() as f64;
    let held_rad = record.channel(Signal::GyroAngle)?.held_peak();
    let least = (2.0 * LEAST).max(SHARE * beyond_noise);
    if record.comes_near_a_stop() || beyond_noise < least || held_rad < LEAST_STOP * problem.stop_rad {
        return None;
    }
    let stopped = |level_rad: &f64| {
        let mut physics = closest.physics.clone();
        physics.config.gyro.stop_angle_rad = *level_rad;
        Variant { physics, begin: closest.begin.clone(), rate_radps: None, pushed: None, rows: usize::MAX }
    };
    let mut best = (closest.square, held_rad, Vec::new());
    let mut apart_rad = (APART_NOISES * problem.noise[0]).max(APART_SHARE * held_rad);
    for _ in 0..=AGAIN {
        let middle_rad = best.1;
        let level_rad = |k: usize| middle_rad + (k as f64 - 0.5 * LEVELS as f64) * apart_rad;
        let levels_rad: Vec<f64> = (0..LEVELS).map(level_rad).collect();
        let variants: Vec<Variant> = levels_rad.iter().map(stopped).collect();
        let tried = predict_each(&variants, &record.inputs, |index, prediction| {
            let outcome = Outcome::of(problem, prediction);
            (outcome.square, levels_rad[index], outcome.prediction.on_stop)
        });
        best = [best].into_iter().chain(tried).min_by(|a, b| a.0.total_cmp(&b.0))?;
        apart_rad *= NEARER;
    }
    let (square, level_rad, on_stop) = best;
    (closest.square - square > least).then_some(Touched { level_rad, on_stop })
}
