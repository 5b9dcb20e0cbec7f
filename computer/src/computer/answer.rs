//! What a tick says: the estimate within its limits, the safe one, and the telemetry.

use gimbal_servo::Number;
use gimbal_wire::{Computer as Bits, Estimate, Message, Mode, Telemetry};

use super::Computer;
use crate::axis::{Axis, Stepped, bits, narrow};
use crate::limits;

impl<N: Number> Computer<N> {
    pub(super) fn estimate(&mut self, stepped: &Stepped, tick: u32) -> Estimate {
        let (mut gimbal_angle_rad, mut bound_rad) =
            (narrow(stepped.estimate.gimbal_angle_rad), narrow(stepped.estimate.bound_rad));
        if self.mode == Mode::Safe {
            (gimbal_angle_rad, bound_rad) = (0.0, limits::SAFE_BOUND_RAD);
        } else if !(-limits::CORRECTION_RAD..=limits::CORRECTION_RAD).contains(&gimbal_angle_rad) {
            let limit = limits::CORRECTION_RAD;
            gimbal_angle_rad = if gimbal_angle_rad > 0.0 { limit } else { -limit };
            self.counts.computer |= Bits::CORRECTION_CLAMPED;
        }
        let (sensor_sequence, age) =
            self.used.map_or((0, u8::MAX), |(sequence, sent)| (sequence, clipped(tick.wrapping_sub(sent))));
        Estimate {
            gimbal_angle_rad,
            bound_rad,
            disturbance_torque_nm: narrow(stepped.estimate.disturbance_torque_nm),
            innovation_rad: narrow(stepped.estimate.innovation_rad),
            modelled_gimbal_angle_rad: narrow(stepped.output.gimbal_angle_rad),
            modelled_gyro_angle_rad: narrow(stepped.output.gyro_angle_rad),
            flags: stepped.estimate.flags.bits(),
            faults: bits(stepped.output.faults),
            sensor_sequence,
            mode: self.mode,
            age,
        }
    }

    /// The answer to a tick while nothing steps: the safe output.
    pub(super) fn idle(&self) -> Message {
        Message::Estimate(Estimate {
            gimbal_angle_rad: 0.0,
            bound_rad: limits::SAFE_BOUND_RAD,
            disturbance_torque_nm: 0.0,
            innovation_rad: 0.0,
            modelled_gimbal_angle_rad: 0.0,
            modelled_gyro_angle_rad: 0.0,
            flags: 0,
            faults: 0,
            sensor_sequence: 0,
            mode: self.mode,
            age: u8::MAX,
        })
    }

    pub(super) fn telemetry(&self) -> Message {
        let (velocity, position) = self.axis.as_ref().map_or_else(Default::default, Axis::corrections);
        let link = self.receiver.counts();
        let clip = |count: u32| u16::try_from(count).unwrap_or(u16::MAX);
        Message::Telemetry(Telemetry {
            velocity_correction_mps: velocity.map(narrow),
            position_correction_m: position.map(narrow),
            accepted: link.accepted,
            checksum: clip(link.checksum),
            structure: clip(link.refused() - link.checksum),
            lost: clip(link.lost),
            held: self.counts.held,
            stale: self.counts.stale,
            computer: self.counts.computer,
        })
    }
}

fn clipped(age: u32) -> u8 {
    u8::try_from(age).unwrap_or(u8::MAX)
}
