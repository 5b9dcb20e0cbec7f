//! Who the computer is, what became of a command, and what has gone wrong so far.

use crate::fields::{Reader, Writer};
use crate::frame::PAYLOAD_LEN;

use super::bits::Computer;
use super::mode::Mode;

/// What became of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Outcome {
    /// Done.
    Done = 0,
    /// Not in this mode.
    WrongMode = 1,
    /// A limit of the computer, which the bench cannot raise.
    AboveLimit = 2,
    /// Parts are missing, or the digest is another one.
    Incomplete = 3,
    /// A parameter has no meaning, or no law can be built from the model.
    WrongModel = 4,
}

impl Outcome {
    fn from_byte(byte: u8) -> Option<Self> {
        [Self::Done, Self::WrongMode, Self::AboveLimit, Self::Incomplete, Self::WrongModel]
            .into_iter()
            .find(|outcome| *outcome as u8 == byte)
    }
}

/// Who I am.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Identity {
    /// Digest of the flight code's source.
    pub build: u64,
    /// Digest of the model that is loaded; 0: none.
    pub model: u64,
    /// Largest number of ticks that the watchdog waits.
    pub watchdog_ticks: u16,
    /// Number of parameters of a model.
    pub parameters: u16,
    /// What the computer is doing.
    pub mode: Mode,
    /// Number system of the law: 0 `f32`, 1 fixed point.
    pub number: u8,
}

impl Identity {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .long(self.build)
            .long(self.model)
            .half(self.watchdog_ticks)
            .half(self.parameters)
            .byte(self.mode as u8)
            .byte(self.number)
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (build, model) = (fields.long()?, fields.long()?);
        let (watchdog_ticks, parameters) = (fields.half()?, fields.half()?);
        let (mode, number) = (Mode::from_byte(fields.byte()?)?, fields.byte()?);
        fields.end(Self { build, model, watchdog_ticks, parameters, mode, number })
    }
}

/// What became of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ack {
    /// Kind of the command.
    pub command: u8,
    /// What became of it.
    pub outcome: Outcome,
    /// Sequence number of the command.
    pub sequence: u16,
    /// Number of the parameter that is wrong, if one is.
    pub parameter: u16,
    /// Digest of the model that is loaded; 0: none.
    pub model: u64,
}

impl Ack {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .byte(self.command)
            .byte(self.outcome as u8)
            .half(self.sequence)
            .half(self.parameter)
            .long(self.model)
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (command, outcome) = (fields.byte()?, Outcome::from_byte(fields.byte()?)?);
        let (sequence, parameter, model) = (fields.half()?, fields.half()?, fields.long()?);
        fields.end(Self { command, outcome, sequence, parameter, model })
    }
}

/// Everything that has been set since the last reset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Faults {
    /// Fault bits of the model's step.
    pub model: u16,
    /// Flags of the estimator.
    pub estimator: u16,
    /// The computer's own.
    pub computer: Computer,
    /// How often the watchdog has gone off.
    pub trips: u16,
    /// Ticks with the safe output.
    pub safe_ticks: u32,
    /// Frames ignored because too many came within a tick.
    pub ignored: u32,
}

impl Faults {
    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        Writer::new()
            .half(self.model)
            .half(self.estimator)
            .half(self.computer.bits())
            .half(self.trips)
            .word(self.safe_ticks)
            .word(self.ignored)
            .payload()
    }

    pub(crate) fn parse(mut fields: Reader) -> Option<Self> {
        let (model, estimator) = (fields.half()?, fields.half()?);
        let computer = Computer::from_bits(fields.half()?)?;
        let (trips, safe_ticks, ignored) = (fields.half()?, fields.word()?, fields.word()?);
        fields.end(Self { model, estimator, computer, trips, safe_ticks, ignored })
    }
}
