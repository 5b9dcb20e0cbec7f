//! The loop behind the whitening: its response to a torque, and where the noise of the logged rate is torque.

use super::signals::{Signals, peak, predicted};
use crate::record::Record;
use crate::simulate::{Begin, Physics, Prediction, predict};

/// Rate after the impulse [rad/s].
const IMPULSE_RADPS: f64 = 1e-3;
/// Rows for which the loop remembers a disturbance.
const AFTER_TURNING: usize = 400;

/// Every channel after an impulse of torque on the gimbal, bearings and unbalance aside.
pub(crate) fn impulse(base: &Physics, record: &Record) -> Signals {
    let mut physics = base.clone();
    physics.config.bearing.count = 0;
    physics.config.unbalance.x_kg_m = 0.0;
    physics.config.unbalance.y_kg_m = 0.0;
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
    record.channels.iter().map(|channel| predicted(channel.signal, &run).to_vec()).collect()
}

/// Rows at which friction turns around, with what follows; and the share of them in which the noise of the rate acts.
pub(crate) fn turning(base: &Physics, record: &Record, nominal: &Prediction) -> (Vec<bool>, f64) {
    let slip = base.config.bearing.slip_rate_radps;
    let (mut wait, mut inside) = (0_usize, 0.0);
    let rates = record.inputs.rate_radps.iter().zip(&nominal.gimbal_rate_radps);
    let turning: Vec<bool> = rates
        .map(|(vehicle, gimbal)| {
            let turns = (vehicle - gimbal).abs() < slip;
            inside += f64::from(u8::from(turns));
            wait = if turns { AFTER_TURNING } else { wait.saturating_sub(1) };
            wait > 0
        })
        .collect();
    let all = turning.iter().filter(|turning| **turning).count();
    (turning, inside / all.max(1) as f64)
}

/// Torque that the noise of the logged rate makes on the slope of the friction law, over that of the impulse.
pub(crate) fn turning_noise(base: &Physics, record: &Record, nominal: &Prediction) -> f64 {
    let rate = record.rate_noise.rms_radps;
    let level = peak(&nominal.friction_nm);
    let impulse_nm = base.config.servo.gimbal_inertia_kg_m2 * IMPULSE_RADPS / record.inputs.period_s;
    rate * level / base.config.bearing.slip_rate_radps / impulse_nm
}
