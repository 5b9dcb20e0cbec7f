//! What the computer itself has to report, one bit each.

use core::ops::{BitOr, BitOrAssign};

/// What the computer itself has to report, beside the faults of the model and the flags of the estimator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Computer(u16);

impl Computer {
    /// Nothing to report.
    pub const NONE: Self = Self(0);
    /// The watchdog has gone off since the last reset.
    pub const WATCHDOG_TRIPPED: Self = Self(1);
    /// More frames came within a tick than are looked at; the others were ignored.
    pub const OVERLOADED: Self = Self(1 << 1);
    /// theta as measured and as modelled have parted.
    pub const MODEL_DISAGREES: Self = Self(1 << 2);
    /// The correction was larger than the computer lets out, and was clamped.
    pub const CORRECTION_CLAMPED: Self = Self(1 << 3);
    /// A whole reset has taken place since the bench said hello.
    pub const RESTARTED: Self = Self(1 << 4);

    /// Every bit with its name in reports.
    pub const NAMES: [(Self, &'static str); 5] = [
        (Self::WATCHDOG_TRIPPED, "watchdog_tripped"),
        (Self::OVERLOADED, "overloaded"),
        (Self::MODEL_DISAGREES, "model_disagrees"),
        (Self::CORRECTION_CLAMPED, "correction_clamped"),
        (Self::RESTARTED, "restarted"),
    ];

    /// The bits.
    #[must_use]
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// The bits of a frame; `None` if one has no meaning.
    #[must_use]
    pub const fn from_bits(bits: u16) -> Option<Self> {
        if bits < 1 << 5 { Some(Self(bits)) } else { None }
    }

    /// Whether all bits of `other` are set.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

impl BitOr for Computer {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Computer {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}
