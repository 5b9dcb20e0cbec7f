//! A state as bytes: little-endian, versioned, bound to its law, protected by a checksum.
//!
//! | bytes | content |
//! |---|---|
//! | 4 | `GSS2` |
//! | 1 | number system |
//! | 4 | identity of the law |
//! | 1 | regime: new, free, on the positive stop, on the negative one, just released |
//! | 2 | lasting fault bits |
//! | 2 | fault bits of the last step |
//! | 4 each | signals, in the order of [`State`]'s fields |
//! | 8 each | accumulating states |
//! | 48 | INS sums and carries |
//! | 4 | checksum of all before |

use core::fmt;

use crate::digest::Digest;
use crate::faults::Faults;
use crate::law::Law;
use crate::number::Number;
use crate::state::{Regime, State};
use crate::stop::Side;
use crate::stored::{Reader, Writer};

const MAGIC: [u8; 4] = *b"GSS2";

/// Length of a saved state in bytes.
pub const SAVED_LEN: usize = 14 + 15 * 4 + 18 * 8 + 6 * 8 + 4;

/// A state as bytes.
pub type Saved = [u8; SAVED_LEN];

/// Why bytes are not a state of this law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RestoreError {
    /// The bytes do not begin as a saved state does.
    NotAState,
    /// The checksum does not fit the bytes.
    Damaged,
    /// The state was saved by another number system.
    OtherNumberSystem,
    /// The state was saved by a law of other parameters.
    OtherLaw,
    /// A value is not finite or does not exist.
    Impossible,
}

impl fmt::Display for RestoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotAState => "these bytes are not a saved state",
            Self::Damaged => "the saved state is damaged: its checksum does not fit",
            Self::OtherNumberSystem => "the state was saved by the other number system",
            Self::OtherLaw => "the state was saved by a law with other parameters",
            Self::Impossible => "the saved state holds a value that no step can produce",
        })
    }
}

impl core::error::Error for RestoreError {}

impl<N: Number> Law<N> {
    /// The state as bytes.
    #[must_use]
    pub fn save(&self, state: &State<N>) -> Saved {
        let mut bytes = [0; SAVED_LEN];
        let mut writer = Writer { rest: &mut bytes };
        writer.put(&MAGIC);
        writer.put(&[N::TAG]);
        writer.put(&self.identity.to_le_bytes());
        let regime = match state.regime {
            Regime::New => 0,
            Regime::Free | Regime::Unusual => 1,
            Regime::Held(Side::Positive) => 2,
            Regime::Held(Side::Negative) => 3,
            Regime::Released => 4,
        };
        writer.put(&[regime]);
        writer.put(&state.lasting.bits().to_le_bytes());
        writer.put(&state.faults.bits().to_le_bytes());
        // Walking a copy keeps the order of fields in one place.
        let mut copy = *state;
        walk(&mut copy, &mut writer);
        let check = checksum(&bytes);
        bytes[SAVED_LEN - 4..].copy_from_slice(&check);
        bytes
    }

    /// The state that was saved.
    ///
    /// # Errors
    /// The bytes are damaged, foreign, or were saved by another law.
    pub fn restore(&self, bytes: &Saved) -> Result<State<N>, RestoreError> {
        if bytes[..4] != MAGIC {
            return Err(RestoreError::NotAState);
        }
        if bytes[SAVED_LEN - 4..] != checksum(bytes) {
            return Err(RestoreError::Damaged);
        }
        let mut reader = Reader { rest: &bytes[4..], impossible: false };
        if reader.take::<1>() != [N::TAG] {
            return Err(RestoreError::OtherNumberSystem);
        }
        if reader.take::<4>() != self.identity.to_le_bytes() {
            return Err(RestoreError::OtherLaw);
        }
        let mut state = self.start();
        state.regime = match reader.take::<1>() {
            [0] => Regime::New,
            [1] => self.off_stops(),
            [2] => Regime::Held(Side::Positive),
            [3] => Regime::Held(Side::Negative),
            [4] => Regime::Released,
            _ => return Err(RestoreError::Impossible),
        };
        state.lasting = match u16::from_le_bytes(reader.take()) {
            0 => Faults::NONE,
            bits if bits == Faults::OFFSET_LEFT.bits() => Faults::OFFSET_LEFT,
            _ => return Err(RestoreError::Impossible),
        };
        let bits = u16::from_le_bytes(reader.take());
        for (fault, _) in Faults::NAMES {
            state.faults |= if bits & fault.bits() == 0 { Faults::NONE } else { fault };
        }
        if state.faults.bits() != bits {
            return Err(RestoreError::Impossible);
        }
        walk(&mut state, &mut reader);
        if reader.impossible { Err(RestoreError::Impossible) } else { Ok(state) }
    }
}

