//! From one row to the next: steps as large as the error allows, cut where a guard leaves its band.

use crate::crossing;
use crate::effects::loop_delay::History;
use crate::row::Interval;
use crate::runge_kutta::{Field, Trial};
use crate::state::{Mode, State};
use crate::system::{Moment, Motion, System};
use crate::vector::Vector;

/// A step is never asked to be shorter than this; the error is then what it is [s].
const LEAST_STEP_S: f64 = 1e-9;
/// Largest step that the control proposes [s].
const LONGEST_STEP_S: f64 = 4e-3;
/// Least of the longest steps under a short delay [s].
const DELAY_STEP_S: f64 = 1e-6;
/// Crossings that are located within one period; beyond them (chatter) branches are taken up step by step.
const MOST_CROSSINGS: usize = 4000;

/// The interval from one row to the next, and how closely it is followed.
pub(crate) struct Advance<'a> {
    pub(crate) system: &'a System,
    pub(crate) interval: &'a Interval,
    /// Time at the first of the two rows [s].
    pub(crate) start_s: f64,
    pub(crate) tolerance: f64,
}

impl Advance<'_> {
    /// Advances the state over the interval.
    pub(crate) fn run(&self, state: &mut State) {
        self.enter(0.0, state);
        let (corners, count) = self.system.bearings.corners_s(self.interval);
        let mut tau_s = 0.0;
        let mut crossings = 0;
        for &corner_s in &corners[..count] {
            let mut slope = None;
            while tau_s < corner_s {
                let felt_s = state.past.as_ref().and_then(|past| past.next_felt_s(self.start_s + tau_s));
                let end_s = felt_s.map_or(corner_s, |felt_s| corner_s.min(felt_s - self.start_s));
                tau_s = self.step(tau_s, end_s, &mut slope, &mut crossings, state);
            }
        }
        state.periods += 1;
    }

    /// Tries one step towards `end_s` and returns the time reached, which is `tau_s` when the error is too large.
    ///
    /// `slope` is the slope at `tau_s` if it is known.
    fn step(
        &self,
        tau_s: f64,
        end_s: f64,
        slope: &mut Option<Vector>,
        crossings: &mut usize,
        state: &mut State,
    ) -> f64 {
        let motion = self.motion(state.mode, state.past.as_ref());
        let first_slope = slope.unwrap_or_else(|| motion.rate(tau_s, &state.y));
        let step_s = share_of(end_s - tau_s, state.step_s.min(self.longest_s()));
        let mut trial = Trial::take(&motion, tau_s, &state.y, &first_slope, step_s);
        let error = trial.error(&state.peak) / self.tolerance;
        let factor = if error > 0.0 { (0.9 * error.powf(-0.125)).clamp(0.2, 6.0) } else { 6.0 };
        state.steps += 1;
        if error > 1.0 && step_s > LEAST_STEP_S {
            state.step_s = (step_s * factor).max(LEAST_STEP_S);
            *slope = Some(first_slope);
            return tau_s;
        }
        // At the largest factor the step was cut short by the row and says nothing against the longer one.
        let proposal = if factor < 6.0 { step_s * factor } else { state.step_s.max(step_s * factor) };
        let watched = *crossings < MOST_CROSSINGS;
        let mut last_slope = motion.rate(tau_s + step_s, &trial.end);
        let crossing = watched.then(|| crossing::first(&motion, tau_s, &trial, &first_slope, &last_slope)).flatten();
        let mut taken = true;
        let exit = crossing.map(|(exit, cut)| {
            match cut {
                Some(cut) => {
                    last_slope = motion.rate(tau_s + cut.step_s, &cut.end);
                    trial = cut;
                }
                None => taken = false,
            }
            exit
        });
        let dense = (taken && state.past.is_some()).then(|| trial.dense(&motion, &last_slope));
        state.step_s = proposal.min(LONGEST_STEP_S);
        // The last step ends on the end of the span to the bit.
        let reached_s = match taken {
            true if trial.step_s >= end_s - tau_s => end_s,
            true => tau_s + trial.step_s,
            false => tau_s,
        };
        if taken {
            state.y = trial.end;
        }
        if let (Some(past), Some(dense)) = (&mut state.past, dense) {
            past.keep(self.start_s + tau_s, &dense);
        }
        *slope = Some(last_slope);
        if let Some(exit) = exit {
            *crossings += 1;
            *slope = None;
            self.now(reached_s, state, |moment, state| self.system.cross(exit, moment, state));
            if let Some(past) = &mut state.past {
                past.feel_at(self.start_s + reached_s + self.system.laws.delay_s);
            }
        } else if !watched {
            *slope = None;
            self.enter(reached_s, state);
        }
        state.note_peaks();
        reached_s
    }

    fn enter(&self, tau_s: f64, state: &mut State) {
        self.now(tau_s, state, |moment, state| self.system.enter(moment, state));
    }

    /// Changes the state by a function of the moment that it is in.
    fn now(&self, tau_s: f64, state: &mut State, change: impl FnOnce(&Moment, &mut State)) {
        let time_s = self.start_s + tau_s;
        let command_nm = self.system.command_nm(state.past.as_ref(), time_s, &state.y);
        let mode = state.mode;
        change(&Moment { row: &self.interval.at(tau_s), time_s, mode: &mode, command_nm }, state);
    }

    fn motion<'a>(&'a self, mode: Mode, past: Option<&'a History>) -> Motion<'a> {
        Motion { system: self.system, interval: self.interval, mode, start_s: self.start_s, past }
    }

    /// No step may refer to a delayed torque of its own.
    fn longest_s(&self) -> f64 {
        let delay_s = self.system.laws.delay_s;
        if delay_s > 0.0 { delay_s.max(DELAY_STEP_S) } else { LONGEST_STEP_S }
    }
}

/// The step that divides the rest evenly and is no longer than the one proposed.
fn share_of(rest_s: f64, proposed_s: f64) -> f64 {
    if rest_s <= proposed_s { rest_s } else { rest_s / (rest_s / proposed_s).ceil() }
}
