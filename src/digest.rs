//! A digest of a run: the proof that two machines computed the same bits.

use crate::faults::Faults;
use crate::number::Number;
use crate::signals::{Output, Stop};

/// 64-bit FNV-1a (Fowler, Noll, Vo) over the bits of everything a step puts out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Digest(u64);

const BASIS: u64 = 0xCBF2_9CE4_8422_2325;
const PRIME: u64 = 0x0100_0000_01B3;

impl Default for Digest {
    fn default() -> Self {
        Self(BASIS)
    }
}

impl Digest {
    /// Adds bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(PRIME);
        }
    }

    /// Adds the bits of signals.
    pub fn add_signals<N: Number>(&mut self, signals: &[N]) {
        for signal in signals {
            self.add(&signal.to_bits().to_le_bytes());
        }
    }

    /// Adds all signals and bits of an output.
    pub fn add_output<N: Number>(&mut self, output: &Output<N>) {
        self.add_signals(&[
            output.gimbal_angle_rad,
            output.gimbal_rate_radps,
            output.gyro_angle_rad,
            output.motor_torque_nm,
            output.friction_torque_nm,
            output.unbalance_torque_nm,
            output.disturbance_torque_nm,
            output.relative_rate_radps,
            output.stop_change_age,
        ]);
        let stop = match output.stop {
            Stop::Free => 0,
            Stop::Positive => 1,
            Stop::Negative => 2,
        };
        self.add(&[stop]);
        self.add(&Faults::bits(output.faults).to_le_bytes());
    }

    /// The digest so far in 32 bits: its two halves combined.
    #[must_use]
    pub(crate) fn folded(self) -> u32 {
        let [a, b, c, d, e, f, g, h] = self.0.to_le_bytes();
        u32::from_le_bytes([a, b, c, d]) ^ u32::from_le_bytes([e, f, g, h])
    }

    /// The digest so far.
    #[must_use]
    pub fn value(&self) -> u64 {
        self.0
    }
}
