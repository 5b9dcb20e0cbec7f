//! `loop_delay`: a pure delay of the motor torque.
//!
//! ```text
//! T_m(t) = motor torque behind the lag at t - d
//! ```
//!
//! Block `servo`. Changes `gyro_angle_rad`, `motor_torque_nm` and the angles of the gimbal. *Consistent* has 28 deg
//! of phase margin at 526 rad/s: the loop is unstable from about 0.9 ms. The past is kept as the interpolants of the
//! steps taken, and no step is longer than the delay.

use std::collections::VecDeque;

use super::Altered;
use crate::runge_kutta::{Dense, nested};
use crate::vector::{THETA, TORQUE, Vector};

/// theta and motor torque of the recent past.
#[derive(Debug, Clone)]
pub(crate) struct History {
    span_s: f64,
    before: [f64; 2],
    pieces: VecDeque<Piece>,
    /// Times at which the corner of an earlier crossing comes out of the delay, rising [s].
    felt_s: VecDeque<f64>,
}

/// Interpolants of theta and of the motor torque over one step.
#[derive(Debug, Clone, Copy)]
struct Piece {
    from_s: f64,
    step_s: f64,
    start: [f64; 2],
    coefficients: [[f64; 7]; 2],
}

/// What the history holds.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Past {
    Theta,
    Torque,
}

impl History {
    /// An empty history: what there was before the start is the start.
    pub(crate) fn new(span_s: f64, y: &Vector) -> Self {
        Self { span_s, before: [y[THETA], y[TORQUE]], pieces: VecDeque::new(), felt_s: VecDeque::new() }
    }

    /// Before its first step a run may still be given another beginning.
    pub(crate) fn begin(&mut self, y: &Vector) {
        if self.pieces.is_empty() {
            self.before = [y[THETA], y[TORQUE]];
        }
    }

    pub(crate) fn keep(&mut self, from_s: f64, dense: &Dense) {
        let (step_s, start, coefficients) = dense.of([THETA, TORQUE]);
        self.pieces.push_back(Piece { from_s, step_s, start, coefficients });
        // a margin above the rounding of times: the end of the delay itself is still asked for
        let oldest_s = from_s + step_s - self.span_s - 1e-9;
        while self.pieces.front().is_some_and(|piece| piece.from_s + piece.step_s < oldest_s) {
            self.pieces.pop_front();
        }
    }

    /// A crossing leaves a corner in the torque, and steps must end where it comes out of the delay.
    pub(crate) fn feel_at(&mut self, time_s: f64) {
        self.felt_s.push_back(time_s);
        while self.felt_s.front().is_some_and(|first_s| *first_s < time_s - self.span_s) {
            self.felt_s.pop_front();
        }
    }

    /// The next such time; those closer than rounding are past.
    pub(crate) fn next_felt_s(&self, time_s: f64) -> Option<f64> {
        self.felt_s.iter().copied().find(|felt_s| *felt_s > time_s + 1e-12)
    }

    pub(crate) fn at(&self, past: Past, time_s: f64) -> f64 {
        let index = past as usize;
        // From the oldest: the delay is most of the span.
        for piece in &self.pieces {
            let offset_s = time_s - piece.from_s;
            if offset_s < 0.0 {
                break;
            }
            if offset_s <= piece.step_s {
                return piece.start[index] + nested(offset_s / piece.step_s, |order| piece.coefficients[index][order]);
            }
        }
        match (self.pieces.front(), self.pieces.back()) {
            (Some(_), Some(last)) if time_s > last.from_s => {
                last.start[index] + nested(1.0, |order| last.coefficients[index][order])
            }
            (Some(first), _) if time_s > first.from_s => first.start[index],
            _ => self.before[index],
        }
    }
}

pub(super) fn apply(values: &[f64], altered: &mut Altered) {
    altered.laws.delay_s += values[0];
}
