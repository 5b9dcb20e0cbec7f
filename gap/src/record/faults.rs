//! Wrong sign, wrong unit, swapped axes, channels shifted in time: a log that fits the model far better once one
//! such mistake is undone is wrong by that mistake.

use gimbal_model_file::ModelFile;

use super::{Record, Signal};
use crate::simulate::{Inputs, Physics, predict};

/// A mistake is told when undoing it leaves less than this share of the misfit.
const MENDED: f64 = 0.12;
/// Share of the outputs' power that must be off before inputs are suspected.
const OFF: f64 = 0.02;
/// Shifts between torque and angle below this are delays of the loop [s].
const LEAST_SHIFT_S: f64 = 2e-3;
const RAD_PER_DEG: f64 = std::f64::consts::PI / 180.0;

type Change = fn(&mut Inputs);

/// Mistakes of the inputs, and how they are undone.
const INPUTS: [(&str, Change); 9] = [
    ("vehicle_rate_radps has the wrong sign", |inputs| scale(&mut inputs.rate_radps, -1.0)),
    ("vehicle_rate_radps seems to be in deg/s", |inputs| scale(&mut inputs.rate_radps, RAD_PER_DEG)),
    ("vehicle_rate_radps seems to have been converted to rad/s twice", |inputs| {
        scale(&mut inputs.rate_radps, 1.0 / RAD_PER_DEG);
    }),
    ("accel_x_mps2 and accel_y_mps2 are swapped", |inputs| inputs.accel_mps2.swap(0, 1)),
    ("accel_x_mps2 and accel_z_mps2 are swapped", |inputs| inputs.accel_mps2.swap(0, 2)),
    ("accel_y_mps2 and accel_z_mps2 are swapped", |inputs| inputs.accel_mps2.swap(1, 2)),
    ("accel_y_mps2 has the wrong sign", |inputs| scale(&mut inputs.accel_mps2[1], -1.0)),
    ("the accelerations seem to be in g", |inputs| inputs.accel_mps2.iter_mut().for_each(|axis| scale(axis, 9.806_65))),
    ("all accelerations have the wrong sign", |inputs| inputs.accel_mps2.iter_mut().for_each(|axis| scale(axis, -1.0))),
];

fn scale(values: &mut [f64], by: f64) {
    for value in values {
        *value *= by;
    }
}

/// What is wrong with the data.
#[derive(Debug, Clone)]
pub enum Data {
    /// Nothing that shows.
    Sound,
    /// Mistakes, in words.
    Faulty(Vec<String>),
    /// A mistake that an effect may imitate, and the record with it undone.
    Doubtful(String, Box<Record>),
}

impl Data {
    fn faulty(told: Vec<String>) -> Self {
        if told.is_empty() { Self::Sound } else { Self::Faulty(told) }
    }
}

/// Mistakes in the data.
#[must_use]
pub fn faults(record: &Record, model: &ModelFile) -> Data {
    let mut physics = crate::library::platform(model);
    physics.config.gyro.stop_angle_rad *= 1.5;
    let misfit = |inputs: &Inputs| -> (f64, Vec<f64>) {
        let prediction = predict(&physics, inputs, &record.begin(&physics, inputs), usize::MAX);
        let ratios: Vec<f64> = record
            .channels
            .iter()
            .filter(|channel| channel.signal != Signal::GimbalAngle)
            .map(|channel| {
                let predicted = crate::fit::predicted(channel.signal, &prediction);
                let (mut off, mut all) = (0.0, 0.0);
                for k in (record.rows() / 10..record.rows()).filter(|&k| channel.valid[k]) {
                    off += (channel.values[k] - predicted[k]).powi(2);
                    all += channel.values[k].powi(2);
                }
                off / all.max(1e-30)
            })
            .collect();
        (ratios.iter().sum::<f64>() / ratios.len().max(1) as f64, ratios)
    };
    let (nominal, ratios) = misfit(&record.inputs);
    let (turned, mut told) = outputs(record, &physics, &ratios);
    told.extend(beyond(record, model));
    if let ([signal], true) = (&turned[..], told.is_empty()) {
        let mut undone = record.clone();
        undone.channels.iter_mut().filter(|own| own.signal == *signal).for_each(|own| scale(&mut own.values, -1.0));
        return Data::Doubtful(turned_around(*signal), Box::new(undone));
    }
    if turned.len() == ratios.len() && turned.len() > 1 {
        told.push("vehicle_rate_radps has the wrong sign, or all outputs have".to_owned());
    } else {
        told.extend(turned.into_iter().map(turned_around));
    }
    if nominal < OFF || !told.is_empty() {
        return Data::faulty(told);
    }
    let mut best = (MENDED * nominal, None);
    for (name, undo) in INPUTS {
        let mut inputs = record.inputs.clone();
        undo(&mut inputs);
        let begin_rad = inputs.turned_rad[0];
        inputs.complete(&model.config.bearing, begin_rad);
        let (mended, _) = misfit(&inputs);
        if mended < best.0 {
            best = (mended, Some((name, inputs)));
        }
    }
    let (mended, Some((name, inputs))) = best else { return Data::Sound };
    let undone = Record { inputs, ..record.clone() };
    Data::Doubtful(format!("{name}: undone, the misfit falls from {nominal:.2} to {mended:.3}"), Box::new(undone))
}

