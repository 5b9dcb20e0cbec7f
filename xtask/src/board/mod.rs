//! Checks on the microcontrollers, all under QEMU.

pub(crate) mod addresses;
mod boards;
pub(crate) mod budget;
pub(crate) mod c;
pub(crate) mod calibration;
pub(crate) mod cost;
pub(crate) mod digests;
mod emulator;
pub(crate) mod examples;
pub(crate) mod flight;
pub(crate) mod gates;
pub(crate) mod hil;
mod image;
pub(crate) mod lints;
pub(crate) mod log;
mod packages;
pub(crate) mod profile;
pub(crate) mod setup;
pub(crate) mod stack;
mod toolchain;

pub(crate) use boards::DEFAULT as DEFAULT_BOARD;
