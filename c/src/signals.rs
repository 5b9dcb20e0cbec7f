//! Inputs and outputs.

use gimbal_servo::{Fixed, Input, Number, Output, Stop};

/// One row of input in SI.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct GimbalInputF32 {
    /// Specific force along x [m/s2].
    pub accel_x_mps2: f32,
    /// Specific force along y [m/s2].
    pub accel_y_mps2: f32,
    /// Specific force along the gimbal axis z [m/s2].
    pub accel_z_mps2: f32,
    /// Vehicle rate about the gimbal axis [rad/s].
    pub vehicle_rate_radps: f32,
    /// External torque on the gimbal, beside friction and unbalance [N m].
    pub torque_nm: f32,
    /// The stable member's rate about the gyro's spin axis [rad/s].
    pub spin_rate_radps: f32,
}

/// The axis at the instant of the row just given, in SI.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct GimbalOutputF32 {
    /// phi, the attitude error [rad].
    pub gimbal_angle_rad: f32,
    /// phi' [rad/s].
    pub gimbal_rate_radps: f32,
    /// theta [rad].
    pub gyro_angle_rad: f32,
    /// `T_m` [N m].
    pub motor_torque_nm: f32,
    /// Friction torque on the gimbal [N m].
    pub friction_torque_nm: f32,
    /// Torque of the mass unbalance [N m].
    pub unbalance_torque_nm: f32,
    /// Mean of all disturbance torques over the period just past [N m].
    pub disturbance_torque_nm: f32,
    /// Vehicle rate less phi' [rad/s].
    pub relative_rate_radps: f32,
    /// How many periods ago the float met or left a stop; 0: it did not.
    pub stop_change_age: f32,
    /// The gyro's float: 0 free, 1 on the positive stop, -1 on the negative one.
    pub stop: i8,
    /// Fault bits: 1 gyro saturated, 2 offset left, 4 input out of range, 8 input not finite, 16 table end,
    /// 32 arithmetic saturated, 64 small angle exceeded.
    pub faults: u16,
}

/// One row of input as 32-bit fractions, 2^31 of their full scales.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct GimbalInputFixed {
    /// Specific force along x [m/s2].
    pub accel_x_mps2: i32,
    /// Specific force along y [m/s2].
    pub accel_y_mps2: i32,
    /// Specific force along the gimbal axis z [m/s2].
    pub accel_z_mps2: i32,
    /// Vehicle rate about the gimbal axis [rad/s].
    pub vehicle_rate_radps: i32,
    /// External torque on the gimbal, beside friction and unbalance [N m].
    pub torque_nm: i32,
    /// The stable member's rate about the gyro's spin axis [rad/s].
    pub spin_rate_radps: i32,
}

/// The axis at the instant of the row just given, as 32-bit fractions, 2^31 of their full scales.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct GimbalOutputFixed {
    /// phi, the attitude error [rad].
    pub gimbal_angle_rad: i32,
    /// phi' [rad/s].
    pub gimbal_rate_radps: i32,
    /// theta [rad].
    pub gyro_angle_rad: i32,
    /// `T_m` [N m].
    pub motor_torque_nm: i32,
    /// Friction torque on the gimbal [N m].
    pub friction_torque_nm: i32,
    /// Torque of the mass unbalance [N m].
    pub unbalance_torque_nm: i32,
    /// Mean of all disturbance torques over the period just past [N m].
    pub disturbance_torque_nm: i32,
    /// Vehicle rate less phi' [rad/s].
    pub relative_rate_radps: i32,
    /// How many periods ago the float met or left a stop; 0: it did not.
    pub stop_change_age: i32,
    /// The gyro's float: 0 free, 1 on the positive stop, -1 on the negative one.
    pub stop: i8,
    /// Fault bits: 1 gyro saturated, 2 offset left, 4 input out of range, 8 input not finite, 16 table end,
    /// 32 arithmetic saturated, 64 small angle exceeded.
    pub faults: u16,
}

