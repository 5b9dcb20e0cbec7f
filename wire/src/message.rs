//! What frames say: commands and sensors down, estimates and telemetry up.

pub(crate) mod down;
pub(crate) mod up;

use crate::fields::Reader;
use crate::frame::PAYLOAD_LEN;
use down::{Hello, LoadEnd, LoadPart, Reset, Run, Sensor};
use up::{Ack, Estimate, Faults, Identity, RingEnd, RingRow, Telemetry};

/// One message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Message {
    /// Who are you?
    Hello(Hello),
    /// Three parameters of a model.
    LoadPart(LoadPart),
    /// The model is complete: build it.
    LoadEnd(LoadEnd),
    /// Forget.
    Reset(Reset),
    /// Begin.
    Run(Run),
    /// End.
    Stop,
    /// What has gone wrong so far?
    ReadFaults,
    /// The last rows, please.
    DumpRing,
    /// What the sensors read.
    Sensor(Sensor),
    /// A period is over: step.
    Clock,
    /// Who I am.
    Identity(Identity),
    /// What became of a command.
    Ack(Ack),
    /// What has gone wrong so far.
    Faults(Faults),
    /// One row of the ring.
    RingRow(RingRow),
    /// That was the last row.
    RingEnd(RingEnd),
    /// The estimate at a tick.
    Estimate(Estimate),
    /// Corrections and the computer's count of the link.
    Telemetry(Telemetry),
}

/// Kind of a message: its second byte. Bit 7 is set on the way up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Kind {
    /// [`Message::Hello`]
    Hello = 0x01,
    /// [`Message::LoadPart`]
    LoadPart = 0x02,
    /// [`Message::LoadEnd`]
    LoadEnd = 0x03,
    /// [`Message::Reset`]
    Reset = 0x04,
    /// [`Message::Run`]
    Run = 0x05,
    /// [`Message::Stop`]
    Stop = 0x06,
    /// [`Message::ReadFaults`]
    ReadFaults = 0x07,
    /// [`Message::DumpRing`]
    DumpRing = 0x08,
    /// [`Message::Sensor`]
    Sensor = 0x09,
    /// [`Message::Clock`]
    Clock = 0x0A,
    /// [`Message::Identity`]
    Identity = 0x81,
    /// [`Message::Ack`]
    Ack = 0x82,
    /// [`Message::Faults`]
    Faults = 0x87,
    /// [`Message::RingRow`]
    RingRow = 0x88,
    /// [`Message::RingEnd`]
    RingEnd = 0x89,
    /// [`Message::Estimate`]
    Estimate = 0x8A,
    /// [`Message::Telemetry`]
    Telemetry = 0x8B,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 17] = [
        Self::Hello,
        Self::LoadPart,
        Self::LoadEnd,
        Self::Reset,
        Self::Run,
        Self::Stop,
        Self::ReadFaults,
        Self::DumpRing,
        Self::Sensor,
        Self::Clock,
        Self::Identity,
        Self::Ack,
        Self::Faults,
        Self::RingRow,
        Self::RingEnd,
        Self::Estimate,
        Self::Telemetry,
    ];

    /// The kind of a byte.
    #[must_use]
    pub fn from_byte(byte: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| *kind as u8 == byte)
    }
}

impl Message {
    /// Its kind.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Hello(_) => Kind::Hello,
            Self::LoadPart(_) => Kind::LoadPart,
            Self::LoadEnd(_) => Kind::LoadEnd,
            Self::Reset(_) => Kind::Reset,
            Self::Run(_) => Kind::Run,
            Self::Stop => Kind::Stop,
            Self::ReadFaults => Kind::ReadFaults,
            Self::DumpRing => Kind::DumpRing,
            Self::Sensor(_) => Kind::Sensor,
            Self::Clock => Kind::Clock,
            Self::Identity(_) => Kind::Identity,
            Self::Ack(_) => Kind::Ack,
            Self::Faults(_) => Kind::Faults,
            Self::RingRow(_) => Kind::RingRow,
            Self::RingEnd(_) => Kind::RingEnd,
            Self::Estimate(_) => Kind::Estimate,
            Self::Telemetry(_) => Kind::Telemetry,
        }
    }

    pub(crate) fn payload(&self) -> [u8; PAYLOAD_LEN] {
        match self {
            Self::Hello(message) => message.payload(),
            Self::LoadPart(message) => message.payload(),
            Self::LoadEnd(message) => message.payload(),
            Self::Reset(message) => message.payload(),
            Self::Run(message) => message.payload(),
            Self::Stop | Self::ReadFaults | Self::DumpRing | Self::Clock => [0; PAYLOAD_LEN],
            Self::Sensor(message) => message.payload(),
            Self::Identity(message) => message.payload(),
            Self::Ack(message) => message.payload(),
            Self::Faults(message) => message.payload(),
            Self::RingRow(message) => message.payload(),
            Self::RingEnd(message) => message.payload(),
            Self::Estimate(message) => message.payload(),
            Self::Telemetry(message) => message.payload(),
        }
    }

    pub(crate) fn parse(kind: Kind, payload: &[u8; PAYLOAD_LEN]) -> Option<Self> {
        let fields = Reader::new(payload);
        match kind {
            Kind::Hello => Hello::parse(fields).map(Self::Hello),
            Kind::LoadPart => LoadPart::parse(fields).map(Self::LoadPart),
            Kind::LoadEnd => LoadEnd::parse(fields).map(Self::LoadEnd),
            Kind::Reset => Reset::parse(fields).map(Self::Reset),
            Kind::Run => Run::parse(fields).map(Self::Run),
            Kind::Stop => fields.end(Self::Stop),
            Kind::ReadFaults => fields.end(Self::ReadFaults),
            Kind::DumpRing => fields.end(Self::DumpRing),
            Kind::Clock => fields.end(Self::Clock),
            Kind::Sensor => Sensor::parse(fields).map(Self::Sensor),
            Kind::Identity => Identity::parse(fields).map(Self::Identity),
            Kind::Ack => Ack::parse(fields).map(Self::Ack),
            Kind::Faults => Faults::parse(fields).map(Self::Faults),
            Kind::RingRow => RingRow::parse(fields).map(Self::RingRow),
            Kind::RingEnd => RingEnd::parse(fields).map(Self::RingEnd),
            Kind::Estimate => Estimate::parse(fields).map(Self::Estimate),
            Kind::Telemetry => Telemetry::parse(fields).map(Self::Telemetry),
        }
    }
}
