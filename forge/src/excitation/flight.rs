//! In flight and under a wing.

use core::f64::consts::PI;

use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;

use super::{PERIOD_S, shape, track_of};
use crate::draw::Draw;
use crate::track::{Row, Track};

/// Thrust across the gimbal axis, roll reversals about it, broad vibration.
pub(super) fn boost(rows: usize, draw: &mut Draw) -> Track {
    let peak = STANDARD_GRAVITY_MPS2 * draw.log_uniform(3.0, 14.0);
    let length_s = rows as f64 * PERIOD_S;
    let (from_s, to_s) = (draw.uniform(0.03, 0.15) * length_s, draw.uniform(0.5, 0.9) * length_s);
    let angle = draw.uniform(0.0, 2.0 * PI);
    let axial = draw.uniform(-0.25, 0.25);
    let size = draw.log_uniform(0.1, 1.5);
    let mut roll = shape::reversals(rows, (1.0, 3.0), |draw| size * draw.log_uniform(0.15, 1.0), draw);
    shape::lagged(&mut roll, draw.uniform(0.03, 0.15));
    let flutter = shape::band(rows, draw.uniform(2.0, 6.0), 1.5, draw);
    let cross = shape::slow(rows, 0.6, draw);
    let wander: [Vec<f64>; 3] = core::array::from_fn(|_| shape::slow(rows, 0.4, draw));
    let shake: [Vec<f64>; 3] = core::array::from_fn(|_| shape::band(rows, draw.uniform(30.0, 160.0), 50.0, draw));
    let vibration = STANDARD_GRAVITY_MPS2 * draw.log_uniform(0.05, 0.6);
    track_of(rows, |index| {
        let time_s = index as f64 * PERIOD_S;
        let rise = ((time_s - from_s) / 0.25).clamp(0.0, 1.0);
        let fall = ((to_s - time_s) / 0.4).clamp(0.0, 1.0);
        let burn = rise * fall;
        let thrust = STANDARD_GRAVITY_MPS2 + (peak - STANDARD_GRAVITY_MPS2) * burn * (0.8 + 0.2 * time_s / length_s);
        let along = [libm::cos(angle), libm::sin(angle), axial];
        let noise = vibration * (0.1 + 0.9 * burn);
        Row {
            accel_mps2: core::array::from_fn(|axis| {
                thrust * along[axis] + 0.06 * peak * wander[axis][index] + noise * shake[axis][index]
            }),
            rate_radps: roll[index] + 0.02 * size * flutter[index],
            cross_rate_radps: 0.08 * cross[index],
            ..Row::default()
        }
    })
}

/// Random accelerations and rates below some hertz.
pub(super) fn manoeuvre(rows: usize, draw: &mut Draw) -> Track {
    let sizes: [f64; 3] = core::array::from_fn(|_| STANDARD_GRAVITY_MPS2 * draw.log_uniform(0.5, 3.5));
    let accel: [Vec<f64>; 3] = core::array::from_fn(|_| shape::slow(rows, draw.uniform(0.2, 1.5), draw));
    let shake: [Vec<f64>; 3] = core::array::from_fn(|_| shape::band(rows, draw.uniform(15.0, 120.0), 30.0, draw));
    let vibration = STANDARD_GRAVITY_MPS2 * draw.log_uniform(0.02, 0.3);
    let (slow, quick) =
        (shape::slow(rows, draw.uniform(0.15, 0.6), draw), shape::slow(rows, draw.uniform(1.5, 6.0), draw));
    let cross = shape::slow(rows, draw.uniform(0.3, 1.5), draw);
    let (size, cross_size) = (draw.log_uniform(0.08, 0.6), draw.log_uniform(0.05, 0.3));
    let up = draw.uniform(0.0, 2.0 * PI);
    track_of(rows, |index| {
        let still = [STANDARD_GRAVITY_MPS2 * libm::cos(up), STANDARD_GRAVITY_MPS2 * libm::sin(up), 0.0];
        Row {
            accel_mps2: core::array::from_fn(|axis| {
                still[axis] + sizes[axis] * accel[axis][index] + vibration * shake[axis][index]
            }),
            rate_radps: size * (slow[index] + 0.25 * quick[index]),
            cross_rate_radps: cross_size * cross[index],
            ..Row::default()
        }
    })
}

/// Sway with broad vibration.
pub(super) fn captive_carry(rows: usize, draw: &mut Draw) -> Track {
    let sway = shape::band(rows, draw.uniform(0.15, 0.5), 0.15, draw);
    let size = draw.log_uniform(0.02, 0.2);
    let cross = shape::band(rows, draw.uniform(0.15, 0.6), 0.2, draw);
    let bands: Vec<(f64, f64)> = (0..3).map(|_| (draw.log_uniform(10.0, 180.0), draw.uniform(4.0, 30.0))).collect();
    let mut shake: [Vec<f64>; 3] = core::array::from_fn(|_| vec![0.0; rows]);
    for axis in &mut shake {
        for (frequency_hz, width_hz) in &bands {
            let weight = draw.uniform(0.2, 1.0);
            for (sum, value) in axis.iter_mut().zip(shape::band(rows, *frequency_hz, *width_hz, draw)) {
                *sum += weight * value;
            }
        }
    }
    let vibration = STANDARD_GRAVITY_MPS2 * draw.log_uniform(0.1, 1.0);
    let jitter = shape::band(rows, draw.uniform(6.0, 30.0), 4.0, draw);
    let jitter_size = draw.log_uniform(5e-4, 8e-3);
    let turn = shape::slow(rows, 0.2, draw);
    let up = draw.uniform(0.0, 2.0 * PI);
    track_of(rows, |index| {
        let load = STANDARD_GRAVITY_MPS2 * (1.0 + 0.25 * turn[index]);
        let along = [load * libm::cos(up), load * libm::sin(up), 0.1 * load];
        Row {
            accel_mps2: core::array::from_fn(|axis| along[axis] + vibration * shake[axis][index]),
            rate_radps: size * sway[index] + jitter_size * jitter[index],
            cross_rate_radps: 0.5 * size * cross[index],
            ..Row::default()
        }
    })
}

/// One tone: acceleration, angle and rate are one signal.
pub(super) fn sway(rows: usize, draw: &mut Draw) -> Track {
    let (tone_hz, size) = (draw.uniform(0.15, 0.8), draw.log_uniform(0.01, 0.15));
    let up = draw.uniform(0.0, 2.0 * PI);
    let arm = draw.uniform(0.5, 4.0);
    let still = shape::band(rows, draw.uniform(20.0, 60.0), 10.0, draw);
    track_of(rows, |index| {
        let phase = 2.0 * PI * tone_hz * index as f64 * PERIOD_S;
        let angle = up + size / (2.0 * PI * tone_hz) * libm::sin(phase);
        let side = arm * size * libm::sin(phase);
        Row {
            accel_mps2: [
                STANDARD_GRAVITY_MPS2 * libm::cos(angle) + 0.05 * still[index],
                STANDARD_GRAVITY_MPS2 * libm::sin(angle) + side,
                0.02 * still[index],
            ],
            rate_radps: size * libm::cos(phase),
            cross_rate_radps: 0.2 * size * libm::sin(phase),
            ..Row::default()
        }
    })
}
