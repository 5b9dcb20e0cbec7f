//! What an estimate says of itself.

use core::fmt;
use core::ops::{BitOr, BitOrAssign};

/// A set of flags.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Flags(u16);

impl Flags {
    /// Nothing to report.
    pub const NONE: Self = Self(0);
    /// The gyro sits on a stop: phi is carried by torque balance.
    pub const SATURATED: Self = Self(1);
    /// phi keeps an offset from a saturation, which the gyro does not show; the estimate holds it.
    pub const OFFSET_HELD: Self = Self(1 << 1);
    /// The bound is wider than the widest that is of use.
    pub const BOUND_TOO_WIDE: Self = Self(1 << 2);
    /// theta is predicted to reach its stop within the horizon.
    pub const SATURATION_AHEAD: Self = Self(1 << 3);
    /// The filter settles: after the first row, a release or an outage.
    pub const SETTLING: Self = Self(1 << 4);
    /// No theta at this row: missing, not finite, beyond the pick-off's range, or held back as a spike.
    pub const GYRO_MISSING: Self = Self(1 << 5);
    /// theta has not changed for too many rows.
    pub const GYRO_STUCK: Self = Self(1 << 6);
    /// theta has been missing for longer than can be bridged.
    pub const GYRO_LOST: Self = Self(1 << 7);
    /// No motor torque at this row: missing, not finite, out of range, or held back as a spike.
    pub const TORQUE_MISSING: Self = Self(1 << 8);
    /// The motor torque has not changed for too many rows.
    pub const TORQUE_STUCK: Self = Self(1 << 9);
    /// The motor torque has been missing for longer than can be bridged.
    pub const TORQUE_LOST: Self = Self(1 << 10);
    /// An acceleration or the rate was not finite or out of range.
    pub const INPUT_WRONG: Self = Self(1 << 11);
    /// An acceleration or the rate jumped, and was held for a row.
    pub const INPUT_SPIKE: Self = Self(1 << 12);
    /// An acceleration or the rate has not changed for too many rows.
    pub const INPUT_STUCK: Self = Self(1 << 13);
    /// A sensor was not well while phi was carried through a saturation: the offset kept since may be wrong by more than
    /// its bound. Stays set.
    pub const OFFSET_DOUBTFUL: Self = Self(1 << 14);
    /// The faults of theta and of the motor torque, and inputs that are no numbers or out of range.
    pub const GYRO_TORQUE_OR_WRONG: Self = Self(0x0FE0);
    /// The sensors' faults.
    pub const SENSORS: Self = Self(0x3FE0);

    /// Every flag with its name in results and reports.
    pub const NAMES: [(Self, &'static str); 15] = [
        (Self::SATURATED, "saturated"),
        (Self::OFFSET_HELD, "offset_held"),
        (Self::BOUND_TOO_WIDE, "bound_too_wide"),
        (Self::SATURATION_AHEAD, "saturation_ahead"),
        (Self::SETTLING, "settling"),
        (Self::GYRO_MISSING, "gyro_missing"),
        (Self::GYRO_STUCK, "gyro_stuck"),
        (Self::GYRO_LOST, "gyro_lost"),
        (Self::TORQUE_MISSING, "torque_missing"),
        (Self::TORQUE_STUCK, "torque_stuck"),
        (Self::TORQUE_LOST, "torque_lost"),
        (Self::INPUT_WRONG, "input_wrong"),
        (Self::INPUT_SPIKE, "input_spike"),
        (Self::INPUT_STUCK, "input_stuck"),
        (Self::OFFSET_DOUBTFUL, "offset_doubtful"),
    ];

    /// The bits.
    #[must_use]
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Whether all bits of `other` are set.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether any bit of `other` is set.
    #[must_use]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether no bit is set.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// These bits if `condition`, else none.
    #[must_use]
    #[inline(always)]
    pub(crate) const fn when(self, condition: bool) -> Self {
        if condition { self } else { Self::NONE }
    }
}

impl BitOr for Flags {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Flags {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

impl fmt::Debug for Flags {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut set = f.debug_set();
        for (bit, name) in Self::NAMES {
            if self.contains(bit) {
                set.entry(&format_args!("{name}"));
            }
        }
        set.finish()
    }
}
