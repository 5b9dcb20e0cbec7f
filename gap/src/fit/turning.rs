//! The loop behind the whitening: its response to a torque, and where the bearing turns around.

use super::shapes::Impulse;
use super::signals::{Signals, peak, predicted, scaled};
use crate::record::Record;
use crate::simulate::{Begin, Physics, Prediction, predict};

/// Rate after the impulse [rad/s].
const IMPULSE_RADPS: f64 = 1e-3;
/// Share of the rows up to which the bearing turns around seldom.
const SELDOM: f64 = 0.25;
/// Rows of one turn, in the mean, from which on it is slow.
pub(super) const SLOWLY: usize = 16;
/// How far from the slip rate a turn is none, over the rate's noise.
const NEARLY: f64 = 3.0;
/// Rows for which the loop remembers a disturbance.
const AFTER_TURNING: usize = 400;

/// The loop after an impulse of torque on the gimbal, bearings and unbalance aside; its channels over their noise.
pub(crate) fn impulse(base: &Physics, record: &Record, over_noise: &[f64]) -> Impulse {
    let physics = base.loop_alone();
    let rows = 4000;
    let zero = || vec![0.0; rows];
    let mut inputs = crate::simulate::Inputs {
        period_s: record.inputs.period_s,
        accel_mps2: [zero(), zero(), zero()],
        rate_radps: zero(),
        ..Default::default()
    };
    inputs.complete(&physics.config.bearing, 0.0);
    let mut begin = Begin::at(&physics, &inputs, 0.0, Some(0.0));
    begin.state[0] = IMPULSE_RADPS;
    let run = predict(&physics, &inputs, &begin, rows);
    let channels: Signals = record.channels.iter().map(|channel| predicted(channel.signal, &run).to_vec()).collect();
    Impulse {
        channels: scaled(channels, over_noise),
        torque_nm: impulse_nm(base, record),
        motor_torque_nm: run.motor_torque_nm,
        physics,
    }
}

/// The torque of that impulse, over one row [N m].
pub(crate) fn impulse_nm(base: &Physics, record: &Record) -> f64 {
    let carried = base.appendage.map_or(0.0, |[ratio, ..]| ratio);
    base.config.servo.gimbal_inertia_kg_m2 * (1.0 - carried) * IMPULSE_RADPS / record.inputs.period_s
}

/// Rows at which the bearing turns around: within the slip rate, or past it from one row to the next.
pub(crate) fn turns(base: &Physics, record: &Record, nominal: &Prediction) -> Vec<bool> {
    within(base.config.bearing.slip_rate_radps, record, nominal)
}

/// The same, and those at which it nearly does: noise of the rate may make a turn of it.
pub(crate) fn nearly_turns(base: &Physics, record: &Record, nominal: &Prediction) -> Vec<bool> {
    within(base.config.bearing.slip_rate_radps + NEARLY * record.rate_noise.rms_radps, record, nominal)
}

fn within(slip_radps: f64, record: &Record, nominal: &Prediction) -> Vec<bool> {
    let slips = record.inputs.slip_radps(nominal);
    let mut turns = vec![false; slips.len()];
    for k in 1..slips.len() {
        if slips[k - 1].min(slips[k]) < slip_radps && slips[k - 1].max(slips[k]) > -slip_radps {
            turns[k - 1] = true;
            turns[k] = true;
        }
    }
    turns
}

/// Whether it does so at once and seldom. Else the way in which friction turns around shows beside the noise of the
/// rate, and the loop is not linear in between.
pub(crate) fn at_once(turns: &[bool]) -> bool {
    let rows = turns.iter().filter(|turns| **turns).count();
    let runs = turns.windows(2).filter(|pair| pair[1] && !pair[0]).count();
    !mostly(turns) && rows <= SLOWLY * runs.max(1)
}

/// Whether the bearing hardly ever moves one way for long: a platform at rest.
pub(crate) fn mostly(turns: &[bool]) -> bool {
    turns.iter().filter(|turns| **turns).count() as f64 > SELDOM * turns.len() as f64
}

/// The same with the rows for which the loop remembers.
pub(crate) fn remembered(turns: &[bool]) -> Vec<bool> {
    let mut wait = 0_usize;
    let mut remembered = |&turns: &bool| {
        wait = if turns { AFTER_TURNING } else { wait.saturating_sub(1) };
        wait > 0
    };
    turns.iter().map(&mut remembered).collect()
}

/// Torque that the noise of the logged rate makes on the slope of the friction law, over that of the impulse, where the
/// bearing turns around and for as long as the loop remembers.
pub(crate) fn turning_noise(base: &Physics, record: &Record, nominal: &Prediction, turns: &[bool]) -> f64 {
    let rows = |of: &[bool]| of.iter().filter(|turns| **turns).count() as f64;
    let share = rows(turns) / rows(&remembered(turns)).max(1.0);
    let level_nm = peak(&nominal.friction_nm) * share.sqrt();
    let rate_radps = record.rate_noise.rms_radps;
    rate_radps * level_nm / base.config.bearing.slip_rate_radps / impulse_nm(base, record)
}
