//! The plant as its users see it.

use gimbal_servo::{BuildError, Config};

use crate::advance;
use crate::row::{Between, Interval, Row};
use crate::sample::Sample;
use crate::state::State;
use crate::system::System;
use crate::vector::{PHI, PHI_RATE, POSITION, RELATIVE, THETA, THETA_RATE, TORQUE, VELOCITY};

/// Local error of each step, relative to the peak of each quantity so far: runs come out at 1e-10 to 1e-11 of it.
const DEFAULT_TOLERANCE: f64 = 1e-10;

/// One gimbal axis, immutable.
#[derive(Debug, Clone)]
pub struct Plant {
    system: System,
    tolerance: f64,
    between: Between,
}

impl Plant {
    /// The nominal plant of a configuration.
    ///
    /// # Errors
    /// What [`Config::check`] finds wrong.
    pub fn new(config: &Config) -> Result<Self, BuildError> {
        config.check()?;
        let between = Between::from(config.interpolation);
        Ok(Self { system: System::new(config), tolerance: DEFAULT_TOLERANCE, between })
    }

    /// Sets the local error of a step, relative to the peak of each quantity so far.
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance.clamp(1e-15, 1e-2);
        self
    }

    /// Sets what the inputs do between two rows.
    #[must_use]
    pub fn with_inputs(mut self, between: Between) -> Self {
        self.between = between;
        self
    }

    /// Time between two rows [s].
    #[must_use]
    pub fn period_s(&self) -> f64 {
        self.system.config.period_s
    }

    /// Everything zero.
    #[must_use]
    pub fn start(&self) -> State {
        State::zero(self.system.floor())
    }

    /// Steady under a row: phi and theta zero, the servo carrying the disturbance.
    #[must_use]
    pub fn settled(&self, row: &Row) -> State {
        let mut state = self.start();
        state.y = self.system.settled(row);
        state.note_peaks();
        state
    }

    /// Advances one period, from `previous` to `row`, and samples at `row`.
    pub fn step(&self, state: &mut State, previous: &Row, row: &Row) -> Sample {
        let interval = Interval::new(previous, row, self.period_s(), self.between);
        advance::over(&self.system, self.tolerance, &interval, self.time_s(state), state);
        self.sample(state, &interval.at(self.period_s()))
    }

    /// The sample of a state under a row.
    #[must_use]
    pub fn sample(&self, state: &State, row: &Row) -> Sample {
        let y = &state.y;
        let zone = self.system.zones.find(System::relative_rate_radps(row, y));
        Sample {
            time_s: self.time_s(state),
            gimbal_angle_rad: y[PHI],
            gimbal_rate_radps: y[PHI_RATE],
            gyro_angle_rad: y[THETA],
            gyro_rate_radps: y[THETA_RATE],
            relative_angle_rad: y[RELATIVE],
            motor_torque_nm: y[TORQUE],
            friction_torque_nm: self.system.friction_nm(zone, row, y),
            unbalance_torque_nm: self.system.unbalance_nm(row),
            stop: state.mode.stop,
            velocity_error_mps: [y[VELOCITY], y[VELOCITY + 1]],
            position_error_m: [y[POSITION], y[POSITION + 1]],
        }
    }

    /// Runs from zero: one sample a row, the first before any time has passed.
    pub fn run<'a, I>(&'a self, rows: I) -> impl Iterator<Item = Sample> + use<'a, I>
    where
        I: IntoIterator<Item = Row>,
        I::IntoIter: 'a,
    {
        self.run_from(self.start(), rows)
    }

    /// Runs from a state: one sample a row, the first before any time has passed.
    pub fn run_from<'a, I>(&'a self, mut state: State, rows: I) -> impl Iterator<Item = Sample> + use<'a, I>
    where
        I: IntoIterator<Item = Row>,
        I::IntoIter: 'a,
    {
        let mut previous: Option<Row> = None;
        rows.into_iter().map(move |row| {
            let sample = match previous {
                Some(previous) => self.step(&mut state, &previous, &row),
                None => self.sample(&state, &row),
            };
            previous = Some(row);
            sample
        })
    }

    #[allow(clippy::cast_precision_loss, reason = "2^53 periods are 285,000 years at 1 ms")]
    fn time_s(&self, state: &State) -> f64 {
        state.periods as f64 * self.period_s()
    }
}
