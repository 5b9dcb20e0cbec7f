//! The reference plant, fed as the flight law is.

use gimbal_model_file::ModelEffect;
use gimbal_plant::{EffectError, Plant, Row, State, Stop, StopEvent, StopEventKind};
use gimbal_servo::{BuildError, Config, Digest, Faults};

use super::model::{Drive, Initial, Model, Sample, Totals};

/// phi beyond which the linear equations no longer hold [rad].
const SMALL_ANGLE_RAD: f64 = 0.1;

/// The plant and what has added up.
pub(crate) struct Reference {
    config: Config,
    plant: Plant,
    state: State,
    initial: Initial,
    row: Option<Row>,
    sample: Option<gimbal_plant::Sample>,
    totals: Totals,
    digest: Digest,
}

impl Reference {
    /// The nominal plant before the first row.
    pub(crate) fn new(config: &Config, initial: Initial) -> Result<Self, BuildError> {
        Ok(Self::of(config, Plant::new(config)?, initial))
    }

    /// Before the first row.
    pub(crate) fn with_effects(
        config: &Config,
        effects: &[ModelEffect],
        initial: Initial,
    ) -> Result<Self, EffectError> {
        let mut plant = Plant::new(config)?;
        for entry in effects {
            plant = plant.with_effect(entry.effect, &entry.values)?;
        }
        Ok(Self::of(config, plant, initial))
    }

    fn of(config: &Config, plant: Plant, initial: Initial) -> Self {
        let totals = Totals {
            samples: 0,
            peak_gimbal_angle_rad: 0.0,
            peak_gyro_angle_rad: 0.0,
            time_on_stop_s: 0.0,
            residual_offset_rad: 0.0,
            faults: Faults::NONE,
            digest: 0,
        };
        let state = plant.start();
        let digest = Digest::default();
        Self { config: *config, state, initial, plant, row: None, sample: None, totals, digest }
    }

    /// phi less what the gyro has seen of it, which is the integral of (2): `(Jo theta' + Bo theta) / H`.
    fn unseen_rad(&self, sample: &gimbal_plant::Sample) -> f64 {
        let gyro = &self.config.gyro;
        let seen =
            gyro.float_inertia_kg_m2 * sample.gyro_rate_radps + gyro.damping_nm_s_per_rad * sample.gyro_angle_rad;
        sample.gimbal_angle_rad - seen / gyro.angular_momentum_nm_s
    }
}

impl Model for Reference {
    fn step(&mut self, &Drive { input, cross_rate_radps }: &Drive) {
        let row = Row {
            accel_x_mps2: input.accel_x_mps2,
            accel_y_mps2: input.accel_y_mps2,
            accel_z_mps2: input.accel_z_mps2,
            vehicle_rate_radps: input.vehicle_rate_radps,
            cross_rate_radps,
            spin_rate_radps: input.spin_rate_radps,
            torque_nm: input.torque_nm,
        };
        let sample = if let Some(previous) = &self.row {
            self.plant.step(&mut self.state, previous, &row)
        } else {
            if self.initial == Initial::Settled {
                self.state = self.plant.settled(&row);
            }
            self.plant.sample(&self.state, &row)
        };
        self.row = Some(row);
        let totals = &mut self.totals;
        totals.samples += 1;
        totals.peak_gimbal_angle_rad = totals.peak_gimbal_angle_rad.max(sample.gimbal_angle_rad.abs());
        totals.peak_gyro_angle_rad = totals.peak_gyro_angle_rad.max(sample.gyro_angle_rad.abs());
        totals.faults |= faults(&sample);
        for value in [
            sample.gimbal_angle_rad,
            sample.gyro_angle_rad,
            sample.motor_torque_nm,
            sample.friction_torque_nm,
            sample.unbalance_torque_nm,
        ] {
            self.digest.add(&value.to_bits().to_le_bytes());
        }
        self.sample = Some(sample);
    }

    fn sample(&self) -> Sample {
        let of = |signal: fn(&gimbal_plant::Sample) -> f64| self.sample.as_ref().map_or(0.0, signal);
        Sample {
            gimbal_angle_rad: of(|sample| sample.gimbal_angle_rad),
            gyro_angle_rad: of(|sample| sample.logged.gyro_angle_rad),
            motor_torque_nm: of(|sample| sample.logged.motor_torque_nm),
            friction_torque_nm: of(|sample| sample.friction_torque_nm),
            unbalance_torque_nm: of(|sample| sample.unbalance_torque_nm),
            stop: match self.sample.map(|sample| sample.stop) {
                Some(Stop::Positive) => 1,
                Some(Stop::Negative) => -1,
                _ => 0,
            },
            velocity_error_mps: self.sample.map_or([0.0; 2], |sample| sample.velocity_error_mps),
            position_error_m: self.sample.map_or([0.0; 2], |sample| sample.position_error_m),
            faults: self.sample.as_ref().map_or(Faults::NONE, faults),
        }
    }

    fn totals(&self) -> Totals {
        let mut totals = self.totals.clone();
        if let Some(sample) = &self.sample {
            totals.residual_offset_rad = self.unseen_rad(sample);
            totals.time_on_stop_s = time_on_stop_s(self.state.events(), sample.time_s);
        }
        totals.digest = self.digest.value();
        totals
    }
}

/// From each contact to its release, or to the end.
fn time_on_stop_s(events: &[StopEvent], end_s: f64) -> f64 {
    let (mut sum_s, mut contact_s) = (0.0, None);
    for event in events {
        match event.kind {
            StopEventKind::Contact => contact_s = Some(event.time_s),
            StopEventKind::Release => sum_s += contact_s.take().map_or(0.0, |contact_s| event.time_s - contact_s),
        }
    }
    sum_s + contact_s.map_or(0.0, |contact_s| end_s - contact_s)
}

fn faults(sample: &gimbal_plant::Sample) -> Faults {
    let mut faults = Faults::NONE;
    if sample.stop != Stop::Free {
        faults |= Faults::GYRO_SATURATED;
    }
    if sample.gimbal_angle_rad.abs() > SMALL_ANGLE_RAD {
        faults |= Faults::SMALL_ANGLE_EXCEEDED;
    }
    faults
}
