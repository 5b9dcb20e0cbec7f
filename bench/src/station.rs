//! The computer at the end of a link: commands with their answers, and ticks.

use std::time::Duration;

use gimbal_computer::{BUILD, parameters};
use gimbal_wire::{Ack, Estimate, Faults, Frame, Hello, Identity, LoadEnd, LoadPart, Message, Outcome, PART_VALUES};
use gimbal_wire::{Reset, RingRow, Run};

use crate::exchange::{Exchange, Patience};
use crate::link::{Link, LinkError};
use crate::record::Recorder;

/// Time without an answer to a tick before it is asked again: the answer may have been lost on the way.
const TICK_AGAIN: Duration = Duration::from_millis(500);

/// Why a run cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum StationError {
    /// The link has failed, or the computer is silent.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The computer refuses what it should do.
    #[error("{0}")]
    Refused(String),
    /// The record cannot be written.
    #[error("record: cannot be written: {0}; free some space, or record elsewhere")]
    Record(std::io::Error),
    /// Interrupted from the keyboard.
    #[error("interrupted")]
    Interrupted,
}

/// A computer behind a link.
pub struct Board {
    pub(crate) exchange: Exchange,
}

impl Board {
    /// Finds the computer at the end of the link.
    ///
    /// # Errors
    /// Nobody answers.
    pub fn start(link: Box<dyn Link>, patience: Patience) -> Result<Self, StationError> {
        let mut board = Self { exchange: Exchange::new(link, patience) };
        // A delimiter first: it ends whatever came before.
        let hello = board.exchange.frame(Message::Hello(Hello { build: BUILD }));
        let called = [&[0], hello.as_slice()].concat();
        board.exchange.call(&called, |frame| matches!(frame.message, Message::Identity(_)))?;
        Ok(board)
    }

    /// Records from now on.
    ///
    /// # Errors
    /// The record cannot be written.
    pub fn record(&mut self, mut recorder: Recorder, header: &serde_json::Value) -> Result<(), StationError> {
        recorder.add(b'H', 0, header.to_string().as_bytes()).map_err(StationError::Record)?;
        self.exchange.record(recorder);
        Ok(())
    }

    /// Power-on: nothing is loaded, all counts are zero.
    ///
    /// # Errors
    /// No answer.
    pub fn power_on(&mut self) -> Result<Identity, StationError> {
        self.command(Message::Reset(Reset { whole: true }))?;
        match self.ask(Message::Hello(Hello { build: BUILD }), |message| matches!(message, Message::Identity(_)))? {
            Message::Identity(identity) => Ok(identity),
            other => Err(unexpected(&other)),
        }
    }

    /// Loads a model; its digest as the computer has it.
    ///
    /// # Errors
    /// No answer, or the computer refuses.
    pub fn load(&mut self, values: &parameters::Values) -> Result<u64, StationError> {
        for (index, part) in (0..).zip(values.chunks(PART_VALUES)) {
            let mut three = [0.0; PART_VALUES];
            three[..part.len()].copy_from_slice(part);
            self.obeyed(Message::LoadPart(LoadPart { index, values: three }))?;
        }
        let count = u16::try_from(values.len()).unwrap_or(u16::MAX);
        Ok(self.obeyed(Message::LoadEnd(LoadEnd { count, digest: parameters::digest(values) }))?.model)
    }

    /// Begins to step.
    ///
    /// # Errors
    /// No answer, or the computer refuses.
    pub fn run(&mut self, watchdog_ticks: u16) -> Result<(), StationError> {
        self.obeyed(Message::Run(Run { watchdog_ticks })).map(drop)
    }

    /// What has gone wrong so far.
    ///
    /// # Errors
    /// No answer.
    pub fn faults(&mut self) -> Result<Faults, StationError> {
        match self.ask(Message::ReadFaults, |message| matches!(message, Message::Faults(_)))? {
            Message::Faults(faults) => Ok(faults),
            other => Err(unexpected(&other)),
        }
    }

    /// The rows of the ring; nothing may run.
    ///
    /// # Errors
    /// No answer.
    pub fn ring(&mut self) -> Result<Vec<RingRow>, StationError> {
        let frame = self.exchange.frame(Message::DumpRing);
        let frames = self.exchange.ask(&frame, None, |frame| matches!(frame.message, Message::RingEnd(_)))?;
        let row = |frame: &Frame| if let Message::RingRow(row) = frame.message { Some(row) } else { None };
        Ok(frames.iter().filter_map(row).collect())
    }

    /// A command and what became of it.
    ///
    /// # Errors
    /// No answer.
    pub fn command(&mut self, message: Message) -> Result<Ack, StationError> {
        let command = message.kind() as u8;
        let answers = |answer: &Message| matches!(answer, Message::Ack(ack) if ack.command == command);
        match self.ask(message, answers)? {
            Message::Ack(ack) => Ok(ack),
            other => Err(unexpected(&other)),
        }
    }

    fn obeyed(&mut self, message: Message) -> Result<Ack, StationError> {
        let ack = self.command(message)?;
        if ack.outcome == Outcome::Done {
            return Ok(ack);
        }
        let parameter = parameters::NAMES.get(usize::from(ack.parameter)).copied().unwrap_or("the model as a whole");
        let (command, outcome) = (message.kind(), ack.outcome);
        let why = match outcome {
            Outcome::WrongModel => format!("no law can be built from it ({parameter})"),
            Outcome::AboveLimit => "a limit of the computer, which the bench cannot raise".to_owned(),
            Outcome::WrongMode => "not in its present mode".to_owned(),
            Outcome::Incomplete => "parts of the model are missing".to_owned(),
            Outcome::Done => String::new(),
        };
        Err(StationError::Refused(format!("the computer refuses {command:?}: {why}")))
    }

    fn ask(&mut self, message: Message, answers: impl Fn(&Message) -> bool) -> Result<Message, StationError> {
        let frame = self.exchange.frame(message);
        let frames = self.exchange.ask(&frame, None, |frame| answers(&frame.message))?;
        let answer = frames.iter().rfind(|frame| answers(&frame.message));
        answer.map(|frame| frame.message).ok_or_else(|| StationError::Refused("no answer to a command".to_owned()))
    }

    /// One period: what is left of the sensor frames, then the clock; the frames that come back, and the estimate.
    pub(crate) fn step(&mut self, tick: u32, down: &[Vec<u8>]) -> Result<(Vec<Frame>, Estimate), StationError> {
        self.exchange.set_tick(tick);
        let clock = self.exchange.frame(Message::Clock);
        // Behind a delimiter: what is cut off of the sensor frame must not reach into it.
        let mut bytes: Vec<u8> = down.concat();
        if bytes.last().is_some_and(|last| *last != 0) {
            bytes.push(0);
        }
        bytes.extend_from_slice(&clock);
        let of_tick = |frame: &Frame| match frame.message {
            Message::Estimate(estimate) if frame.tick == tick => Some(estimate),
            _ => None,
        };
        let frames = self.exchange.ask(&bytes, Some(TICK_AGAIN), |frame| of_tick(frame).is_some())?;
        match frames.iter().rev().find_map(of_tick) {
            Some(estimate) => Ok((frames, estimate)),
            None => Err(StationError::Refused("the computer answers a tick without an estimate".to_owned())),
        }
    }

    /// What the link is.
    #[must_use]
    pub fn describe(&self) -> String {
        self.exchange.describe()
    }
}

fn unexpected(message: &Message) -> StationError {
    StationError::Refused(format!("the computer answers a command with {message:?}"))
}
