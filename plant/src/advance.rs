//! From one row to the next: steps as large as the error allows, cut where a guard leaves its band.

use crate::guard::{Exit, GUARDS, Guard};
use crate::row::Interval;
use crate::runge_kutta::{Dense, Field, Trial};
use crate::state::State;
use crate::system::{Motion, System};
use crate::vector::{N, Vector};

/// A step is never asked to be shorter than this; the error is then what it is [s].
const LEAST_STEP_S: f64 = 1e-9;
/// Largest step that the control proposes [s].
const LONGEST_STEP_S: f64 = 4e-3;
/// Crossings that are located within one period; beyond them (chatter) the branches are taken up at the next row.
const MOST_CROSSINGS: usize = 400;
/// Where within a step the guards are looked at, beside its end.
const LOOKS: [f64; 3] = [0.25, 0.5, 0.75];

/// Advances the state over the interval.
pub(crate) fn over(system: &System, tolerance: f64, interval: &Interval, start_s: f64, state: &mut State) {
    system.enter(&interval.at(0.0), start_s, state);
    let (corners, count) = system.bearings.corners_s(interval);
    let mut tau_s = 0.0;
    let mut crossings = 0;
    for &corner_s in &corners[..count] {
        while tau_s < corner_s {
            tau_s = smooth(system, tolerance, interval, (tau_s, corner_s), start_s, &mut crossings, state);
        }
    }
    state.periods += 1;
}

/// Integrates in one mode until the end of the span or the first crossing, and returns the time reached.
fn smooth(
    system: &System,
    tolerance: f64,
    interval: &Interval,
    (mut tau_s, end_s): (f64, f64),
    start_s: f64,
    crossings: &mut usize,
    state: &mut State,
) -> f64 {
    let motion = Motion { system, interval, mode: state.mode };
    let mut slope = motion.rate(tau_s, &state.y);
    while tau_s < end_s {
        let step_s = share_of(end_s - tau_s, state.step_s);
        let trial = Trial::take(&motion, tau_s, &state.y, &slope, step_s);
        let error = trial.error(&state.peak) / tolerance;
        let factor = if error > 0.0 { (0.9 * error.powf(-0.125)).clamp(0.2, 6.0) } else { 6.0 };
        state.steps += 1;
        if error > 1.0 && step_s > LEAST_STEP_S {
            state.step_s = (step_s * factor).max(LEAST_STEP_S);
            continue;
        }
        // At the largest factor the step was cut short by the row and says nothing against the longer one.
        let proposal = if factor < 6.0 { step_s * factor } else { state.step_s.max(step_s * factor) };
        state.step_s = proposal.min(LONGEST_STEP_S);
        let end_slope = motion.rate(tau_s + step_s, &trial.end);
        let watched = *crossings < MOST_CROSSINGS;
        if let Some((look_s, exits)) = exits(&motion, tau_s, step_s, &state.y, &slope, &trial.end, &end_slope)
            && watched
        {
            *crossings += 1;
            let dense = trial.dense(&motion, &end_slope);
            let (exit, offset_s) = first(&motion, tau_s, look_s, exits, &dense);
            let offset_s = settle_on(&motion, tau_s, offset_s, step_s, exit, &slope, state);
            tau_s += offset_s;
            system.cross(exit, &interval.at(tau_s), start_s + tau_s, state);
            state.note_peaks();
            return tau_s;
        }
        // The last step ends on the end of the span to the bit.
        tau_s = if step_s >= end_s - tau_s { end_s } else { tau_s + step_s };
        state.y = trial.end;
        slope = end_slope;
        state.note_peaks();
    }
    end_s
}

/// The step that divides the rest evenly and is no longer than the one proposed.
fn share_of(rest_s: f64, proposed_s: f64) -> f64 {
    if rest_s <= proposed_s { rest_s } else { rest_s / (rest_s / proposed_s).ceil() }
}

