//! What a tick gives: the estimate, and now and then the corrections and counts.

use crate::fields::{Reader, Writer};
use crate::frame::PAYLOAD_LEN;

use super::bits::Computer;
use super::mode::Mode;

/// The estimate at the frame's tick: the last frame of a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// phi, the attitude error; zero in mode safe [rad].
    pub gimbal_angle_rad: f32,
    /// Its uncertainty, 1 sigma; 1 rad in mode safe [rad].
    pub bound_rad: f32,
    /// Disturbance torque [N m].
    pub disturbance_torque_nm: f32,
    /// theta's innovation [rad].
    pub innovation_rad: f32,
    /// phi of the model [rad].
    pub modelled_gimbal_angle_rad: f32,
    /// theta of the model [rad].
    pub modelled_gyro_angle_rad: f32,
    /// Flags of the estimator.
    pub flags: u16,
    /// Fault bits of the model's step.
    pub faults: u16,
    /// Sequence number of the sensor frame that was used last.
    pub sensor_sequence: u16,
    /// What the computer is doing.
    pub mode: Mode,
    /// Age of the sensor frame [ticks]; 255: older, or none yet.
    pub age: u8,
}

impl Estimate {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .real([self.gimbal_angle_rad, self.bound_rad, self.disturbance_torque_nm, self.innovation_rad])
            .real([self.modelled_gimbal_angle_rad, self.modelled_gyro_angle_rad])
            .half(self.flags)
            .half(self.faults)
            .half(self.sensor_sequence)
            .byte(self.mode as u8)
            .byte(self.age)
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let [gimbal_angle_rad, bound_rad, disturbance_torque_nm, innovation_rad] = fields.real()?;
        let [modelled_gimbal_angle_rad, modelled_gyro_angle_rad] = fields.real()?;
        let (flags, faults, sensor_sequence) = (fields.half()?, fields.half()?, fields.half()?);
        let (mode, age) = (Mode::from_byte(fields.byte()?)?, fields.byte()?);
        fields.end(Self {
            gimbal_angle_rad,
            bound_rad,
            disturbance_torque_nm,
            innovation_rad,
            modelled_gimbal_angle_rad,
            modelled_gyro_angle_rad,
            flags,
            faults,
            sensor_sequence,
            mode,
            age,
        })
    }
}

/// Corrections, and what the computer has counted on the link; counts stay at their largest value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Telemetry {
    /// What the navigation adds to its velocity along x and y [m/s].
    pub velocity_correction_mps: [f32; 2],
    /// What it adds to its position along x and y [m].
    pub position_correction_m: [f32; 2],
    /// Frames accepted.
    pub accepted: u32,
    /// Frames whose checksum did not fit.
    pub checksum: u16,
    /// Bytes between delimiters that were no frame otherwise.
    pub structure: u16,
    /// Sequence numbers left out.
    pub lost: u16,
    /// Ticks without a new sensor frame.
    pub held: u16,
    /// Sensor frames that came too late, twice or out of order.
    pub stale: u16,
    /// The computer's own bits.
    pub computer: Computer,
}

impl Telemetry {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .real(self.velocity_correction_mps)
            .real(self.position_correction_m)
            .word(self.accepted)
            .half(self.checksum)
            .half(self.structure)
            .half(self.lost)
            .half(self.held)
            .half(self.stale)
            .half(self.computer.bits())
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (velocity_correction_mps, position_correction_m) = (fields.real()?, fields.real()?);
        let (accepted, checksum, structure) = (fields.word()?, fields.half()?, fields.half()?);
        let (lost, held, stale) = (fields.half()?, fields.half()?, fields.half()?);
        let computer = Computer::from_bits(fields.half()?)?;
        fields.end(Self {
            velocity_correction_mps,
            position_correction_m,
            accepted,
            checksum,
            structure,
            lost,
            held,
            stale,
            computer,
        })
    }
}
