//! What is written down of a run: channels with their noise and least counts, columns, and the gaps that they show.

use super::SignalGap;
use super::bench::STEPS;
use super::drift::Drift;
use super::setting::Setting;
use super::text::Column;
use crate::detect::UNSCORED_S;
use crate::draw::Draw;
use crate::effects::World;
use crate::excitation::PERIOD_S;
use crate::machine::Sample;
use crate::scene::{CHANNELS, Outputs, Scene};
use crate::sensors::{pickoff_rounded, rounded, torque_rounded};
use crate::track::Track;

/// The logged channels: outputs with noise and least counts; `pickoff_rad` is what the pick-off's has beside the samples.
pub(super) fn measured(
    setting: &Setting,
    world: &World,
    samples: &[Sample],
    pickoff_rad: Vec<f64>,
    draw: &mut Draw,
) -> Outputs {
    let rows = samples.len();
    let mut series = |white: f64| setting.noise.series(white, rows, PERIOD_S, draw);
    let noise = [pickoff_rad, series(setting.noise.motor_torque_nm), series(setting.noise.gimbal_angle_rad)];
    let mut outputs = Scene::outputs(world, samples);
    for (channel, noise) in outputs.iter_mut().zip(&noise) {
        for (value, noise) in channel.iter_mut().zip(noise) {
            *value += noise;
        }
    }
    let [gyro, torque, gimbal] = &mut outputs;
    for value in gyro {
        *value = pickoff_rounded(&world.sensors, *value);
    }
    for value in torque {
        *value = torque_rounded(*value);
    }
    for value in gimbal {
        *value = rounded(*value, 1e-7);
    }
    outputs
}

/// The columns of the log's file.
pub(super) fn columns(
    setting: &Setting,
    world: &World,
    logged: &Track,
    outputs: Outputs,
    samples: &[Sample],
    draw: &mut Draw,
) -> Vec<Column> {
    let rows = &logged.rows[setting.scene.before..];
    let [gyro, torque, gimbal] = outputs;
    let time = (0..rows.len()).map(|index| setting.start_s + index as f64 * PERIOD_S).collect();
    let of = |value: &dyn Fn(&crate::track::Row) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    let gyro_digits = if world.sensors.pickoff_step_rad.is_some() { 10 } else { 8 };
    let relative =
        samples.iter().map(|s| s.relative_angle_rad + setting.noise.relative_angle_rad * draw.normal()).collect();
    let all = [
        (true, "time_s", 3, time),
        (true, "accel_x_mps2", 4, of(&|row| row.accel_mps2[0])),
        (true, "accel_y_mps2", 4, of(&|row| row.accel_mps2[1])),
        (true, "accel_z_mps2", 4, of(&|row| row.accel_mps2[2])),
        (true, "vehicle_rate_radps", 6, of(&|row| row.rate_radps)),
        (true, "gyro_angle_rad", gyro_digits, gyro),
        (setting.columns.torque, "motor_torque_nm", 7, torque),
        (setting.columns.gimbal, "gimbal_angle_rad", 7, gimbal),
        (setting.columns.relative, "relative_angle_rad", 6, relative),
        (setting.columns.cross, "cross_rate_radps", 6, of(&|row| row.cross_rate_radps)),
        (setting.columns.temperature, "temperature_c", 4, of(&|row| row.temperature_c)),
    ];
    all.into_iter()
        .filter(|(there, ..)| *there)
        .map(|(_, name, digits, values)| Column { name, digits, values })
        .collect()
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a thousand rows
fn rms(a: &[f64], b: &[f64]) -> f64 {
    let skip = (UNSCORED_S / PERIOD_S) as usize;
    let pairs = a.iter().zip(b).skip(skip);
    let count = a.len().saturating_sub(skip).max(1);
    (pairs.map(|(x, y)| (x - y) * (x - y)).sum::<f64>() / count as f64).sqrt()
}

/// Residuals of the nominal and of the true model, both driven by logged inputs.
pub(super) fn signals(
    setting: &Setting,
    world: &World,
    logged: &Track,
    outputs: &Outputs,
    draw: &mut Draw,
) -> Vec<SignalGap> {
    let nominal =
        Drift { relative: std::collections::BTreeMap::new(), misalignment_rad: [0.0; 3] }.world(&setting.nominal);
    let scene = &setting.scene;
    let before = Scene::outputs(&nominal, &scene.run(&nominal.truth, logged, STEPS));
    // the true model knows skew and turns, and has the noise of the logged inputs
    let own = setting.noise.on_inputs(&scene.track, draw);
    let best = Scene::outputs(world, &scene.run(&world.truth, &own, STEPS));
    setting
        .columns
        .channels()
        .into_iter()
        .map(|channel| SignalGap {
            name: CHANNELS[channel].to_owned(),
            before: rms(&before[channel], &outputs[channel]),
            best: rms(&best[channel], &outputs[channel]),
        })
        .collect()
}