fn turned_around(signal: Signal) -> String {
    format!("{} has the wrong sign", signal.column().name())
}

/// A rate that the platform was not made for: degrees, most likely.
fn beyond(record: &Record, model: &ModelFile) -> Option<String> {
    let most = model.config.range.rate_radps;
    let peak = record.inputs.rate_radps.iter().fold(0.0, |peak: f64, rate| peak.max(rate.abs()));
    (peak > most).then(|| {
        format!(
            "vehicle_rate_radps reaches {peak:.0} rad/s, beyond the model's range of {most:.0} rad/s: it seems to be in deg/s"
        )
    })
}

/// Mistakes of single outputs: those whose sign is wrong; and in words, factors against the prediction and shifts
/// between torque and angle.
fn outputs(record: &Record, physics: &Physics, ratios: &[f64]) -> (Vec<Signal>, Vec<String>) {
    let (mut turned, mut told) = (Vec::new(), Vec::new());
    let prediction = predict(physics, &record.inputs, &record.begin(physics, &record.inputs), usize::MAX);
    for (channel, ratio) in record.channels.iter().zip(ratios) {
        if *ratio < 0.25 {
            continue;
        }
        let predicted = crate::fit::predicted(channel.signal, &prediction);
        let (mut cross, mut own, mut all) = (0.0, 0.0, 0.0);
        for k in (record.rows() / 10..record.rows()).filter(|&k| channel.valid[k]) {
            cross += channel.values[k] * predicted[k];
            own += predicted[k] * predicted[k];
            all += channel.values[k] * channel.values[k];
        }
        let factor = cross / own.max(1e-30);
        let fits = cross * cross / (own * all).max(1e-30) > 0.6;
        let name = channel.signal.column().name();
        if fits && factor < -0.5 && factor > -2.0 {
            turned.push(channel.signal);
        } else if fits && factor.abs() > 35.0 && factor.abs() < 90.0 {
            told.push(format!("{name} is {factor:.1} times what the model gives: the unit seems to be degrees"));
        } else if fits && factor.abs() < 1.0 / 35.0 && factor.abs() > 1.0 / 90.0 {
            told.push(format!(
                "{name} is {factor:.4} times what the model gives: the unit seems to have been converted twice"
            ));
        }
    }
    if turned.is_empty()
        && told.is_empty()
        && let Some(shift_s) = shift_s(record, &prediction.motor_torque_nm, &prediction.gyro_angle_rad)
    {
        told.push(format!(
            "motor_torque_nm and gyro_angle_rad are shifted in time against each other by {:.1} ms",
            1e3 * shift_s
        ));
    }
    (turned, told)
}

/// Time by which the torque is late against the angle: where it takes away most of what is off, and half of what a shift of
/// both together leaves.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_wrap,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "rows"
)]
fn shift_s(record: &Record, torque: &[f64], theta: &[f64]) -> Option<f64> {
    let period_s = record.inputs.period_s;
    let (rows, reach) = (record.rows() as i64, (0.06 / period_s) as i64);
    if rows < 4 * reach {
        return None;
    }
    let shifts = -reach + 8..=reach - 8;
    // what is off at each shift, over all there is
    let off = |signal: Signal, predicted: &[f64]| -> Option<Vec<f64>> {
        let channel = record.channel(signal)?;
        // changes, not levels
        let step = |values: &[f64], k: i64| values[k as usize] - values[(k - 8) as usize];
        let compared = || ((rows / 10).max(reach)..rows - reach).step_by(3);
        let all: f64 = compared().map(|k| step(&channel.values, k).powi(2)).sum();
        let at =
            |shift| compared().map(|k| (step(&channel.values, k) - step(predicted, k - shift)).powi(2)).sum::<f64>();
        Some(shifts.clone().map(|shift| at(shift) / all.max(1e-300)).collect())
    };
    let (torque, theta) = (off(Signal::MotorTorque, torque)?, off(Signal::GyroAngle, theta)?);
    let together: Vec<f64> = torque.iter().zip(&theta).map(|(torque, theta)| torque + theta).collect();
    let least = |off: &[f64]| off.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    let nowhere = (reach - 8) as usize;
    let ((late, torque_left), (angle_late, theta_left)) = (least(&torque)?, least(&theta)?);
    let most = torque_left < 0.2 * torque[nowhere] || theta_left < 0.2 * theta[nowhere];
    let against_each_other = torque_left + theta_left < 0.5 * least(&together)?.1;
    let shift_s = (late as f64 - angle_late as f64) * period_s;
    (most && against_each_other && shift_s.abs() >= LEAST_SHIFT_S - 1e-9).then_some(shift_s)
}