/// What happens to each field in turn.
trait Codec {
    fn bytes<const L: usize>(&mut self, bytes: &mut [u8; L]);
    fn reject(&mut self);

    fn bits<N: Number>(&mut self, signal: &mut N) {
        let mut bytes = signal.to_bits().to_le_bytes();
        self.bytes(&mut bytes);
        *signal = N::from_bits(u32::from_le_bytes(bytes));
    }

    fn signal<N: Number>(&mut self, signal: &mut N) {
        self.bits(signal);
        if !signal.is_number() {
            self.reject();
        }
    }

    fn wide<N: Number>(&mut self, wide: &mut N::Wide) {
        let mut bytes = N::wide_to_bits(*wide).to_le_bytes();
        self.bytes(&mut bytes);
        *wide = N::wide_from_bits(u64::from_le_bytes(bytes));
        if !N::narrow(*wide).is_number() {
            self.reject();
        }
    }
}

/// Every field but the flags, in order.
fn walk<N: Number>(state: &mut State<N>, codec: &mut impl Codec) {
    let row = &mut state.row;
    for signal in [
        &mut row.accel_x_mps2,
        &mut row.accel_y_mps2,
        &mut row.accel_z_mps2,
        &mut row.vehicle_rate_radps,
        &mut row.torque_nm,
        &mut row.spin_rate_radps,
        &mut state.friction_level,
        &mut state.other_torque,
        &mut state.torque,
        &mut state.sensed_rate,
        &mut state.relative_rate,
        &mut state.gyro_angle,
        &mut state.gimbal_angle,
        &mut state.stop_change_age,
        &mut state.drift,
    ] {
        codec.signal(signal);
    }
    codec.wide::<N>(&mut state.offset);
    for mode in &mut state.free {
        codec.wide::<N>(mode);
    }
    codec.wide::<N>(&mut state.held.integrator);
    for lag in &mut state.held.lags {
        codec.wide::<N>(lag);
    }
    codec.wide::<N>(&mut state.held.gimbal_rate);
    codec.wide::<N>(&mut state.held.gimbal_angle);
    for sums in &mut state.ins.0 {
        for sum in [&mut sums.velocity, &mut sums.position] {
            let mut bytes = sum.to_le_bytes();
            codec.bytes(&mut bytes);
            *sum = i64::from_le_bytes(bytes);
        }
        let mut bytes = N::carry_to_bits(sums.carry).to_le_bytes();
        codec.bytes(&mut bytes);
        sums.carry = N::carry_from_bits(u64::from_le_bytes(bytes));
    }
}

impl Codec for Writer<'_> {
    fn bytes<const L: usize>(&mut self, bytes: &mut [u8; L]) {
        self.put(bytes);
    }
    fn reject(&mut self) {}
}

impl Codec for Reader<'_> {
    fn bytes<const L: usize>(&mut self, bytes: &mut [u8; L]) {
        *bytes = self.take();
    }
    fn reject(&mut self) {
        self.impossible = true;
    }
}

fn checksum(bytes: &Saved) -> [u8; 4] {
    let mut digest = Digest::default();
    digest.add(&bytes[..SAVED_LEN - 4]);
    digest.folded().to_le_bytes()
}
