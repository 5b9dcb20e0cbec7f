//! What the plant remembers between two rows.

use crate::vector::{N, Vector};

/// Where the gyro's float is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stop {
    /// Between the stops.
    #[default]
    Free,
    /// On the stop at `+stop_angle_rad`.
    Positive,
    /// On the stop at `-stop_angle_rad`.
    Negative,
}

/// The float reaches or leaves a stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StopEvent {
    /// When, since the first row [s].
    pub time_s: f64,
    /// Which of the two.
    pub kind: StopEventKind,
    /// The stop; never [`Stop::Free`].
    pub side: Stop,
}

/// What happens at a [`StopEvent`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopEventKind {
    /// The float hits the stop and loses its rate.
    Contact,
    /// The torque on the float points away from the stop.
    Release,
}

impl Stop {
    /// +1, -1, or 0 when free.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Free => 0.0,
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }
}

/// Which smooth branch of every law holds.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Mode {
    pub(crate) stop: Stop,
    /// Index of the friction zone.
    pub(crate) zone: usize,
}

/// State of a [`Plant`](crate::Plant); plain data, which may be cloned to branch a run.
#[derive(Debug, Clone)]
pub struct State {
    pub(crate) y: Vector,
    pub(crate) mode: Mode,
    /// Largest size of each quantity so far: what errors are measured against.
    pub(crate) peak: Vector,
    /// Step size that the last error asks for [s].
    pub(crate) step_s: f64,
    pub(crate) periods: u64,
    pub(crate) events: Vec<StopEvent>,
    pub(crate) steps: u64,
}

impl State {
    pub(crate) fn zero(floor: Vector) -> Self {
        let mode = Mode::default();
        Self { y: [0.0; N], mode, peak: floor, step_s: 1e-4, periods: 0, events: Vec::new(), steps: 0 }
    }

    /// Contacts and releases so far, in order.
    #[must_use]
    pub fn events(&self) -> &[StopEvent] {
        &self.events
    }

    /// Steps of the integrator so far.
    #[must_use]
    pub fn integrator_steps(&self) -> u64 {
        self.steps
    }

    pub(crate) fn note_peaks(&mut self) {
        for (peak, value) in self.peak.iter_mut().zip(&self.y) {
            *peak = peak.max(value.abs());
        }
    }
}
