//! Plain axes: effects that an independent simulation has are found, those that it has not are not.

mod real;
mod simulated;
mod simulator;
