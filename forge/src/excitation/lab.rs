//! On a rate table: the paper's own experiment, made longer.

use core::f64::consts::PI;

use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;

use super::{PERIOD_S, shape, track_of};
use crate::draw::Draw;
use crate::track::{Row, Track};

/// Square waves and triangles of rate, three tilts with turns between them.
pub(super) fn rate_table(rows: usize, draw: &mut Draw) -> Track {
    let squares = shape::reversals(rows, (0.4, 1.6), |draw| draw.log_uniform(4e-3, 0.4), draw);
    let mut rate = squares;
    shape::lagged(&mut rate, draw.uniform(0.008, 0.03));
    let triangle_hz = draw.uniform(0.1, 0.4);
    let triangle_size = draw.log_uniform(0.02, 0.3);
    let cross_hz = draw.uniform(0.2, 0.7);
    let cross_size = draw.uniform(0.03, 0.15);
    let phase = draw.uniform(0.0, 2.0 * PI);
    let tilts: Vec<[f64; 2]> = (0..3).map(|_| [draw.uniform(0.0, 2.0 * PI), draw.uniform(-0.5, 0.5)]).collect();
    track_of(rows, |index| {
        let time_s = index as f64 * PERIOD_S;
        let place = 3.0 * index as f64 / rows as f64;
        // a turn takes the last quarter of a third
        let whole = libm::floor(place);
        let part = ((place - whole - 0.75) * 4.0).clamp(0.0, 1.0);
        let turn = part * part * (3.0 - 2.0 * part);
        let (from, to) = if whole < 1.0 {
            (0, 1)
        } else if whole < 2.0 {
            (1, 2)
        } else {
            (2, 2)
        };
        let angle = tilts[from][0] + turn * (tilts[to][0] - tilts[from][0]);
        let lift = tilts[from][1] + turn * (tilts[to][1] - tilts[from][1]);
        let across = STANDARD_GRAVITY_MPS2 * libm::cos(lift);
        let cycle = time_s * triangle_hz - libm::floor(time_s * triangle_hz);
        let triangle = if index % 40_000 < 20_000 { 1.0 - 4.0 * (cycle - 0.5).abs() } else { 0.0 };
        Row {
            accel_mps2: [across * libm::cos(angle), across * libm::sin(angle), STANDARD_GRAVITY_MPS2 * libm::sin(lift)],
            rate_radps: rate[index] + triangle_size * triangle,
            cross_rate_radps: cross_size * libm::sin(2.0 * PI * cross_hz * time_s + phase),
            ..Row::default()
        }
    })
}

/// 1 g, a rate of some mrad/s at one slow tone, faint vibration of the building.
pub(super) fn quiet(rows: usize, draw: &mut Draw) -> Track {
    let angle = draw.uniform(0.0, 2.0 * PI);
    let (size, tone_hz, phase) = (draw.log_uniform(5e-4, 8e-3), draw.uniform(0.1, 0.5), draw.uniform(0.0, 2.0 * PI));
    let shake: [Vec<f64>; 3] = core::array::from_fn(|_| shape::band(rows, draw.uniform(8.0, 40.0), 6.0, draw));
    let level = draw.log_uniform(5e-3, 5e-2);
    track_of(rows, |index| {
        let time_s = index as f64 * PERIOD_S;
        let still = [STANDARD_GRAVITY_MPS2 * libm::cos(angle), STANDARD_GRAVITY_MPS2 * libm::sin(angle), 0.0];
        let tone = libm::sin(2.0 * PI * tone_hz * time_s + phase);
        Row {
            accel_mps2: core::array::from_fn(|axis| still[axis] + level * shake[axis][index]),
            rate_radps: size * tone,
            cross_rate_radps: 0.3 * size * libm::cos(2.0 * PI * tone_hz * time_s),
            ..Row::default()
        }
    })
}
