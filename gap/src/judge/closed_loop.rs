//! How far the gap shrinks, by two more yardsticks beside the predictions that were fitted: the reference plant running
//! free, closed loop, under the logged inputs; and one step ahead from the samples before.
//!
//! ```text
//! free running   rms of the log less the plant with the nominal and with the corrected model, from the third second on
//! one step       rms of e(k) = r(k) - sum a_i r(k - i), i = 1..8, a_i of the residual r of the corrected model
//! ```
//!
//! The plant shares no code with the predictions. It begins settled under the first row; what it needs to come into step
//! with a log that begins in the middle of a run is why the first seconds do not count.

use gimbal_model_file::{ModelEffect, ModelFile};
use gimbal_plant::{Effect, EffectError, Plant, Row};
use gimbal_servo::Config;

use super::Decision;
use crate::close::closing;
use crate::fit::Fit;
use crate::record::{Channel, Record, Signal};
use crate::simulate::{Inputs, Physics, turned};

/// Not scored, at the beginning and after a stop [s].
const COMES_IN_S: f64 = 3.0;
/// Local error of the plant's steps: far below the sensors' noise.
const TOLERANCE: f64 = 1e-6;
/// Samples that a step ahead is told from.
const ORDER: usize = 8;

/// Rms of one signal under both models.
#[derive(Debug, Clone, PartialEq)]
pub struct Yardstick {
    /// Column of the log.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Under the model as it was.
    pub before: f64,
    /// Under the corrected one.
    pub after: f64,
}

impl Yardstick {
    /// One for each channel of a log, from its rms before and after.
    pub(crate) fn of_channels(record: &Record, before: &[f64], after: &[f64]) -> Vec<Self> {
        let one = |((channel, &before), &after): ((&Channel, &f64), &f64)| {
            let column = channel.signal.column();
            Self { name: column.name(), unit: column.unit(), before, after }
        };
        record.channels.iter().zip(before).zip(after).map(one).collect()
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        serde_json::json!({ "name": self.name, "unit": self.unit, "before": self.before, "after": self.after })
    }
}

/// The reference plant under the logged inputs, before and after; none where it cannot be built, or a channel has nothing
/// that counts once it has come into step.
#[must_use]
pub fn free_running(record: &Record, model: &ModelFile, decision: &Decision, fit: &Fit) -> Vec<Yardstick> {
    if !record.channels.iter().all(|channel| counted(record, channel).next().is_some()) {
        return Vec::new();
    }
    let (config, mut effects) = closing(decision, fit, model);
    // scales within their tolerances were fitted too, and so was the accelerometers' alignment
    let sensors = &fit.physics.measurement;
    for (name, factor) in [("pickoff_scale", sensors.pickoff_factor), ("torque_scale", sensors.torque_factor)] {
        let Some(effect) = Effect::from_name(name) else { continue };
        effects.retain(|entry| entry.effect != effect);
        effects.push(ModelEffect { effect, values: vec![factor - 1.0] });
    }
    let nominal = crate::library::platform(model);
    let (before, after) = rayon::join(
        || run(record, &model.config, &model.effects, &nominal),
        || run(record, &config, &effects, &fit.physics),
    );
    let (Ok(before), Ok(after)) = (before, after) else { return Vec::new() };
    let off = |run: &[Vec<f64>; 3]| -> Vec<f64> {
        let of = |channel: &Channel| {
            channel.values.iter().zip(&run[index(channel.signal)]).map(|(log, plant)| log - plant).collect()
        };
        in_step(record, &record.channels.iter().map(of).collect::<Vec<_>>())
    };
    Yardstick::of_channels(record, &off(&before), &off(&after))
}

/// Rms of residuals from where a run has come into step, channel by channel; the angle has no zero of its own.
pub(crate) fn in_step(record: &Record, residuals: &[Vec<f64>]) -> Vec<f64> {
    let of = |(residual, channel): (&Vec<f64>, &Channel)| {
        let off: Vec<f64> = counted(record, channel).map(|k| residual[k]).collect();
        let level = if channel.signal == Signal::GimbalAngle { mean(&off) } else { 0.0 };
        mean(&off.iter().map(|value| (value - level).powi(2)).collect::<Vec<_>>()).sqrt()
    };
    residuals.iter().zip(&record.channels).map(of).collect()
}

/// Rows of a channel that count once a run has come into step, at the beginning and after a stop.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
fn counted<'a>(record: &'a Record, channel: &'a Channel) -> impl Iterator<Item = usize> + 'a {
    let rows = (COMES_IN_S / record.inputs.period_s).ceil() as usize;
    let comes_in =
        move |k: usize| k < rows || record.anew().iter().any(|free| free.contains(&k) && k < free.start + rows);
    (0..record.rows()).filter(move |&k| channel.valid[k] && !comes_in(k))
}

