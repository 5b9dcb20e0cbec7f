//! What a prediction gives, and what the sensors make of it.

use super::Physics;
use super::inputs::later;

/// What the sensors would read, and what they do not see.
#[derive(Debug, Clone, Default)]
pub struct Prediction {
    /// Pick-off angle as logged [rad].
    pub gyro_angle_rad: Vec<f64>,
    /// Motor torque as logged [N m].
    pub motor_torque_nm: Vec<f64>,
    /// phi [rad].
    pub gimbal_angle_rad: Vec<f64>,
    /// phi' [rad/s].
    pub gimbal_rate_radps: Vec<f64>,
    /// Bearing friction [N m].
    pub friction_nm: Vec<f64>,
    /// Rows on a stop.
    pub on_stop: Vec<bool>,
}

impl Prediction {
    pub(super) fn zero(rows: usize) -> Self {
        Self {
            gyro_angle_rad: vec![0.0; rows],
            motor_torque_nm: vec![0.0; rows],
            gimbal_angle_rad: vec![0.0; rows],
            gimbal_rate_radps: vec![0.0; rows],
            friction_nm: vec![0.0; rows],
            on_stop: vec![false; rows],
        }
    }

    /// What the sensors make of it.
    ///
    /// Inputs that are logged late are outputs that are logged early. Inputs between their rows would be smoother than
    /// in them: their noise would weigh less, and every log look like a late one.
    pub(super) fn logged(&mut self, physics: &Physics, period_s: f64) {
        let sensors = physics.measurement;
        if sensors.skew_s != 0.0 {
            for output in [&mut self.gyro_angle_rad, &mut self.motor_torque_nm, &mut self.gimbal_angle_rad] {
                *output = later(output, sensors.skew_s / period_s);
            }
        }
        if sensors.torque_late_s != 0.0 {
            self.motor_torque_nm = later(&self.motor_torque_nm, -sensors.torque_late_s / period_s);
        }
        for theta in &mut self.gyro_angle_rad {
            *theta = *theta * sensors.pickoff_factor + sensors.pickoff_bias_rad;
        }
        for torque in &mut self.motor_torque_nm {
            *torque = *torque * sensors.torque_factor + sensors.torque_bias_nm;
        }
    }
}
