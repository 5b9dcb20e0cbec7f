//! What the computer is doing.

/// What the computer is doing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Mode {
    /// No model is loaded.
    #[default]
    Empty = 0,
    /// A model is loaded; nothing steps.
    Ready = 1,
    /// It steps, and the output is good.
    Running = 2,
    /// It steps, and the output is the safe one.
    Safe = 3,
}

impl Mode {
    pub(super) fn from_byte(byte: u8) -> Option<Self> {
        [Self::Empty, Self::Ready, Self::Running, Self::Safe].into_iter().find(|mode| *mode as u8 == byte)
    }

    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Empty => "empty",
            Self::Ready => "ready",
            Self::Running => "running",
            Self::Safe => "safe",
        }
    }
}
