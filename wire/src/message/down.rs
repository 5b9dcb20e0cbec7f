//! From the bench to the flight computer.

use crate::fields::{Reader, Writer};
use crate::frame::PAYLOAD_LEN;

/// Parameters in one [`LoadPart`].
pub const PART_VALUES: usize = 3;

/// Who are you? Answered by [`Identity`](crate::Identity); sequence numbers begin anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hello {
    /// Digest of the bench's own flight code.
    pub build: u64,
}

impl Hello {
    pub(crate) fn payload(self) -> [u8; PAYLOAD_LEN] {
        Writer::new().long(self.build).payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let build = fields.long()?;
        fields.end(Self { build })
    }
}

/// Three parameters of a model, in the order of `docs/wire.md`; places beyond the last are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadPart {
    /// Number of the part: parameter `3 index` comes first.
    pub index: u16,
    /// The values, SI.
    pub values: [f64; PART_VALUES],
}

impl LoadPart {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new().half(self.index).double(self.values).payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (index, values) = (fields.half()?, fields.double()?);
        fields.end(Self { index, values })
    }
}

/// The model is complete. The computer builds it if the digest is that of what it has been sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LoadEnd {
    /// Number of parameters.
    pub count: u16,
    /// Digest of the parameters.
    pub digest: u64,
}

impl LoadEnd {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new().half(self.count).long(self.digest).payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (count, digest) = (fields.half()?, fields.long()?);
        fields.end(Self { count, digest })
    }
}

/// Forget the state; or everything, as after power-on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reset {
    /// The model and all counts, too.
    pub whole: bool,
}

impl Reset {
    pub(crate) fn payload(self) -> [u8; PAYLOAD_LEN] {
        Writer::new().byte(u8::from(self.whole)).payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let whole = fields.flag()?;
        fields.end(Self { whole })
    }
}

/// Begin to step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Run {
    /// Ticks without a sensor frame after which the output goes to its safe value; 0: the computer's own limit, which
    /// cannot be raised.
    pub watchdog_ticks: u16,
}

impl Run {
    pub(crate) fn payload(self) -> [u8; PAYLOAD_LEN] {
        Writer::new().half(self.watchdog_ticks).payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let watchdog_ticks = fields.half()?;
        fields.end(Self { watchdog_ticks })
    }
}

/// What the sensors read at the frame's tick; values are SI, and any bits are allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Specific force along x, y, z [m/s2].
    pub accel_mps2: [f32; 3],
    /// Vehicle rate about the gimbal axis [rad/s].
    pub vehicle_rate_radps: f32,
    /// theta, if there is a reading [rad].
    pub gyro_angle_rad: Option<f32>,
    /// `T_m`, if there is a reading [N m].
    pub motor_torque_nm: Option<f32>,
}

impl Sensor {
    const GYRO: u8 = 1;
    const TORQUE: u8 = 2;

    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        let gyro = self.gyro_angle_rad.map_or(0, |_| Self::GYRO);
        let torque = self.motor_torque_nm.map_or(0, |_| Self::TORQUE);
        let readings = [self.gyro_angle_rad, self.motor_torque_nm].map(Option::unwrap_or_default);
        Writer::new().real(self.accel_mps2).real([self.vehicle_rate_radps]).real(readings).byte(gyro | torque).payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (accel_mps2, [vehicle_rate_radps, gyro, torque]) = (fields.real()?, fields.real()?);
        let valid = fields.byte()?;
        // One form for each meaning: what is not there is zero.
        let reading = |value: f32, bit: u8| match (valid & bit != 0, value.to_bits()) {
            (true, _) => Some(Some(value)),
            (false, 0) => Some(None),
            (false, _) => None,
        };
        let (gyro_angle_rad, motor_torque_nm) = (reading(gyro, Self::GYRO)?, reading(torque, Self::TORQUE)?);
        if valid & !(Self::GYRO | Self::TORQUE) != 0 {
            return None;
        }
        fields.end(Self { accel_mps2, vehicle_rate_radps, gyro_angle_rad, motor_torque_nm })
    }
}
