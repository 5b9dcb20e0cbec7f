//! Guards: signals that must stay inside a band while a mode lasts, and what happens when one leaves it.
//!
//! - *float*: free, theta between the stops; on a stop, the torque that holds the float there.
//! - *rate*: `w_rel` within the zone of the friction law.

use crate::row::Row;
use crate::state::{Mode, State, Stop, StopEvent, StopEventKind};
use crate::system::System;
use crate::vector::{THETA, THETA_RATE, Vector};

/// Number of guards.
pub(crate) const GUARDS: usize = 2;
const FLOAT: usize = 0;
const RATE: usize = 1;

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
    pub(crate) fn guards(&self, mode: &Mode, row: &Row, y: &Vector) -> [Guard; GUARDS] {
        let stop = self.config.gyro.stop_angle_rad;
        let float = match mode.stop {
            Stop::Free => Guard { value: y[THETA], low: -stop, high: stop, edge: EDGE_RAD },
            side => Guard { value: side.sign() * self.float_nm(row, y), low: 0.0, high: f64::INFINITY, edge: EDGE_NM },
        };
        let zone = self.zones.at(mode.zone);
        let value = Self::relative_rate_radps(row, y);
        [float, Guard { value, low: zone.low_radps, high: zone.high_radps, edge: EDGE_RADPS }]
    }

    /// Enters the mode beyond an exit.
    pub(crate) fn cross(&self, exit: Exit, row: &Row, time_s: f64, state: &mut State) {
        match exit.guard {
            FLOAT if state.mode.stop == Stop::Free => {
                let side = if exit.upward { Stop::Positive } else { Stop::Negative };
                self.contact(side, row, time_s, state);
            }
            FLOAT => release(time_s, state),
            RATE if exit.upward => state.mode.zone += 1,
            _ => state.mode.zone -= 1,
        }
    }

    /// Takes up the branches that hold under a row: inputs may have jumped.
    pub(crate) fn enter(&self, row: &Row, time_s: f64, state: &mut State) {
        state.mode.zone = self.zones.find(Self::relative_rate_radps(row, &state.y));
        if state.mode.stop != Stop::Free && self.guards(&state.mode, row, &state.y)[FLOAT].left().is_some() {
            release(time_s, state);
        }
    }

    /// The float loses its rate on the stop, and leaves at once if the torque points away.
    fn contact(&self, side: Stop, row: &Row, time_s: f64, state: &mut State) {
        state.y[THETA] = side.sign() * self.config.gyro.stop_angle_rad;
        state.y[THETA_RATE] = 0.0;
        state.mode.stop = side;
        state.events.push(StopEvent { time_s, kind: StopEventKind::Contact, side });
        if self.guards(&state.mode, row, &state.y)[FLOAT].left().is_some() {
            release(time_s, state);
        }
    }
}

fn release(time_s: f64, state: &mut State) {
    state.events.push(StopEvent { time_s, kind: StopEventKind::Release, side: state.mode.stop });
    state.mode.stop = Stop::Free;
}
