//! The plant as its users see it.

use gimbal_servo::{BuildError, Config};

use crate::advance::Advance;
use crate::effects::loop_delay::Past;
use crate::effects::{Altered, Effect, EffectError, Laws, pickoff_quantisation};
use crate::row::{Between, Interval, Row};
use crate::sample::{Logged, Sample};
use crate::state::{Mode, State};
use crate::system::{Moment, System};
use crate::vector::{N, PHI, PHI_RATE, POSITION, RELATIVE, THETA, THETA_RATE, VELOCITY};

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
        let altered = Altered { config: *config, laws: Laws::default() };
        Ok(Self { system: System::new(&altered), tolerance: DEFAULT_TOLERANCE, between })
    }

    /// The plant with one effect more; `values` in the order of [`Effect::parameters`].
    ///
    /// Effects add up; one that is given twice adds to itself where it is a plain coefficient or change, and is
    /// replaced otherwise.
    ///
    /// # Errors
    /// A wrong number of values, a value without meaning, or a configuration that is wrong with the effect.
    pub fn with_effect(&self, effect: Effect, values: &[f64]) -> Result<Self, EffectError> {
        let mut altered = Altered { config: self.system.config, laws: self.system.laws };
        effect.apply(values, &mut altered)?;
        altered.config.check()?;
        Ok(Self { system: System::new(&altered), ..self.clone() })
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
        State::new([0.0; N], Mode::default(), self.system.floor(), self.system.past_s())
    }

    /// Steady under a row: phi and theta zero, the servo carrying the disturbance.
    #[must_use]
    pub fn settled(&self, row: &Row) -> State {
        let (y, mode) = self.system.settled(row);
        State::new(y, mode, self.system.floor(), self.system.past_s())
    }

    /// Advances one period, from `previous` to `row`, and samples at `row`.
    pub fn step(&self, state: &mut State, previous: &Row, row: &Row) -> Sample {
        let interval = &Interval::new(previous, row, self.period_s(), self.between);
        let start_s = self.time_s(state);
        Advance { system: &self.system, interval, start_s, tolerance: self.tolerance }.run(state);
        state.rows.keep(previous, self.system.laws.measurement.skew_s, self.period_s());
        self.sample_under(state, &interval.at(self.period_s()), row)
    }

    /// The sample of a state under a row.
    #[must_use]
    pub fn sample(&self, state: &State, row: &Row) -> Sample {
        self.sample_under(state, row, row)
    }

    /// `acting` is what acts at the end of the interval, `row` what the sensors find there.
    fn sample_under(&self, state: &State, acting: &Row, row: &Row) -> Sample {
        let (system, y, time_s) = (&self.system, &state.y, self.time_s(state));
        let command_nm = system.command_nm(state.past.as_ref(), time_s, y);
        let before = Moment { row: acting, time_s, mode: &state.mode, command_nm };
        let mode = system.branches(&before, y);
        let moment = Moment { mode: &mode, ..before };
        Sample {
            time_s,
            gimbal_angle_rad: y[PHI],
            gimbal_rate_radps: y[PHI_RATE],
            gyro_angle_rad: y[THETA],
            gyro_rate_radps: y[THETA_RATE],
            relative_angle_rad: y[RELATIVE],
            motor_torque_nm: system.laws.motor.torque_nm(command_nm),
            friction_torque_nm: system.friction_nm(&moment, y),
            unbalance_torque_nm: system.unbalance_nm(acting),
            stop: state.mode.stop,
            velocity_error_mps: [y[VELOCITY], y[VELOCITY + 1]],
            position_error_m: [y[POSITION], y[POSITION + 1]],
            logged: self.logged(state, time_s, row),
        }
    }

    fn logged(&self, state: &State, time_s: f64, row: &Row) -> Logged {
        let (laws, past) = (&self.system.laws, state.past.as_ref());
        let measurement = &laws.measurement;
        let (theta, command) = match past {
            Some(past) if measurement.skew_s < 0.0 => {
                let late_s = time_s + measurement.skew_s;
                (past.at(Past::Theta, late_s), past.at(Past::Torque, late_s - laws.delay_s))
            }
            _ => (state.y[THETA], self.system.command_nm(past, time_s, &state.y)),
        };
        let cell = pickoff_quantisation::cell(laws.pickoff_step_rad, theta);
        let seen = pickoff_quantisation::seen_rad(laws.pickoff_step_rad, cell, theta);
        Logged {
            gyro_angle_rad: measurement.gyro_angle_rad(seen),
            motor_torque_nm: measurement.motor_torque_nm(laws.motor.torque_nm(command)),
            inputs: measurement.row(&state.rows, row, self.period_s()),
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
