//! Sets of bits with names: what a step, or an estimate, says of itself.

/// Defines a set of 16 bits: each bit's constant, its place, and its name in results and reports.
macro_rules! bit_set {
    ($(#[$about:meta])* $set:ident { $($(#[$bit_about:meta])* $bit:ident = $place:literal $name:literal),+ $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
        pub struct $set(u16);

        impl $set {
            /// No bit.
            pub const NONE: Self = Self(0);
            $($(#[$bit_about])* pub const $bit: Self = Self(1 << $place);)+

            /// Every bit with its name in results and reports.
            pub const NAMES: [(Self, &'static str); [$($place),+].len()] = [$((Self::$bit, $name)),+];

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

            /// The bits of either.
            #[must_use]
            pub const fn union(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }

            /// These bits but for those of `other`.
            #[must_use]
            pub const fn without(self, other: Self) -> Self {
                Self(self.0 & !other.0)
            }

            /// These bits if `condition`, else none.
            #[must_use]
            #[inline(always)]
            pub(crate) const fn when(self, condition: bool) -> Self {
                if condition { self } else { Self::NONE }
            }
        }

        impl core::ops::BitOr for $set {
            type Output = Self;
            fn bitor(self, other: Self) -> Self {
                self.union(other)
            }
        }

        impl core::ops::BitOrAssign for $set {
            fn bitor_assign(&mut self, other: Self) {
                self.0 |= other.0;
            }
        }

        /// The names of the bits that are set.
        #[cfg(feature = "defmt")]
        impl defmt::Format for $set {
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

        impl core::fmt::Debug for $set {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                let mut set = f.debug_set();
                for (bit, name) in Self::NAMES {
                    if self.contains(bit) {
                        set.entry(&format_args!("{name}"));
                    }
                }
                set.finish()
            }
        }
    };
}

pub(crate) use bit_set;
