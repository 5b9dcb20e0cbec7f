//! Fault bits of a step.

use core::fmt;
use core::ops::{BitOr, BitOrAssign};

/// A set of fault bits.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Faults(u16);

impl Faults {
    /// No fault.
    pub const NONE: Self = Self(0);
    /// The gyro sits on a stop: what phi does meanwhile is not seen by it.
    pub const GYRO_SATURATED: Self = Self(1);
    /// The gyro has left a stop and phi keeps an offset that theta does not show.
    pub const OFFSET_LEFT: Self = Self(1 << 1);
    /// An input lay outside its range and was clamped.
    pub const INPUT_OUT_OF_RANGE: Self = Self(1 << 2);
    /// An input was not finite; the last good value was used.
    pub const INPUT_NOT_FINITE: Self = Self(1 << 3);
    /// The load or the rate lay beyond the friction tables, which were read at their end.
    pub const TABLE_END: Self = Self(1 << 4);
    /// A sum did not fit: phi beyond 1 rad, a torque beyond its full scale, or the INS sums full.
    pub const ARITHMETIC_SATURATED: Self = Self(1 << 5);
    /// phi is beyond 0.1 rad, where the model's linear equations no longer hold.
    pub const SMALL_ANGLE_EXCEEDED: Self = Self(1 << 6);

    /// Every bit with its name in results and reports.
    pub const NAMES: [(Self, &'static str); 7] = [
        (Self::GYRO_SATURATED, "gyro_saturated"),
        (Self::OFFSET_LEFT, "offset_left"),
        (Self::INPUT_OUT_OF_RANGE, "input_out_of_range"),
        (Self::INPUT_NOT_FINITE, "input_not_finite"),
        (Self::TABLE_END, "table_end"),
        (Self::ARITHMETIC_SATURATED, "arithmetic_saturated"),
        (Self::SMALL_ANGLE_EXCEEDED, "small_angle_exceeded"),
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

impl BitOr for Faults {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Faults {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

/// The names of the bits that are set.
#[cfg(feature = "defmt")]
impl defmt::Format for Faults {
    fn format(&self, f: defmt::Formatter<'_>) {
        let mut between = "{";
        for (bit, name) in Self::NAMES {
            if self.contains(bit) {
                defmt::write!(f, "{=str}{=str}", between, name);
                between = ", ";
            }
        }
        defmt::write!(f, "{=str}", if self.is_empty() { "{}" } else { "}" });
    }
}

impl fmt::Debug for Faults {
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
