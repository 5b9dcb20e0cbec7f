//! What the plant remembers between two rows.

use crate::effects::loop_delay::History;
use crate::effects::measurement::Rows;
use crate::effects::presliding::Reversal;
use crate::vector::{INTEGRATOR, PHI, PHI_RATE, RELATIVE, SECTION, THETA, THETA_RATE, TORQUE, Vector};

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

/// An integrated quantity of the loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// phi [rad].
    GimbalAngle,
    /// phi' [rad/s].
    GimbalRate,
    /// theta [rad].
    GyroAngle,
    /// theta' [rad/s].
    GyroRate,
    /// State of the section `(1 + Ti s) / (1 + Tj s)`, 0 to 3 for T6 to T9 [N m/s]; zero when settled.
    Section(usize),
    /// The integrator of F(s), which carries a steady disturbance [N m].
    Integrator,
    /// Motor torque behind the lag [N m].
    MotorTorque,
    /// rel, vehicle against stable member [rad].
    RelativeAngle,
}

impl Quantity {
    fn index(self) -> usize {
        match self {
            Self::GimbalAngle => PHI,
            Self::GimbalRate => PHI_RATE,
            Self::GyroAngle => THETA,
            Self::GyroRate => THETA_RATE,
            Self::Section(section) => SECTION + section.min(INTEGRATOR - SECTION - 1),
            Self::Integrator => INTEGRATOR,
            Self::MotorTorque => TORQUE,
            Self::RelativeAngle => RELATIVE,
        }
    }
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

    /// One integrated quantity.
    #[must_use]
    pub fn value(&self, quantity: Quantity) -> f64 {
        self.y[quantity.index()]
    }

    /// Sets one integrated quantity: a run that begins in an estimated state.
    ///
    /// Beyond the stops theta is put back by the contact that follows at once.
    pub fn set(&mut self, quantity: Quantity, value: f64) {
        self.y[quantity.index()] = value;
        if let Some(past) = &mut self.past {
            past.begin(&self.y);
        }
        self.note_peaks();
    }

    pub(crate) fn note_peaks(&mut self) {
        for (peak, value) in self.peak.iter_mut().zip(&self.y) {
            *peak = peak.max(value.abs());
        }
    }
}
