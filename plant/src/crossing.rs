//! Where within a step a guard first leaves its band.

use crate::guard::{Exit, GUARDS, Guard};
use crate::runge_kutta::{Dense, Field, Trial};
use crate::system::Motion;
use crate::vector::{PHI_RATE, THETA, TORQUE, Vector};

/// Where within a step the guards are looked at, beside its end.
const LOOKS: [f64; 3] = [0.25, 0.5, 0.75];

/// The first exit of a step, with the step cut there; no step if the exit lies at its very start.
pub(crate) fn first(
    motion: &Motion,
    tau_s: f64,
    trial: &Trial,
    slope: &Vector,
    end_slope: &Vector,
) -> Option<(Exit, Option<Trial>)> {
    let (look_s, exits) = look(motion, tau_s, trial, slope, end_slope)?;
    let dense = trial.dense(motion, end_slope);
    let (exit, offset_s) = earliest(motion, tau_s, look_s, exits, &dense);
    Some((exit, (offset_s > 0.0).then(|| settle_on(motion, tau_s, offset_s, exit, trial, slope))))
}

/// The first look at which a guard is outside its band, and which guards are.
fn look(
    motion: &Motion,
    tau_s: f64,
    trial: &Trial,
    slope: &Vector,
    end_slope: &Vector,
) -> Option<(f64, [Option<bool>; GUARDS])> {
    let outside = |offset_s: f64, y: &Vector| {
        let guards = motion.at(tau_s + offset_s, y, |moment| motion.system.guards(moment, y));
        let left = guards.map(|guard| guard.left());
        left.iter().any(Option::is_some).then_some((offset_s, left))
    };
    LOOKS
        .iter()
        .find_map(|&share| outside(share * trial.step_s, &hermite(share, trial, slope, end_slope)))
        .or_else(|| outside(trial.step_s, &trial.end))
}

/// What guards depend on.
const GUARDED: [usize; 3] = [PHI_RATE, THETA, TORQUE];

/// Cubic through both ends of a step, of what guards depend on: good enough to see a crossing, not to place it.
fn hermite(share: f64, trial: &Trial, slope: &Vector, end_slope: &Vector) -> Vector {
    let (rest, step_s) = (1.0 - share, trial.step_s);
    let mut y = trial.start;
    for index in GUARDED {
        let rise = trial.end[index] - trial.start[index];
        let bulge = rest * (step_s * slope[index] - rise) + share * (rise - step_s * end_slope[index]);
        y[index] += share * rise + share * rest * bulge;
    }
    y
}

/// The earliest of the crossings up to a look, placed on the interpolant.
fn earliest(motion: &Motion, tau_s: f64, look_s: f64, exits: [Option<bool>; GUARDS], dense: &Dense) -> (Exit, f64) {
    let mut earliest = (Exit { guard: 0, upward: true }, f64::INFINITY);
    for (guard, left) in exits.into_iter().enumerate() {
        if let Some(upward) = left {
            let exit = Exit { guard, upward };
            let beyond = |offset_s: f64| guard_at(motion, tau_s + offset_s, &dense.at(offset_s), exit).excess(upward);
            let offset_s = zero(look_s, beyond);
            if offset_s < earliest.1 {
                earliest = (exit, offset_s);
            }
        }
    }
    earliest
}

fn guard_at(motion: &Motion, tau_s: f64, y: &Vector, exit: Exit) -> Guard {
    motion.at(tau_s, y, |moment| motion.system.guards(moment, y)[exit.guard])
}

/// Time in `0..=look_s` at which a function rises through zero; 0 when it starts there, `look_s` if the interpolant
/// disagrees with the look.
fn zero(look_s: f64, beyond: impl Fn(f64) -> f64) -> f64 {
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

/// Steps from the start of the trial onto the crossing, so that the state there has the full order.
fn settle_on(motion: &Motion, tau_s: f64, offset_s: f64, exit: Exit, trial: &Trial, slope: &Vector) -> Trial {
    let nudge_s = 1e-3 * trial.step_s;
    let mut cut = Trial::take(motion, tau_s, &trial.start, slope, offset_s);
    for _ in 0..3 {
        let end_s = tau_s + cut.step_s;
        let guard = guard_at(motion, end_s, &cut.end, exit);
        let excess = guard.excess(exit.upward);
        if excess.abs() < 0.5 * guard.edge {
            break;
        }
        let rate = motion.rate(end_s, &cut.end);
        let ahead: Vector = std::array::from_fn(|index| cut.end[index] + nudge_s * rate[index]);
        let speed = (guard_at(motion, end_s + nudge_s, &ahead, exit).excess(exit.upward) - excess) / nudge_s;
        let better_s = cut.step_s - excess / speed;
        if speed <= 0.0 || better_s <= 0.0 || better_s > trial.step_s {
            break;
        }
        cut = Trial::take(motion, tau_s, &trial.start, slope, better_s);
    }
    cut
}
