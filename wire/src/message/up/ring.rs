//! The last rows that the computer has kept.

use crate::fields::{Reader, Writer};
use crate::frame::PAYLOAD_LEN;

/// One row of the ring, the oldest first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingRow {
    /// Number of the step.
    pub row: u32,
    /// theta as measured; not a number where there was no reading [rad].
    pub measured_gyro_angle_rad: f32,
    /// theta as modelled [rad].
    pub modelled_gyro_angle_rad: f32,
    /// Specific force along x, y, z [m/s2].
    pub accel_mps2: [f32; 3],
    /// Vehicle rate [rad/s].
    pub vehicle_rate_radps: f32,
}

impl RingRow {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .word(self.row)
            .real([self.measured_gyro_angle_rad, self.modelled_gyro_angle_rad])
            .real(self.accel_mps2)
            .real([self.vehicle_rate_radps])
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let row = fields.word()?;
        let [measured_gyro_angle_rad, modelled_gyro_angle_rad] = fields.real()?;
        let (accel_mps2, [vehicle_rate_radps]) = (fields.real()?, fields.real()?);
        fields.end(Self { row, measured_gyro_angle_rad, modelled_gyro_angle_rad, accel_mps2, vehicle_rate_radps })
    }
}

/// That was the last row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RingEnd {
    /// How many there were.
    pub rows: u16,
    /// Whether an alarm has stopped the ring.
    pub stopped: bool,
}

impl RingEnd {
    pub(crate) fn payload(self) -> [u8; PAYLOAD_LEN] {
        Writer::new().half(self.rows).byte(u8::from(self.stopped)).payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (rows, stopped) = (fields.half()?, fields.flag()?);
        fields.end(Self { rows, stopped })
    }
}
