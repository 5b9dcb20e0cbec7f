//! A log made ready for its balance: columns checked and mended, the motion chosen.

use gimbal_model_file::AxisModel;

use super::columns;
use super::follows::advance;
use super::library::rms;
use super::motion::{Motion, MotionFrom, NARROW, WIDE};
use super::plain::{nominal_rest, rounded};
use super::table::AxisLog;
use super::zero::take_zero_off;

/// Share of the effort from which on a gap is large.
const LARGE_GAP: f64 = 0.3;

/// A log made ready: columns checked, the motion chosen.
pub(super) fn ready(mut log: AxisLog, model: &AxisModel) -> (AxisLog, columns::Checked, Motion) {
    columns::unwrap(&mut log);
    take_zero_off(&mut log);
    let checked = columns::check(&log, model);
    if let Some(unit) = checked.unit {
        unit.undo(&mut log);
    }
    let from = checked.from.unwrap_or(MotionFrom::Position);
    let late = checked.faults.iter().find(|fault| fault.effect == "velocity_delay").map(|fault| fault.parameters[0].1);
    let scaled = checked.faults.iter().any(|fault| fault.effect.ends_with("_scale"));
    if let (Some(late_s), MotionFrom::Velocity, Some(velocity)) = (late, from, &mut log.velocity) {
        advance(velocity, late_s / log.period_s);
        log.notes.push(format!("the rate is taken {:.1} ms earlier for the balance", 1e3 * late_s));
    }
    let motion_of = |noise_share: f64| {
        let mut motion = Motion::new(&log, model, from, checked.effort_sign, noise_share);
        // an integrated rate loses the angle; the position column keeps it
        if let (MotionFrom::Velocity, Some(position), false) = (from, &log.position, scaled) {
            motion.q = motion.rest.apply(position);
            motion.middle = motion.q.iter().sum::<f64>() / motion.q.len().max(1) as f64;
        }
        motion
    };
    let mut motion = motion_of(NARROW);
    // a large gap stands out of more noise: a wider band shows more of it; what friction's corner makes is none
    if nominal_rest(&rounded(motion.clone(), &[]).0, model) > LARGE_GAP * rms(&motion.pick(&motion.effort)) {
        motion = motion_of(WIDE);
    }
    (log, checked, motion)
}
