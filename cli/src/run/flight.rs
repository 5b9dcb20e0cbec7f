//! The flight law: the code that is tested and flown, stepped as a flight computer would.

use gimbal_servo::{BuildError, Config, Digest, Faults, Law, Number, Output, State, Stop, effects};

use super::model::{Drive, Initial, Model, Sample, Totals, share_on_stop};

/// The law in one number system.
pub(crate) struct Flight<N: Number> {
    law: Law<N>,
    state: State<N>,
    /// Steps in place of the law where there are effects.
    effects: Option<(effects::Law<N>, effects::State<N>)>,
    initial: Initial,
    output: Option<Output<N>>,
    digest: Digest,
    period_s: f64,
    samples: u64,
    peak_gimbal_angle: N,
    peak_gyro_angle: N,
    periods_on_stop: f64,
    faults: Faults,
}

impl<N: Number> Flight<N> {
    /// The nominal axis before the first row.
    pub(crate) fn new(config: &Config, initial: Initial) -> Result<Self, BuildError> {
        Self::with_effects(config, &effects::Config::default(), initial)
    }

    /// Before the first row.
    pub(crate) fn with_effects(
        config: &Config,
        effects: &effects::Config,
        initial: Initial,
    ) -> Result<Self, BuildError> {
        let law: Law<N> = config.build()?;
        let effects = if *effects == effects::Config::default() {
            None
        } else {
            let law = config.build_with(effects)?;
            Some((law, law.start()))
        };
        Ok(Self {
            effects,
            state: law.start(),
            law,
            initial,
            output: None,
            digest: Digest::default(),
            period_s: config.period_s,
            samples: 0,
            peak_gimbal_angle: N::ZERO,
            peak_gyro_angle: N::ZERO,
            periods_on_stop: 0.0,
            faults: Faults::NONE,
        })
    }

    /// What has stepped.
    fn axis(&self) -> &State<N> {
        self.effects.as_ref().map_or(&self.state, |(_, state)| state.axis())
    }
}

impl<N: Number> Model for Flight<N> {
    #[inline]
    fn step(&mut self, row: &Drive) {
        let input = self.law.units().input(&row.input);
        if self.samples == 0 && self.initial == Initial::Settled {
            self.state = self.law.settled(input);
            if let Some((law, state)) = &mut self.effects {
                *state = law.settled(input);
            }
        }
        let output = match &mut self.effects {
            None => self.law.step(&mut self.state, input),
            Some((law, state)) => law.step(state, input),
        };
        self.digest.add_output(&output);
        self.samples += 1;
        self.faults |= output.faults;
        raise(&mut self.peak_gimbal_angle, output.gimbal_angle_rad);
        raise(&mut self.peak_gyro_angle, output.gyro_angle_rad);
        let on_stop = output.stop != Stop::Free;
        if on_stop || output.stop_change_age > N::ZERO {
            self.periods_on_stop += share_on_stop(on_stop, output.stop_change_age.to_f64(0));
        }
        self.output = Some(output);
    }

    fn sample(&self) -> Sample {
        let output = self.output.as_ref().map(|output| self.law.units().output(output));
        let of = |signal: fn(&Output<f64>) -> f64| output.as_ref().map_or(0.0, signal);
        Sample {
            gimbal_angle_rad: of(|output| output.gimbal_angle_rad),
            gyro_angle_rad: of(|output| output.gyro_angle_rad),
            motor_torque_nm: of(|output| output.motor_torque_nm),
            friction_torque_nm: of(|output| output.friction_torque_nm),
            unbalance_torque_nm: of(|output| output.unbalance_torque_nm),
            stop: match output.map(|output| output.stop) {
                Some(Stop::Positive) => 1,
                Some(Stop::Negative) => -1,
                _ => 0,
            },
            velocity_error_mps: self.law.velocity_error_mps(self.axis()),
            position_error_m: self.law.position_error_m(self.axis()),
            faults: output.map_or(Faults::NONE, |output| output.faults),
        }
    }

    fn totals(&self) -> Totals {
        let units = self.law.units();
        Totals {
            samples: self.samples,
            peak_gimbal_angle_rad: self.peak_gimbal_angle.to_f64(units.gimbal_angle),
            peak_gyro_angle_rad: self.peak_gyro_angle.to_f64(units.gyro_angle),
            time_on_stop_s: self.periods_on_stop * self.period_s,
            residual_offset_rad: self.law.residual_offset_rad(self.axis()),
            faults: self.faults,
            digest: self.digest.value(),
        }
    }
}

/// Raises a peak to the size of a value.
fn raise<N: Number>(peak: &mut N, value: N) {
    let size = if value < N::ZERO { -value } else { value };
    if size > *peak {
        *peak = size;
    }
}
