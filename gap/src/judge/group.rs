//! Torques that are functions of the same.

/// A group of them.
#[derive(Debug)]
pub(crate) struct Group {
    /// What of.
    pub(crate) of: &'static str,
    /// A torque a row.
    pub(crate) torques: Vec<Vec<f64>>,
    /// What their choice among others costs [nats].
    pub(crate) choice: f64,
}
