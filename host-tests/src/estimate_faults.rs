//! Sensor faults thrown at the estimator: the run with the fault against the same run without it.

use gimbal_servo::Config;
use gimbal_servo::estimator::{self, Flags};

use crate::axis::System;
use crate::estimate::{Estimated, Flight, Noise, Reading, estimate};
use crate::inputs;
use crate::random::Random;

/// What goes wrong.
const KINDS: [&str; 5] = ["stale", "stuck", "spike", "not finite", "out of range"];
/// Where.
const CHANNELS: [&str; 6] = ["theta", "motor torque", "a_x", "a_y", "a_z", "rate"];
/// Sizes of spikes, and values out of range.
const SPIKES: [f64; 6] = [5e-3, 0.02, 50.0, 50.0, 50.0, 1.0];
const BEYOND: [f64; 6] = [0.02, 2.0, 600.0, 600.0, 300.0, 60.0];
/// Rows after a fault in which its flag may still stand for it.
const AFTER: usize = 150;

/// Runs with one fault each.
#[derive(Debug, Clone, Default)]
pub struct Found {
    /// Runs.
    pub runs: usize,
    /// Runs in which the fault moved phi by more than twice the bound before any flag, or after the flags had gone.
    pub unflagged: usize,
    /// The largest such move over the bound.
    pub worst: f64,
    /// What they were.
    pub which: Vec<String>,
}

fn flights(random: &mut Random, config: &estimator::Config) -> Vec<(Flight, Estimated)> {
    let nominal = Config::consistent();
    let fly = |seed: u64| {
        let rows = if seed.is_multiple_of(2) {
            inputs::manoeuvre(4.0, 1e-3, seed).split_off(1000)
        } else {
            let sign = if seed % 4 == 1 { 1.0 } else { -1.0 };
            let mut rows = inputs::torque_step(sign * random.between(2.2e5, 3.2e5), 1.5, 1e-3);
            for (k, row) in rows.iter_mut().enumerate() {
                let share = ((k as f64 - 300.0) / 10.0).clamp(0.0, 1.0);
                row.torque_nm *= if k > 900 { 0.2 * share } else { share };
                (row.accel_y_mps2, row.accel_z_mps2, row.vehicle_rate_radps) = (1.0, 9.8, 0.05);
            }
            rows
        };
        let flight = Flight::new(&nominal, &config.sensors, &Noise::default(), &rows, seed);
        let estimated = estimate(System::F32, &nominal, config, &flight.readings);
        (flight, estimated)
    };
    (0..10).map(fly).collect()
}

/// When a run says that it is on a stop [ms].
fn spans(estimated: &Estimated) -> String {
    let on_stop = |k: usize| estimated.points.get(k).is_some_and(|point| point.flags.contains(Flags::SATURATED));
    let edges: Vec<String> =
        (1..estimated.points.len()).filter(|k| on_stop(*k) != on_stop(k - 1)).map(|k| k.to_string()).collect();
    if edges.is_empty() { "never".into() } else { edges.join("-") + " ms" }
}

fn values(reading: &Reading) -> [f64; 6] {
    let row = &reading.inputs;
    let read = |value: Option<f64>| value.unwrap_or(f64::NAN);
    [
        read(reading.gyro_angle_rad),
        read(reading.motor_torque_nm),
        row.accel_x_mps2,
        row.accel_y_mps2,
        row.accel_z_mps2,
        row.vehicle_rate_radps,
    ]
}

fn set(reading: &mut Reading, channel: usize, value: Option<f64>) {
    let number = value.unwrap_or(f64::NAN);
    match channel {
        0 => reading.gyro_angle_rad = value,
        1 => reading.motor_torque_nm = value,
        2 => reading.inputs.accel_x_mps2 = number,
        3 => reading.inputs.accel_y_mps2 = number,
        4 => reading.inputs.accel_z_mps2 = number,
        _ => reading.inputs.vehicle_rate_radps = number,
    }
}

/// `runs` faults of every kind in every input at random times of ten flights, five of which saturate.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows and indices")]
pub fn faults(runs: usize, seed: u64) -> Found {
    let (nominal, config) = (Config::consistent(), estimator::Config::default());
    let mut random = Random::new(seed);
    let bank = flights(&mut random, &config);
    let mut found = Found { runs, ..Found::default() };
    for _ in 0..runs {
        let (flight, without) = &bank[(random.bits() % 10) as usize];
        let (kind, channel) = ((random.bits() % 5) as usize, (random.bits() % 6) as usize);
        let count = flight.readings.len();
        let start = random.between(100.0, count as f64 - 250.0) as usize;
        let rows = if kind == 2 { 1 } else { random.between(2.0, 120.0) as usize };
        let sign = if random.between(-1.0, 1.0) < 0.0 { -1.0 } else { 1.0 };
        let size = sign * random.log_between(0.01, 10.0);
        let mut readings = flight.readings[..(start + rows + 200).min(count)].to_vec();
        let last = values(&readings[start - 1])[channel];
        for reading in &mut readings[start..start + rows] {
            let value = values(reading)[channel];
            let value = match kind {
                0 if channel < 2 => None,
                0 | 1 => Some(last),
                2 => Some(value + size * SPIKES[channel]),
                3 => Some(f64::NAN),
                _ => Some(sign * BEYOND[channel]),
            };
            set(reading, channel, value);
        }
        let with = estimate(System::F32, &nominal, &config, &readings);
        let (mut flagged, mut worst, mut place) = (false, 0.0_f64, start);
        for (k, (point, right)) in with.points.iter().zip(&without.points).enumerate().skip(start) {
            flagged |= point.flags.intersects(Flags::SENSORS);
            let later = k > start + rows + AFTER;
            let excused = point.flags.intersects(Flags::OFFSET_DOUBTFUL | Flags::SETTLING);
            if (!flagged || later) && !excused {
                let bounds = (point.angle_rad - right.angle_rad).abs() / point.bound_rad;
                if bounds > worst {
                    (worst, place) = (bounds, k);
                }
            }
        }
        if worst > 2.0 {
            found.unflagged += 1;
            let (point, right) = (&with.points[place], &without.points[place]);
            found.which.push(format!(
                "{} {} by {:+.2} of {} for {rows} rows from {} ms: {worst:.1} bounds at {place} ms, phi off by {:.0} of {:.0} urad, bound {:.0}; \
                 on a stop {}",
                CHANNELS[channel],
                KINDS[kind],
                size,
                SPIKES[channel],
                start,
                1e6 * (point.angle_rad - right.angle_rad),
                1e6 * right.angle_rad,
                1e6 * point.bound_rad,
                spans(without)
            ));
        }
        found.worst = found.worst.max(worst);
    }
    found
}
