//! `pickoff_scale`, `pickoff_bias`, `torque_scale`, `torque_bias`, `time_skew`: sensors that only write the log.
//!
//! ```text
//! pickoff_scale   gyro_angle_rad  = seen (1 + s)
//! pickoff_bias    gyro_angle_rad  = seen + b
//! torque_scale    motor_torque_nm = T_m (1 + s)
//! torque_bias     motor_torque_nm = T_m + b
//! time_skew       inputs logged at t were those of t - d, d > 0; for d < 0 theta and T_m are those of t + d
//! ```
//!
//! Block `measurement`: the loop does not notice. Each changes the column named; `time_skew` the accelerations and
//! rates, or for d < 0 `gyro_angle_rad` and `motor_torque_nm`. Before the first row the inputs were those of the
//! first row.

use std::collections::VecDeque;

use super::Altered;
use crate::row::Row;

/// Errors of the sensors.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Measurement {
    pickoff_scale: f64,
    pickoff_bias_rad: f64,
    torque_scale: f64,
    torque_bias_nm: f64,
    pub(crate) skew_s: f64,
}

/// The rows that a late log still needs.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rows(VecDeque<Row>);

impl Measurement {
    pub(crate) fn gyro_angle_rad(&self, seen_rad: f64) -> f64 {
        seen_rad * (1.0 + self.pickoff_scale) + self.pickoff_bias_rad
    }

    pub(crate) fn motor_torque_nm(&self, torque_nm: f64) -> f64 {
        torque_nm * (1.0 + self.torque_scale) + self.torque_bias_nm
    }

    /// The row as logged: the external torque is no sensor's and stays.
    pub(crate) fn row(&self, rows: &Rows, row: &Row, period_s: f64) -> Row {
        if self.skew_s <= 0.0 {
            return *row;
        }
        Row { torque_nm: row.torque_nm, ..rows.before(row, self.skew_s / period_s) }
    }
}

impl Rows {
    /// Keeps the row before the present one, as far back as the skew needs.
    pub(crate) fn keep(&mut self, previous: &Row, skew_s: f64, period_s: f64) {
        if skew_s > 0.0 {
            self.0.push_front(*previous);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, some periods")]
            self.0.truncate((skew_s / period_s) as usize + 2);
        }
    }

    /// The row some periods before `row`, on the line between two.
    fn before(&self, row: &Row, periods: f64) -> Row {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, some periods")]
        let whole = periods as usize;
        let earliest = self.0.back().unwrap_or(row);
        let back = |count: usize| if count == 0 { row } else { self.0.get(count - 1).unwrap_or(earliest) };
        back(whole).toward(back(whole + 1), periods.fract())
    }
}

pub(super) fn pickoff_scale(values: &[f64], altered: &mut Altered) {
    altered.laws.measurement.pickoff_scale += values[0];
}

pub(super) fn pickoff_bias(values: &[f64], altered: &mut Altered) {
    altered.laws.measurement.pickoff_bias_rad += values[0];
}

pub(super) fn torque_scale(values: &[f64], altered: &mut Altered) {
    altered.laws.measurement.torque_scale += values[0];
}

pub(super) fn torque_bias(values: &[f64], altered: &mut Altered) {
    altered.laws.measurement.torque_bias_nm += values[0];
}

pub(super) fn time_skew(values: &[f64], altered: &mut Altered) {
    altered.laws.measurement.skew_s += values[0];
}