/// The first look at which a guard is outside its band, and which guards are.
fn exits(
    motion: &Motion,
    tau_s: f64,
    step_s: f64,
    start: &Vector,
    slope: &Vector,
    end: &Vector,
    end_slope: &Vector,
) -> Option<(f64, [Option<bool>; GUARDS])> {
    let look = |share: f64, y: &Vector| {
        let row = motion.interval.at(tau_s + share * step_s);
        let left = motion.system.guards(&motion.mode, &row, y).map(|guard| guard.left());
        left.iter().any(Option::is_some).then_some((share * step_s, left))
    };
    LOOKS
        .iter()
        .find_map(|&share| look(share, &hermite(share, step_s, start, slope, end, end_slope)))
        .or_else(|| look(1.0, end))
}

/// Cubic through both ends of a step: good enough to see a crossing, not to place it.
fn hermite(share: f64, step_s: f64, start: &Vector, slope: &Vector, end: &Vector, end_slope: &Vector) -> Vector {
    let rest = 1.0 - share;
    let mut y = [0.0; N];
    for (index, entry) in y.iter_mut().enumerate() {
        let rise = end[index] - start[index];
        let bulge = rest * (step_s * slope[index] - rise) + share * (rise - step_s * end_slope[index]);
        *entry = start[index] + share * rise + share * rest * bulge;
    }
    y
}

/// The earliest of the crossings up to a look, placed on the interpolant.
fn first(motion: &Motion, tau_s: f64, look_s: f64, exits: [Option<bool>; GUARDS], dense: &Dense) -> (Exit, f64) {
    let mut earliest = (Exit { guard: 0, upward: true }, f64::INFINITY);
    for (guard, left) in exits.into_iter().enumerate() {
        if let Some(upward) = left {
            let exit = Exit { guard, upward };
            let beyond = |offset_s: f64| guard_at(motion, tau_s + offset_s, &dense.at(offset_s), exit).excess(upward);
            let offset_s = crossing(look_s, beyond);
            if offset_s < earliest.1 {
                earliest = (exit, offset_s);
            }
        }
    }
    earliest
}

fn guard_at(motion: &Motion, tau_s: f64, y: &Vector, exit: Exit) -> Guard {
    motion.system.guards(&motion.mode, &motion.interval.at(tau_s), y)[exit.guard]
}

/// Time in `0..=look_s` at which a function rises through zero; 0 when it starts there, `look_s` if the interpolant
/// disagrees with the look.
fn crossing(look_s: f64, beyond: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, look_s);
    let (mut below, mut above) = (beyond(low), beyond(high));
    if below >= 0.0 {
        return 0.0;
    }
    // regula falsi, halving the stale end (Illinois): superlinear, and never leaves the bracket
    for _ in 0..60 {
        if above <= 0.0 || high - low <= 1e-17 {
            break;
        }
        let middle = ((low * above - high * below) / (above - below)).clamp(low, high);
        let value = beyond(middle);
        if value >= 0.0 {
            if value == 0.0 {
                return middle;
            }
            (high, above) = (middle, value);
            below *= 0.5;
        } else {
            (low, below) = (middle, value);
            above *= 0.5;
        }
    }
    high
}

/// Steps from the start of the trial onto the crossing, so that the state there has the full order, and returns
/// the time from the start of the trial.
fn settle_on(
    motion: &Motion,
    tau_s: f64,
    mut offset_s: f64,
    step_s: f64,
    exit: Exit,
    slope: &Vector,
    state: &mut State,
) -> f64 {
    if offset_s <= 0.0 {
        return 0.0;
    }
    let start = state.y;
    for _ in 0..3 {
        state.y = Trial::take(motion, tau_s, &start, slope, offset_s).end;
        let guard = guard_at(motion, tau_s + offset_s, &state.y, exit);
        let excess = guard.excess(exit.upward);
        if excess.abs() < 0.5 * guard.edge {
            break;
        }
        let nudge_s = 1e-3 * step_s;
        let rate = motion.rate(tau_s + offset_s, &state.y);
        let ahead: Vector = std::array::from_fn(|index| state.y[index] + nudge_s * rate[index]);
        let later = guard_at(motion, tau_s + offset_s + nudge_s, &ahead, exit).excess(exit.upward);
        let speed = (later - excess) / nudge_s;
        if speed <= 0.0 {
            break;
        }
        offset_s = (offset_s - excess / speed).clamp(0.0, step_s);
    }
    offset_s
}