impl GimbalInputF32 {
    pub(crate) fn input(&self) -> Input<f32> {
        Input {
            accel_x_mps2: self.accel_x_mps2,
            accel_y_mps2: self.accel_y_mps2,
            accel_z_mps2: self.accel_z_mps2,
            vehicle_rate_radps: self.vehicle_rate_radps,
            torque_nm: self.torque_nm,
            spin_rate_radps: self.spin_rate_radps,
        }
    }

    /// In double precision.
    pub(crate) fn si(&self) -> Input<f64> {
        Input {
            accel_x_mps2: self.accel_x_mps2.into(),
            accel_y_mps2: self.accel_y_mps2.into(),
            accel_z_mps2: self.accel_z_mps2.into(),
            vehicle_rate_radps: self.vehicle_rate_radps.into(),
            torque_nm: self.torque_nm.into(),
            spin_rate_radps: self.spin_rate_radps.into(),
        }
    }
}

impl GimbalOutputF32 {
    pub(crate) fn of(output: &Output<f32>) -> Self {
        Self {
            gimbal_angle_rad: output.gimbal_angle_rad,
            gimbal_rate_radps: output.gimbal_rate_radps,
            gyro_angle_rad: output.gyro_angle_rad,
            motor_torque_nm: output.motor_torque_nm,
            friction_torque_nm: output.friction_torque_nm,
            unbalance_torque_nm: output.unbalance_torque_nm,
            disturbance_torque_nm: output.disturbance_torque_nm,
            relative_rate_radps: output.relative_rate_radps,
            stop_change_age: output.stop_change_age,
            stop: stop(output.stop),
            faults: output.faults.bits(),
        }
    }
}

impl GimbalInputFixed {
    pub(crate) fn input(&self) -> Input<Fixed> {
        Input {
            accel_x_mps2: Fixed::from_bits(self.accel_x_mps2.cast_unsigned()),
            accel_y_mps2: Fixed::from_bits(self.accel_y_mps2.cast_unsigned()),
            accel_z_mps2: Fixed::from_bits(self.accel_z_mps2.cast_unsigned()),
            vehicle_rate_radps: Fixed::from_bits(self.vehicle_rate_radps.cast_unsigned()),
            torque_nm: Fixed::from_bits(self.torque_nm.cast_unsigned()),
            spin_rate_radps: Fixed::from_bits(self.spin_rate_radps.cast_unsigned()),
        }
    }

    pub(crate) fn of(input: &Input<Fixed>) -> Self {
        Self {
            accel_x_mps2: input.accel_x_mps2.to_bits().cast_signed(),
            accel_y_mps2: input.accel_y_mps2.to_bits().cast_signed(),
            accel_z_mps2: input.accel_z_mps2.to_bits().cast_signed(),
            vehicle_rate_radps: input.vehicle_rate_radps.to_bits().cast_signed(),
            torque_nm: input.torque_nm.to_bits().cast_signed(),
            spin_rate_radps: input.spin_rate_radps.to_bits().cast_signed(),
        }
    }
}

impl GimbalOutputFixed {
    pub(crate) fn of(output: &Output<Fixed>) -> Self {
        Self {
            gimbal_angle_rad: output.gimbal_angle_rad.to_bits().cast_signed(),
            gimbal_rate_radps: output.gimbal_rate_radps.to_bits().cast_signed(),
            gyro_angle_rad: output.gyro_angle_rad.to_bits().cast_signed(),
            motor_torque_nm: output.motor_torque_nm.to_bits().cast_signed(),
            friction_torque_nm: output.friction_torque_nm.to_bits().cast_signed(),
            unbalance_torque_nm: output.unbalance_torque_nm.to_bits().cast_signed(),
            disturbance_torque_nm: output.disturbance_torque_nm.to_bits().cast_signed(),
            relative_rate_radps: output.relative_rate_radps.to_bits().cast_signed(),
            stop_change_age: output.stop_change_age.to_bits().cast_signed(),
            stop: stop(output.stop),
            faults: output.faults.bits(),
        }
    }
}

fn stop(stop: Stop) -> i8 {
    match stop {
        Stop::Free => 0,
        Stop::Positive => 1,
        Stop::Negative => -1,
    }
}
