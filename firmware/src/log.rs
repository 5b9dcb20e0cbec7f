//! Log lines: text by semihosting, or with the feature `defmt` numbers that the host turns into text.
//!
//! Both write where a debugger listens, and stop the core while they do; on silicon `defmt-rtt` is the logger that does
//! not. Lines are written from the idle loop alone, so neither ever delays the tick by more than the critical section
//! in which a line is written.

#[cfg(feature = "defmt")]
use defmt_semihosting as _;

/// What a line is written with.
#[cfg(feature = "defmt")]
#[doc(hidden)]
pub use defmt;

/// A line of the flight's log. Format strings as both `core::fmt` and `defmt` take them: `{}` and `{:016x}`.
#[cfg(feature = "defmt")]
#[macro_export]
macro_rules! info {
    ($($part:tt)*) => { $crate::log::defmt::info!($($part)*) };
}
/// A line of the flight's log.
#[cfg(not(feature = "defmt"))]
#[macro_export]
macro_rules! info {
    ($($part:tt)*) => { $crate::semihosting::println!($($part)*) };
}
/// A line about something that must not happen.
#[cfg(feature = "defmt")]
#[macro_export]
macro_rules! warning {
    ($($part:tt)*) => { $crate::log::defmt::warn!($($part)*) };
}
/// A line about something that must not happen.
#[cfg(not(feature = "defmt"))]
#[macro_export]
macro_rules! warning {
    ($($part:tt)*) => { $crate::semihosting::println!($($part)*) };
}
/// The program's last line.
#[cfg(feature = "defmt")]
#[macro_export]
macro_rules! fatal {
    ($($part:tt)*) => { $crate::log::defmt::error!($($part)*) };
}
/// The program's last line.
#[cfg(not(feature = "defmt"))]
#[macro_export]
macro_rules! fatal {
    ($($part:tt)*) => { $crate::semihosting::println!($($part)*) };
}
