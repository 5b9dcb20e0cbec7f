//! Effects that the contract's table does not have. They differ in nature: over the angle, over time at random, in
//! events, with a memory of another kind, in the drive, in the gyro, in the structure.

use core::f64::consts::PI;

use super::{Effect, Scale, World};
use crate::draw::Draw;
use crate::truth::{Appendage, Contact};

/// Small and largest size of an effect.
#[allow(clippy::match_same_arms)] // one row an effect
pub(super) fn range(effect: &Effect) -> Option<(f64, f64)> {
    Some(match effect.name {
        "position_dependent_friction" => (3e-3, 0.7),
        "coloured_torque" | "bistable_spring" | "stick_slip_chatter" => (1e-6, 5e-3),
        "torque_pulses" => (1e-5, 2e-2),
        "intermittent_contact" | "cable_creep" => (1e-6, 0.2),
        "motor_heating" => (1e-3, 0.4),
        "backlash" => (2e-3, 0.3),
        "wheel_hunting" => (1e-4, 0.2),
        "servo_dropout" => (1e-3, 0.08),
        "float_restraint" => (1e-5, 0.05),
        "torque_asymmetry" => (2e-3, 0.3),
        "rate_squared_torque" => (1e-6, 1e-2),
        _ => return None,
    })
}

/// Spans at random places, at least two.
fn spans(effect: &Effect, scale: &Scale, every_s: f64, length_s: f64) -> Vec<(f64, f64)> {
    let mut draw = Draw::new(&effect.seed, 1);
    let mut spans = Vec::new();
    let mut from = draw.uniform(1.2, 1.2 + every_s);
    while from < scale.length_s {
        spans.push((from, from + length_s * draw.uniform(0.7, 1.3)));
        from += length_s + every_s * draw.uniform(0.5, 1.5);
    }
    spans
}

/// A random torque of rms `size`, first order, with the power below its corner.
fn coloured(effect: &Effect, size: f64, scale: &Scale) -> Vec<f64> {
    let mut draw = Draw::new(&effect.seed, 2);
    let corner_hz = effect.between_logs(0, 0.5, 15.0);
    let keep = libm::exp(-2.0 * PI * corner_hz * scale.period_s);
    let drive = size * libm::sqrt(1.0 - keep * keep);
    let mut value = size * draw.normal();
    (0..scale.rows)
        .map(|_| {
            value = keep * value + drive * draw.normal();
            value
        })
        .collect()
}

/// Half sines of random sign, place and length.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most one a second
fn pulses(effect: &Effect, size: f64, scale: &Scale) -> Vec<f64> {
    let mut draw = Draw::new(&effect.seed, 3);
    let mut series = vec![0.0; scale.rows];
    let count = (scale.length_s * effect.between_logs(0, 0.15, 1.0)).max(3.0);
    for _ in 0..count as usize {
        let from = scale.before + draw.below(scale.rows - scale.before);
        let length = 6 + draw.below(60);
        let height = size * draw.sign() * draw.uniform(0.5, 1.5);
        for (place, value) in series.iter_mut().skip(from).take(length).enumerate() {
            *value += height * libm::sin(PI * place as f64 / length as f64);
        }
    }
    series
}

pub(super) fn apply(effect: &Effect, size: f64, scale: &Scale, world: &mut World) {
    let truth = &mut world.truth;
    let span = scale.relative_rad.max(1e-4);
    match effect.name {
        "position_dependent_friction" => {
            let cycles = effect.between_logs(0, 1.0, 12.0) * PI / span.min(2.0 * PI);
            truth.friction.position = Some([size, cycles, 2.0 * PI * effect.shape[1]]);
        }
        "coloured_torque" => truth.torque.series_nm = coloured(effect, size, scale),
        "torque_pulses" => truth.torque.series_nm = pulses(effect, size, scale),
        "bistable_spring" => truth.torque.snap = Some([size, span * effect.between(0, 0.1, 0.4)]),
        "intermittent_contact" => {
            let length_s = effect.between(0, 0.6, 2.0);
            truth.torque.contact = Some(Contact {
                stiffness: effect.sign * size,
                from_rad: -effect.between(1, 0.2, 0.8) * span,
                spans_s: spans(effect, scale, 3.0, length_s),
            });
        }
        "stick_slip_chatter" => {
            let limit = scale.rate_radps * effect.between(1, 0.1, 0.4);
            truth.torque.chatter = Some([size, limit / effect.between_logs(0, 20.0, 80.0), limit]);
        }
        "motor_heating" => {
            truth.drive.heating = Some([size, 0.3 * scale.torque_nm, effect.between(0, 3.0, 12.0)]);
        }
        "backlash" => {
            truth.appendage = Some(Appendage {
                share: size,
                frequency_radps: 2.0 * PI * effect.between_logs(0, 30.0, 120.0),
                damping: 0.1,
                play_rad: effect.between_logs(1, 1e-5, 3e-4),
            });
        }
        "wheel_hunting" => {
            truth.float.hunting = Some([size, effect.between_logs(0, 1.5, 9.0), 2.0 * PI * effect.shape[1]]);
        }
        "cable_creep" => truth.torque.creep = Some([size, effect.between_logs(0, 0.4, 6.0)]),
        "servo_dropout" => truth.drive.frozen_s = spans(effect, scale, 2.0, size),
        "float_restraint" => truth.float.restraint = size,
        "torque_asymmetry" => truth.drive.torque_asymmetry = effect.sign * size,
        "rate_squared_torque" => truth.torque.rate_squared = effect.sign * size,
        _ => {}
    }
}
