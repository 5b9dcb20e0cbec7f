//! From a configuration to a law, in f64, once: poles of the closed loop, modes, full scales, quantisation.

pub(crate) mod complex;
pub(crate) mod modes;
pub(crate) mod plant;
pub(crate) mod poles;
