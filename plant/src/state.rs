//! What the plant remembers between two rows.

use crate::effects::loop_delay::History;
use crate::effects::measurement::Rows;
use crate::effects::presliding::Reversal;
use crate::vector::Vector;

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
    /// Index of the stretch of the motor's command.
    pub(crate) stretch: usize,
    /// Cell of the pick-off, a whole number.
    pub(crate) cell: f64,
    /// Last change of the sign of `w_rel`.
    pub(crate) reversal: Reversal,
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
    /// theta and motor torque as long ago as a delay asks for.
    pub(crate) past: Option<History>,
    /// Rows as long ago as a late log asks for.
    pub(crate) rows: Rows,
}

impl State {
    /// A run begins at `y`; nothing is resolved below `floor`, and so much of the past is kept.
    pub(crate) fn new(y: Vector, mode: Mode, floor: Vector, past_s: f64) -> Self {
        let past = (past_s > 0.0).then(|| History::new(past_s, &y));
        let rows = Rows::default();
        let mut state =
            Self { y, mode, peak: floor, step_s: 1e-4, periods: 0, events: Vec::new(), steps: 0, past, rows };
        state.note_peaks();
        state
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
