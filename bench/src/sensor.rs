//! What the sensors make of the truth: noise, quantisation, and faults for some time.

use gimbal_plant::Sample;
use gimbal_wire::Sensor;

use crate::random::Random;
use crate::scenario::{Noise, SensorFault, SensorFaultKind, Signal};

/// The six signals of a sensor frame; `None`: no reading.
type Readings = [Option<f64>; 6];

/// Sensors with their noise and faults.
#[derive(Debug, Clone)]
pub(crate) struct Sensors {
    noise: Noise,
    faults: Vec<(SensorFault, Option<f64>)>,
    random: Random,
    tick: u32,
}

impl Sensors {
    pub(crate) fn new(noise: Noise, faults: &[SensorFault], seed: u64) -> Self {
        let faults = faults.iter().map(|fault| (fault.clone(), None)).collect();
        Self { noise, faults, random: Random::new(seed, 0), tick: 0 }
    }

    /// Reads a sample.
    pub(crate) fn read(&mut self, time_s: f64, sample: &Sample) -> Sensor {
        let (noise, random, logged) = (self.noise, &mut self.random, &sample.logged);
        let inputs = &logged.inputs;
        let mut noisy = |value: f64, rms: f64| value + rms * random.normal();
        let theta = noisy(logged.gyro_angle_rad, noise.gyro_angle_rad);
        let step = noise.gyro_step_rad;
        let theta = if step > 0.0 { (theta / step).round() * step } else { theta };
        let mut readings: Readings = [
            Some(noisy(inputs.accel_x_mps2, noise.accel_mps2)),
            Some(noisy(inputs.accel_y_mps2, noise.accel_mps2)),
            Some(noisy(inputs.accel_z_mps2, noise.accel_mps2)),
            Some(noisy(inputs.vehicle_rate_radps, noise.rate_radps)),
            Some(theta),
            Some(noisy(logged.motor_torque_nm, noise.motor_torque_nm)),
        ];
        for (fault, held) in &mut self.faults {
            let place = &mut readings[index(fault.signal)];
            if (fault.from_s..fault.to_s).contains(&time_s) {
                *place = failed(fault, *place, *held, self.tick);
            } else {
                *held = *place;
            }
        }
        self.tick = self.tick.wrapping_add(1);
        frame(readings)
    }
}

fn index(signal: Signal) -> usize {
    match signal {
        Signal::AccelXMps2 => 0,
        Signal::AccelYMps2 => 1,
        Signal::AccelZMps2 => 2,
        Signal::VehicleRateRadps => 3,
        Signal::GyroAngleRad => 4,
        Signal::MotorTorqueNm => 5,
    }
}

fn failed(fault: &SensorFault, reading: Option<f64>, held: Option<f64>, tick: u32) -> Option<f64> {
    match fault.kind {
        SensorFaultKind::Stuck => held,
        SensorFaultKind::Missing => None,
        SensorFaultKind::NotANumber => Some(f64::NAN),
        SensorFaultKind::Bias => reading.map(|value| value + fault.value),
        SensorFaultKind::Spikes if tick.is_multiple_of(100) => reading.map(|value| value + fault.value),
        SensorFaultKind::Spikes => reading,
        SensorFaultKind::Limited => reading.map(|value| value.clamp(-fault.value.abs(), fault.value.abs())),
    }
}

#[allow(clippy::cast_possible_truncation, reason = "what goes over the wire is f32")]
fn frame([x, y, z, rate, theta, torque]: Readings) -> Sensor {
    let always = |value: Option<f64>| value.unwrap_or(f64::NAN) as f32;
    Sensor {
        accel_mps2: [x, y, z].map(always),
        vehicle_rate_radps: always(rate),
        gyro_angle_rad: theta.map(|value| value as f32),
        motor_torque_nm: torque.map(|value| value as f32),
    }
}
