//! A few moments: torques that last from a row to a quarter of a second, wherever the residual speaks for one.
//!
//! ```text
//! gain(t, n) = (sum of drive over n rows from t)^2 / (2 E_n)  [nats]        E_n = sum |sum_n exp(-2 pi i f k)|^2 seen(f)
//! ```
//!
//! Each moment pays for its choice among all places and lengths; what else takes the same is for the joint fit to say.

use super::group::{Group, On};
use crate::fit::{Fit, Problem};

/// Rows that a torque lasts.
const LENGTHS: [usize; 5] = [1, 4, 16, 64, 256];
/// Moments at most, and the least distance between two [s].
const MOST: usize = 12;
const APART_S: f64 = 0.25;
/// Rows before and after a moment in which the bearing may not turn around.
const BEFORE: usize = 100;
const AFTER: usize = 100;
/// Torque over its ceiling from which on the noise in the loop meets it, and for how long the loop remembers that [s].
const AT_CEILING: f64 = 0.97;
const AFTER_CEILING_S: f64 = 1.0;
/// What a moment must bring beyond its choice [nats].
const LEAST: f64 = 7.0;

/// A box somewhere.
struct Moment {
    row: usize,
    length: usize,
    nats: f64,
    choice: f64,
}

/// The moments that a drive speaks for most, a box each; none where chance may be all there is.
pub(crate) fn moments(problem: &Problem, fit: &Fit, drive: &[f64]) -> Option<Group> {
    let rows = drive.len();
    let seen = problem.path.seen();
    let mut sums = vec![0.0];
    sums.extend(drive.iter().scan(0.0, |sum, value| {
        *sum += value;
        Some(*sum)
    }));
    // where the bearing turns around, the noise of the rate is moments of torque; at a ceiling what the motor does not
    let at_ceiling = at_ceiling(problem, fit);
    let mut disturbed = vec![0_usize];
    disturbed.extend(problem.turns.iter().zip(&at_ceiling).scan(0, |sum, (turns, at_ceiling)| {
        *sum += usize::from(*turns || *at_ceiling);
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
            disturbed[to] == disturbed[from]
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

/// Rows at which a fit has the motor at a ceiling, and those after, as long as the loop remembers them.
fn at_ceiling(problem: &Problem, fit: &Fit) -> Vec<bool> {
    let torque_nm = &fit.prediction.motor_torque_nm;
    let Some(limit_nm) = fit.physics.limit_nm else { return vec![false; torque_nm.len()] };
    let limit_nm = AT_CEILING * limit_nm * fit.physics.measurement.torque_factor;
    let after = problem.record.inputs.rows_of(AFTER_CEILING_S);
    let since = torque_nm.iter().scan(after, |since, torque_nm| {
        *since = if torque_nm.abs() >= limit_nm { 0 } else { *since + 1 };
        Some(*since < after)
    });
    since.collect()
}
