//! `torque_saturation` and `dead_zone`: what the motor makes of its command.
//!
//! ```text
//! torque_saturation   clamp(T, -limit, limit)
//! dead_zone           T - clamp(T, -width, width)        behind the clamp, before the torque sensor
//! ```
//!
//! Block `servo`; a limit of zero means none. Change `gyro_angle_rad`, `motor_torque_nm` and the angles of the
//! gimbal. The integrator of F goes on integrating while the motor is saturated.

use super::Altered;

/// Limit and dead zone of the motor.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Motor {
    limit_nm: Option<f64>,
    width_nm: f64,
}

/// A stretch of the command in which the torque is a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    pub(crate) low_nm: f64,
    pub(crate) high_nm: f64,
    slope: f64,
    offset_nm: f64,
}

impl Motor {
    pub(crate) fn torque_nm(&self, command_nm: f64) -> f64 {
        let limit = self.limit_nm.unwrap_or(f64::INFINITY);
        let clamped = command_nm.clamp(-limit, limit);
        clamped - clamped.clamp(-self.width_nm, self.width_nm)
    }

    /// The least command that gives a torque; the limit if it lies beyond.
    pub(crate) fn command_nm(&self, torque_nm: f64) -> f64 {
        if torque_nm == 0.0 {
            return 0.0;
        }
        let limit = self.limit_nm.unwrap_or(f64::INFINITY);
        (torque_nm + self.width_nm.copysign(torque_nm)).clamp(-limit, limit)
    }

    /// The stretches from the most negative command to the most positive.
    pub(crate) fn stretches(&self) -> Vec<Stretch> {
        let mut corners = vec![f64::NEG_INFINITY, f64::INFINITY];
        if let Some(limit) = self.limit_nm {
            corners.extend([-limit, limit]);
        }
        if self.width_nm > 0.0 {
            corners.extend([-self.width_nm, self.width_nm]);
        }
        corners.sort_by(f64::total_cmp);
        let stretch = |pair: &[f64]| {
            let (low_nm, high_nm) = (pair[0], pair[1]);
            // two points inside the stretch fix its line; an open end is cut off 1 N m beyond the corner
            let (from, to) = match (low_nm.is_finite(), high_nm.is_finite()) {
                (true, true) => (low_nm, high_nm),
                (true, false) => (low_nm, low_nm + 1.0),
                (false, true) => (high_nm - 1.0, high_nm),
                (false, false) => (-1.0, 1.0),
            };
            let slope =
                if to > from { ((self.torque_nm(to) - self.torque_nm(from)) / (to - from)).round() } else { 0.0 };
            Stretch { low_nm, high_nm, slope, offset_nm: self.torque_nm(from) - slope * from }
        };
        corners.windows(2).map(stretch).collect()
    }
}

impl Stretch {
    pub(crate) fn torque_nm(&self, command_nm: f64) -> f64 {
        self.slope * command_nm + self.offset_nm
    }
}

pub(super) fn torque_saturation(values: &[f64], altered: &mut Altered) {
    altered.laws.motor.limit_nm = Some(values[0]);
}

pub(super) fn dead_zone(values: &[f64], altered: &mut Altered) {
    altered.laws.motor.width_nm += values[0];
}
