//! A run as a picture: inputs, angles, torques, velocity error; time on the stops shaded.

use std::io::Write;
use std::path::Path;

use gimbal_log::AtomicFile;
use gimbal_servo::Input;

use super::model::Sample;
use crate::exit::Failure;
use crate::plot::{Envelope, Figure, Line, Panel};

/// Signals over time, thinned out to what a picture can show.
pub(crate) struct Picture {
    accel: [Envelope; 3],
    rate: Envelope,
    gimbal_angle: Envelope,
    gyro_angle: Envelope,
    motor_torque: Envelope,
    friction_torque: Envelope,
    unbalance_torque: Envelope,
    velocity: [Envelope; 2],
    stop: Envelope,
}

impl Picture {
    /// No row yet.
    pub(crate) fn new() -> Self {
        let new = Envelope::new;
        Self {
            accel: [new(), new(), new()],
            rate: new(),
            gimbal_angle: new(),
            gyro_angle: new(),
            motor_torque: new(),
            friction_torque: new(),
            unbalance_torque: new(),
            velocity: [new(), new()],
            stop: new(),
        }
    }

    /// Takes a row.
    pub(crate) fn push(&mut self, time_s: f64, input: &Input<f64>, sample: &Sample) {
        let [x, y, z] = &mut self.accel;
        x.push(time_s, input.accel_x_mps2);
        y.push(time_s, input.accel_y_mps2);
        z.push(time_s, input.accel_z_mps2);
        self.rate.push(time_s, input.vehicle_rate_radps);
        self.gimbal_angle.push(time_s, sample.gimbal_angle_rad);
        self.gyro_angle.push(time_s, sample.gyro_angle_rad);
        self.motor_torque.push(time_s, sample.motor_torque_nm);
        self.friction_torque.push(time_s, sample.friction_torque_nm);
        self.unbalance_torque.push(time_s, sample.unbalance_torque_nm);
        let [x, y] = &mut self.velocity;
        x.push(time_s, sample.velocity_error_mps[0]);
        y.push(time_s, sample.velocity_error_mps[1]);
        self.stop.push(time_s, f64::from(sample.stop.abs()));
    }

    /// Draws the picture into a file.
    pub(crate) fn write(&self, path: &Path, title: &str) -> Result<(), Failure> {
        let shaded = self.stop.spans_above(0.5);
        let [accel_x, accel_y, accel_z] = &self.accel;
        let [velocity_x, velocity_y] = &self.velocity;
        let mut panels = Vec::new();
        if !self.accel.iter().all(Envelope::is_zero) {
            let lines = vec![Line::new("x", accel_x), Line::new("y", accel_y), Line::new("z", accel_z)];
            panels.push(Panel::new("Specific force", "m/s2", lines));
        }
        if !self.rate.is_zero() {
            panels.push(Panel::new("Vehicle rate about z", "rad/s", vec![Line::new("rate", &self.rate)]));
        }
        panels.push(Panel::new(
            "Angles",
            "rad",
            vec![Line::new("theta (gyro)", &self.gyro_angle), Line::new("phi (gimbal)", &self.gimbal_angle)],
        ));
        panels.push(Panel::new(
            "Torques",
            "N m",
            vec![
                Line::new("motor", &self.motor_torque),
                Line::new("friction", &self.friction_torque),
                Line::new("unbalance", &self.unbalance_torque),
            ],
        ));
        if !self.velocity.iter().all(Envelope::is_zero) {
            let lines = vec![Line::new("x", velocity_x), Line::new("y", velocity_y)];
            panels.push(Panel::new("Velocity error", "m/s", lines));
        }
        let figure = Figure { title, panels, shaded: &shaded, shaded_name: "gyro on its stop" };
        let text = figure.draw().map_err(|error| Failure::Environment(anyhow::Error::msg(error)))?;
        let fail = || Failure::write(path);
        let mut file = AtomicFile::create(path).map_err(fail())?;
        file.write_all(text.as_bytes()).map_err(fail())?;
        file.commit().map_err(fail())
    }
}
