//! The scenarios that are shipped, in the order in which `gimbal hil all` flies them.

/// A shipped scenario.
#[derive(Debug, Clone, Copy)]
pub struct Shipped {
    /// Its name.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        &[$(Shipped { name: $name, text: include_str!(concat!("../../scenarios/", $name, ".toml")) }),*]
    };
}

/// Every shipped scenario.
pub const SHIPPED: &[Shipped] = shipped![
    "paper-unbalance",
    "paper-friction",
    "rocket",
    "sway",
    "saturation",
    "sensor-faults",
    "link-noise",
    "link-order",
    "disconnect",
    "reset-in-flight",
    "wrong-model",
    "overload",
];
