//! Guards: signals that must stay inside a band while a mode lasts, and what happens when one leaves it.
//!
//! - *float*: free, theta between the stops; on a stop, the torque that holds the float there.
//! - *rate*: `w_rel` within the zone of the friction law.
//! - *command*: the motor's command within one stretch of clamp and dead zone.
//! - *cell*: theta within one step of the pick-off.

use crate::effects::pickoff_quantisation;
use crate::effects::presliding::Reversal;
use crate::state::{Mode, State, Stop, StopEvent, StopEventKind};
use crate::system::{Moment, System};
use crate::vector::{RELATIVE, THETA, THETA_RATE, Vector};

/// Number of guards.
pub(crate) const GUARDS: usize = 4;
const FLOAT: usize = 0;
const RATE: usize = 1;
const COMMAND: usize = 2;

/// Size below which a signal counts as being on the edge of its band: what rounding and location leave over.
const EDGE_RAD: f64 = 1e-14;
const EDGE_NM: f64 = 1e-13;
const EDGE_RADPS: f64 = 1e-12;

/// A signal and the band it may move in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Guard {
    pub(crate) value: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) edge: f64,
}

/// A guard and the end of its band at which it was left.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Exit {
    pub(crate) guard: usize,
    pub(crate) upward: bool,
}

impl Guard {
    /// Whether the band is left, and at which end.
    pub(crate) fn left(&self) -> Option<bool> {
        if self.value > self.high + self.edge {
            Some(true)
        } else if self.value < self.low - self.edge {
            Some(false)
        } else {
            None
        }
    }

    /// How far the signal is beyond one end of the band.
    pub(crate) fn excess(&self, upward: bool) -> f64 {
        if upward { self.value - self.high } else { self.low - self.value }
    }
}

impl System {
    /// Every guard of the mode, in fixed order.
    pub(crate) fn guards(&self, moment: &Moment, y: &Vector) -> [Guard; GUARDS] {
        let mode = moment.mode;
        let zone = self.zones.at(mode.zone);
        let rate = moment.relative_rate_radps(y);
        let stretch = &self.stretches[mode.stretch];
        let step = self.laws.pickoff_step_rad;
        let half = if step > 0.0 { 0.5 * step } else { f64::INFINITY };
        let centre = step * mode.cell;
        [
            self.float_guard(moment, y),
            Guard { value: rate, low: zone.low_radps, high: zone.high_radps, edge: EDGE_RADPS },
            Guard { value: moment.command_nm, low: stretch.low_nm, high: stretch.high_nm, edge: EDGE_NM },
            Guard { value: y[THETA], low: centre - half, high: centre + half, edge: EDGE_RAD },
        ]
    }

    fn float_guard(&self, moment: &Moment, y: &Vector) -> Guard {
        let stop = self.config.gyro.stop_angle_rad;
        match moment.mode.stop {
            Stop::Free => Guard { value: y[THETA], low: -stop, high: stop, edge: EDGE_RAD },
            side => {
                let holding = side.sign() * self.float_nm(moment.row, y);
                Guard { value: holding, low: 0.0, high: f64::INFINITY, edge: EDGE_NM }
            }
        }
    }

    /// Enters the mode beyond an exit.
    pub(crate) fn cross(&self, exit: Exit, moment: &Moment, state: &mut State) {
        let next = |index: usize| if exit.upward { index + 1 } else { index - 1 };
        match exit.guard {
            FLOAT if state.mode.stop == Stop::Free => {
                let side = if exit.upward { Stop::Positive } else { Stop::Negative };
                self.contact(side, moment, state);
            }
            FLOAT => release(moment.time_s, state),
            RATE => self.change_zone(next(state.mode.zone), &state.y, &mut state.mode),
            COMMAND => state.mode.stretch = next(state.mode.stretch),
            _ => state.mode.cell += if exit.upward { 1.0 } else { -1.0 },
        }
    }

    /// The branches that hold at a moment, whatever held before.
    pub(crate) fn branches(&self, moment: &Moment, y: &Vector) -> Mode {
        let mut mode = *moment.mode;
        self.change_zone(self.zones.find(moment.relative_rate_radps(y)), y, &mut mode);
        let last = self.stretches.len() - 1;
        mode.stretch = self.stretches.iter().position(|stretch| moment.command_nm <= stretch.high_nm).unwrap_or(last);
        mode.cell = pickoff_quantisation::cell(self.laws.pickoff_step_rad, y[THETA]);
        mode
    }

    /// Takes up the branches that hold now: inputs may have jumped.
    pub(crate) fn enter(&self, moment: &Moment, state: &mut State) {
        state.mode = self.branches(moment, &state.y);
        if state.mode.stop != Stop::Free && self.float_guard(moment, &state.y).left().is_some() {
            release(moment.time_s, state);
        }
    }

    /// A change of sign is a reversal, which presliding friction remembers.
    fn change_zone(&self, zone: usize, y: &Vector, mode: &mut Mode) {
        if let Some(presliding) = self.laws.presliding {
            let (from, to) = (self.zones.at(mode.zone).sign, self.zones.at(zone).sign);
            if from * to < 0.0 {
                let ratio = presliding.ratio(&mode.reversal, from, y[RELATIVE]);
                mode.reversal = Reversal { ratio, relative_rad: y[RELATIVE] };
            }
        }
        mode.zone = zone;
    }

    /// The float loses its rate on the stop, and leaves at once if the torque points away.
    fn contact(&self, side: Stop, moment: &Moment, state: &mut State) {
        state.y[THETA] = side.sign() * self.config.gyro.stop_angle_rad;
        state.y[THETA_RATE] = 0.0;
        state.mode.stop = side;
        state.events.push(StopEvent { time_s: moment.time_s, kind: StopEventKind::Contact, side });
        let moment = Moment { mode: &state.mode.clone(), ..*moment };
        if self.float_guard(&moment, &state.y).left().is_some() {
            release(moment.time_s, state);
        }
    }
}

fn release(time_s: f64, state: &mut State) {
    state.events.push(StopEvent { time_s, kind: StopEventKind::Release, side: state.mode.stop });
    state.mode.stop = Stop::Free;
}