fn index(signal: Signal) -> usize {
    match signal {
        Signal::GyroAngle => 0,
        Signal::MotorTorque => 1,
        Signal::GimbalAngle => 2,
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// theta, `T_m` as logged, and phi.
fn run(
    record: &Record,
    config: &Config,
    effects: &[ModelEffect],
    physics: &Physics,
) -> Result<[Vec<f64>; 3], EffectError> {
    let mut config = *config;
    config.period_s = record.inputs.period_s;
    let mut plant = Plant::new(&config)?.with_tolerance(TOLERANCE);
    // the plant is driven by what was, not by what was logged late
    for entry in effects.iter().filter(|entry| entry.effect.name() != "time_skew") {
        plant = plant.with_effect(entry.effect, &entry.values)?;
    }
    let advanced;
    let mut inputs: &Inputs = &record.inputs;
    if physics.measurement.skew_s != 0.0 {
        advanced = inputs.advanced(physics.measurement.skew_s);
        inputs = &advanced;
    }
    let rows: Vec<Row> = (0..inputs.len())
        .map(|k| {
            let logged = [0, 1, 2].map(|axis| inputs.accel_mps2[axis][k]);
            let [accel_x_mps2, accel_y_mps2, accel_z_mps2] = turned(logged, physics.turned_rad);
            Row {
                accel_x_mps2,
                accel_y_mps2,
                accel_z_mps2,
                vehicle_rate_radps: inputs.rate_radps[k],
                cross_rate_radps: inputs.cross_radps.get(k).copied().unwrap_or(0.0),
                ..Row::default()
            }
        })
        .collect();
    let mut out: [Vec<f64>; 3] = Default::default();
    let Some(first) = rows.first() else { return Ok(out) };
    for sample in plant.run_from(plant.settled(first), rows.iter().copied()) {
        out[0].push(sample.logged.gyro_angle_rad);
        out[1].push(sample.logged.motor_torque_nm);
        out[2].push(sample.gimbal_angle_rad);
    }
    Ok(out)
}

/// One step ahead, channel by channel.
#[must_use]
pub fn one_step(record: &Record, before: &[Vec<f64>], after: &[Vec<f64>]) -> Vec<Yardstick> {
    let of_channels: Vec<_> =
        record.channels.iter().zip(after).map(|(channel, after)| weights(after, &channel.valid)).collect();
    let score = |place: usize, residual: &[f64]| {
        let (valid, weights) = (&record.channels[place].valid, &of_channels[place]);
        let steps = (ORDER..residual.len()).filter(|&k| valid[k - ORDER..=k].iter().all(|own| *own));
        let off: Vec<f64> = steps
            .map(|k| {
                let told: f64 = weights.iter().enumerate().map(|(i, a)| a * residual[k - 1 - i]).sum();
                (residual[k] - told).powi(2)
            })
            .collect();
        mean(&off).sqrt()
    };
    let [before, after] = [before, after]
        .map(|residuals| residuals.iter().enumerate().map(|(place, own)| score(place, own)).collect::<Vec<_>>());
    Yardstick::of_channels(record, &before, &after)
}

/// Of the samples before, by Levinson's recursion on the residual's autocorrelation.
fn weights(residual: &[f64], valid: &[bool]) -> [f64; ORDER] {
    let lag = |lag: usize| -> f64 {
        (lag..residual.len()).filter(|&k| valid[k] && valid[k - lag]).map(|k| residual[k] * residual[k - lag]).sum()
    };
    let correlation: Vec<f64> = (0..=ORDER).map(lag).collect();
    let mut weights = [0.0; ORDER];
    let mut power = correlation[0].max(1e-300) * (1.0 + 1e-9);
    for order in 0..ORDER {
        let told: f64 = (0..order).map(|i| weights[i] * correlation[order - i]).sum();
        let reflection = (correlation[order + 1] - told) / power;
        let last = weights;
        weights[order] = reflection;
        for i in 0..order {
            weights[i] = last[i] - reflection * last[order - 1 - i];
        }
        power *= (1.0 - reflection * reflection).max(1e-12);
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::weights;

    #[test]
    fn closed_form_a_first_order_process_is_told_from_its_last_sample() {
        let (mut x, mut seed) = (0.0, 1_u64);
        let values: Vec<f64> = (0..40_000)
            .map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                x = 0.9 * x + ((seed >> 33) as f64 / f64::from(1_u32 << 31) - 0.5);
                x
            })
            .collect();
        let weights = weights(&values, &vec![true; values.len()]);
        // The error of an estimate from n samples is sqrt((1 - a^2) / n), 2e-3.
        assert!((weights[0] - 0.9).abs() < 0.02, "{weights:?}");
        assert!(weights[1..].iter().all(|weight| weight.abs() < 0.03), "{weights:?}");
    }
}
