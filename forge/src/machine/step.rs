//! One step of Runge-Kutta of order 4, cut where the float meets a stop or leaves it.

use super::{Machine, PHI_RATE, RELATIVE, Stage, States, Stop, THETA, THETA_RATE};
use crate::memory::Path;
use crate::palmgren::Palmgren;
use crate::track::Track;

/// Smallest piece of a step that is still cut at an event [s].
const SHORTEST_S: f64 = 1e-12;

impl Machine<'_> {
    /// One step of `step_s` that begins a share `part` of the way from row `row` to the next; `loads_nm` at begin,
    /// middle and end where they are known.
    pub(super) fn step(
        &mut self,
        track: &Track,
        (row, part): (usize, f64),
        loads_nm: Option<[f64; 3]>,
        step_s: f64,
        time_s: f64,
    ) {
        let (from, to) = track.around(row);
        let series = |place: usize| self.truth.torque.series_nm.get(place).copied().unwrap_or(0.0);
        let (extra_from, extra_to) = (series(row), series(row + 1));
        let (noise_from, noise_to) = (self.pickoff_noise_rad(row), self.pickoff_noise_rad(row + 1));
        let noise_at = |share: f64| noise_from + (noise_to - noise_from) * share;
        let known_at = |offset_s: f64, since_commit_s: f64, load_nm: Option<f64>, palmgren: &Palmgren| {
            let share = part + offset_s / track.period_s;
            let mut row = from.towards(to, share);
            row.external_nm += extra_from + (extra_to - extra_from) * share;
            let load_nm = load_nm.unwrap_or_else(|| palmgren.load_nm(row.accel_mps2));
            let pickoff_noise_rad = noise_at(share);
            Stage { row, load_nm, pickoff_noise_rad, time_s: time_s + offset_s, since_commit_s }
        };
        let stage_at = |palmgren: &Palmgren, offset_s: f64, since_commit_s: f64| {
            known_at(offset_s, since_commit_s, None, palmgren)
        };
        self.note_command(time_s, noise_at(part));
        let mut done_s = 0.0;
        while step_s - done_s > SHORTEST_S {
            // a step that was cut has other middles
            let known = loads_nm.filter(|_| done_s == 0.0);
            let load = |place: usize| known.map(|loads| loads[place]);
            let begin = known_at(done_s, 0.0, load(0), &self.palmgren);
            let mut piece_s = step_s - done_s;
            let middle = known_at(done_s + 0.5 * piece_s, 0.5 * piece_s, load(1), &self.palmgren);
            let end = known_at(done_s + piece_s, piece_s, load(2), &self.palmgren);
            let mut after = self.runge_kutta(&begin, &middle, &end, done_s, piece_s);
            let overshoot = |machine: &Self, states: &States, stage: &Stage| machine.beyond_event(states, stage);
            let mut last = end;
            let mut event = false;
            if overshoot(self, &after, &end) > 0.0 {
                // bisection on the length of the step: the flag turns once within it
                let (mut short_s, mut long_s) = (0.0, piece_s);
                for _ in 0..48 {
                    let trial_s = 0.5 * (short_s + long_s);
                    let middle = stage_at(&self.palmgren, done_s + 0.5 * trial_s, 0.5 * trial_s);
                    let end = stage_at(&self.palmgren, done_s + trial_s, trial_s);
                    let trial = self.runge_kutta(&begin, &middle, &end, done_s, trial_s);
                    if overshoot(self, &trial, &end) > 0.0 {
                        (long_s, after, last) = (trial_s, trial, end);
                    } else {
                        short_s = trial_s;
                    }
                }
                piece_s = long_s;
                event = true;
            }
            self.commit(after, &last, piece_s);
            if event {
                self.pass_event(last.time_s);
            }
            done_s += piece_s.max(SHORTEST_S);
        }
    }

    /// Above 0 when the float has passed a stop, or is pushed away from the one it lies on.
    fn beyond_event(&self, states: &States, stage: &Stage) -> f64 {
        let stop_rad = self.truth.config.gyro.stop_angle_rad;
        match self.stop {
            Stop::Free => states[THETA].abs() - stop_rad,
            Stop::Upper => -self.float_torque_nm(states, stage),
            Stop::Lower => self.float_torque_nm(states, stage),
        }
    }

    fn pass_event(&mut self, time_s: f64) {
        self.events_s.push(time_s);
        let stop_rad = self.truth.config.gyro.stop_angle_rad;
        match self.stop {
            Stop::Free => {
                self.stop = if self.states[THETA] > 0.0 { Stop::Upper } else { Stop::Lower };
                self.states[THETA] = stop_rad.copysign(self.states[THETA]);
                self.states[THETA_RATE] = 0.0;
            }
            Stop::Upper | Stop::Lower => self.stop = Stop::Free,
        }
    }

    fn commit(&mut self, states: States, stage: &Stage, piece_s: f64) {
        let path = self.path(&states, stage, piece_s);
        self.memory.commit(self.truth, path, states[RELATIVE]);
        self.states = states;
    }

    pub(super) fn path(&self, states: &States, stage: &Stage, time_s: f64) -> Path {
        let slip_radps = self.truth.config.bearing.slip_rate_radps;
        let rate = stage.row.rate_radps - states[PHI_RATE];
        Path {
            moved_rad: states[RELATIVE] - self.states[RELATIVE],
            time_s,
            rate_radps: rate,
            curve: (rate / slip_radps).clamp(-1.0, 1.0),
            slip_radps,
        }
    }

    fn runge_kutta(&self, begin: &Stage, middle: &Stage, end: &Stage, done_s: f64, step_s: f64) -> States {
        let along = |slope: &States, time_s: f64| -> States {
            core::array::from_fn(|index| self.states[index] + time_s * slope[index])
        };
        let k1 = self.slope(&self.states, begin, done_s);
        let k2 = self.slope(&along(&k1, 0.5 * step_s), middle, done_s + 0.5 * step_s);
        let k3 = self.slope(&along(&k2, 0.5 * step_s), middle, done_s + 0.5 * step_s);
        let k4 = self.slope(&along(&k3, step_s), end, done_s + step_s);
        core::array::from_fn(|index| {
            self.states[index] + step_s / 6.0 * (k1[index] + 2.0 * (k2[index] + k3[index]) + k4[index])
        })
    }
}
