//! Series of all channels: predicted, measured less predicted, one prediction less another.

use super::normal::narrow;
use crate::record::{Record, Signal};
use crate::simulate::Prediction;

/// One series a channel.
pub(crate) type Signals = Vec<Vec<f64>>;

/// One series a channel in single precision, as many are kept.
#[derive(Debug, Clone)]
pub(crate) struct Kept(Vec<Vec<f32>>);

impl Kept {
    pub(crate) fn new(signals: &Signals) -> Self {
        Self(signals.iter().map(|signal| narrow(signal)).collect())
    }

    pub(crate) fn signals(&self) -> Signals {
        self.0.iter().map(|signal| signal.iter().copied().map(f64::from).collect()).collect()
    }

    pub(crate) fn channels(&self) -> &[Vec<f32>] {
        &self.0
    }
}

/// The predicted samples of a channel.
pub(crate) fn predicted(signal: Signal, prediction: &Prediction) -> &[f64] {
    match signal {
        Signal::GyroAngle => &prediction.gyro_angle_rad,
        Signal::MotorTorque => &prediction.motor_torque_nm,
        Signal::GimbalAngle => &prediction.gimbal_angle_rad,
    }
}

/// Measured less what would be read of the prediction.
pub(crate) fn residual(record: &Record, prediction: &Prediction) -> Signals {
    let of = |channel: &crate::record::Channel| {
        channel.values.iter().zip(predicted(channel.signal, prediction)).map(|(a, b)| a - channel.reads(*b)).collect()
    };
    record.channels.iter().map(of).collect()
}

/// One prediction less another, over a step.
pub(crate) fn difference(record: &Record, moved: &Prediction, base: &Prediction, step: f64) -> Signals {
    let of = |channel: &crate::record::Channel| {
        let (moved, base) = (predicted(channel.signal, moved), predicted(channel.signal, base));
        let mut column: Vec<f64> = moved.iter().zip(base).map(|(a, b)| (a - b) / step).collect();
        column.resize(base.len(), 0.0);
        column
    };
    record.channels.iter().map(of).collect()
}

/// Each channel times its own factor.
pub(crate) fn scaled(mut signals: Signals, by: &[f64]) -> Signals {
    for (signal, by) in signals.iter_mut().zip(by) {
        for value in signal {
            *value *= by;
        }
    }
    signals
}

/// One channel of what stands row after row.
pub(crate) fn of_channel(rows: &[f64], channel: usize, channels: usize) -> impl Iterator<Item = f64> + '_ {
    rows.iter().skip(channel).step_by(channels).copied()
}

/// Rows at which every channel counts.
pub(crate) fn valid(record: &Record) -> Vec<bool> {
    (0..record.rows()).map(|k| record.channels.iter().all(|channel| channel.valid[k])).collect()
}

/// Largest size of a value.
pub(crate) fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |peak, value| peak.max(value.abs()))
}
