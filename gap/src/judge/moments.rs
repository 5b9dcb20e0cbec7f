//! A few moments: torques that last from a row to a quarter of a second, wherever the residual speaks for one.
//!
//! ```text
//! gain(t, n) = (sum of drive over n rows from t)^2 / (2 E_n)  [nats]        E_n = sum |sum_n exp(-2 pi i f k)|^2 seen(f)
//! ```
//!
//! Each moment pays for its choice among all places and lengths; what else takes the same is for the joint fit to say.

use super::group::{Group, On};
use crate::fit::Problem;

/// Rows that a torque lasts.
const LENGTHS: [usize; 5] = [1, 4, 16, 64, 256];
/// Moments at most, and the least distance between two [s].
const MOST: usize = 12;
const APART_S: f64 = 0.25;
/// Rows before and after a moment in which the bearing may not turn around.
const BEFORE: usize = 100;
const AFTER: usize = 100;
/// What a moment must bring beyond its choice [nats].
const LEAST: f64 = 5.0;

/// A box somewhere.
struct Moment {
    row: usize,
    length: usize,
    nats: f64,
    choice: f64,
}

/// The moments that a drive speaks for most, a box each; none where chance may be all there is.
pub(crate) fn moments(problem: &Problem, drive: &[f64]) -> Option<Group> {
    let rows = drive.len();
    let seen = problem.path.seen();
    let mut sums = vec![0.0];
    sums.extend(drive.iter().scan(0.0, |sum, value| {
        *sum += value;
        Some(*sum)
    }));
    // where the bearing turns around, the noise of the rate is moments of torque
    let mut turning = vec![0_usize];
    turning.extend(problem.turns.iter().scan(0, |sum, turns| {
        *sum += usize::from(*turns);
        Some(*sum)
    }));
    let mut all: Vec<Moment> = Vec::new();
    for length in LENGTHS.into_iter().filter(|length| 4 * length < rows) {
        let energy = seen.of_box(length).max(1e-300);
        let choice = ((LENGTHS.len() * rows) as f64 / length as f64).ln();
        let of = |row: usize| (sums[row + length] - sums[row]).powi(2) / (2.0 * energy) - choice;
        let moment = |row: usize| Moment { row, length, nats: of(row), choice };
        let clear = |row: &usize| {
            let (from, to) = (row.saturating_sub(BEFORE), (row + length + AFTER).min(rows));
            turning[to] == turning[from]
        };
        all.extend((0..=rows - length).filter(clear).map(moment).filter(|moment| moment.nats > LEAST));
    }
    all.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    let apart = problem.record.inputs.rows_of(APART_S);
    let mut chosen: Vec<Moment> = Vec::new();
    for moment in all {
        let clear = |other: &Moment| {
            moment.row + moment.length + apart < other.row || other.row + other.length + apart < moment.row
        };
        if chosen.len() < MOST && chosen.iter().all(clear) {
            chosen.push(moment);
        }
    }
    let torque = |moment: &Moment| {
        let inside = moment.row..moment.row + moment.length;
        (0..rows).map(|row| f64::from(u8::from(inside.contains(&row)))).collect()
    };
    (!chosen.is_empty()).then(|| Group {
        of: "a few moments",
        series: chosen.iter().map(torque).collect(),
        on: On::Gimbal,
        choice: chosen.iter().map(|moment| moment.choice).sum(),
    })
}
