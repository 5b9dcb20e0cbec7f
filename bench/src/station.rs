//! The computer at the end of a link: commands with their answers, ticks, the twin beside it, the record of it all.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use gimbal_computer::{BUILD, parameters};
use gimbal_servo::Digest;
use gimbal_wire::{
    Ack, Counts, Estimate, FRAME_LEN, Faults, Frame, Hello, Identity, LoadEnd, LoadPart, Message, Outcome, PART_VALUES,
    Receiver, Reset, Run,
};

use crate::link::{Host, Link, LinkError};
use crate::record::Recorder;

/// Time for the first word, in which an emulator starts.
const START: Duration = Duration::from_secs(10);
/// Time for the answer to a command: building a model is the longest.
const COMMAND: Duration = Duration::from_secs(5);
/// Time for the answer to a tick, before it is asked again, and how often.
const TICK: Duration = Duration::from_millis(500);
const TICK_TRIES: u32 = 6;

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
    link: Box<dyn Link>,
    receiver: Receiver,
    sequence: u16,
    tick: u32,
    recorder: Option<Recorder>,
    twin: Host,
    /// Bytes of the board and of its twin that are still to be compared.
    unmatched: [VecDeque<u8>; 2],
    /// Tick of the first byte that differed.
    first_difference: Option<u32>,
    bytes: [u64; 2],
    asked_again: u32,
    digest: Digest,
}

impl Board {
    /// Finds the computer at the end of the link and resets it.
    ///
    /// # Errors
    /// Nobody answers.
    pub fn start(link: Box<dyn Link>) -> Result<Self, StationError> {
        let mut board = Self {
            link,
            receiver: Receiver::default(),
            sequence: 0,
            tick: 0,
            recorder: None,
            twin: Host::new(),
            unmatched: [VecDeque::new(), VecDeque::new()],
            first_difference: None,
            bytes: [0; 2],
            asked_again: 0,
            digest: Digest::default(),
        };
        // A delimiter first: it ends whatever came before.
        let hello = board.frame(Message::Hello(Hello { build: BUILD }));
        let begun = Instant::now();
        loop {
            board.link.send(&[0])?;
            board.link.send(&hello)?;
            let wait = Duration::from_secs(2).min(START.saturating_sub(begun.elapsed()));
            if board.listen(wait, |frame| matches!(frame.message, Message::Identity(_)))?.is_some() {
                break;
            }
            if begun.elapsed() >= START {
                let what = format!("{}: nobody answers in {} s", board.link.describe(), START.as_secs());
                return Err(LinkError::new(what, "is it the program `hil`, at this baud rate?").into());
            }
        }
        // Answers to what was asked more than once.
        while board.listen(Duration::from_millis(5), |_| true)?.is_some() {}
        Ok(board)
    }

    /// Records from now on.
    ///
    /// # Errors
    /// The record cannot be written.
    pub fn record(&mut self, mut recorder: Recorder, header: &serde_json::Value) -> Result<(), StationError> {
        recorder.add(b'H', 0, header.to_string().as_bytes()).map_err(StationError::Record)?;
        self.recorder = Some(recorder);
        Ok(())
    }

    /// Adds an entry to the record.
    pub(crate) fn note(&mut self, kind: u8, content: &[u8]) -> Result<(), StationError> {
        match &mut self.recorder {
            Some(recorder) => recorder.add(kind, self.tick, content).map_err(StationError::Record),
            None => Ok(()),
        }
    }

    /// Closes the record.
    pub(crate) fn close_record(&mut self) -> Result<(), StationError> {
        self.recorder.take().map_or(Ok(()), Recorder::close).map_err(StationError::Record)
    }

    /// The next frame to be sent.
    pub(crate) fn frame(&mut self, message: Message) -> [u8; FRAME_LEN] {
        self.sequence = self.sequence.wrapping_add(1);
        Frame { sequence: self.sequence, tick: self.tick, message }.emit()
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
    pub fn ring(&mut self) -> Result<Vec<gimbal_wire::RingRow>, StationError> {
        let frame = self.frame(Message::DumpRing);
        let frames = self.exchange(&frame, COMMAND, 1, |frame| matches!(frame.message, Message::RingEnd(_)))?;
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
        let frame = self.frame(message);
        let frames = self.exchange(&frame, COMMAND, 1, |frame| answers(&frame.message))?;
        let silent = || LinkError::new("no answer to a command", "is the computer still running?");
        Ok(frames.last().ok_or_else(silent)?.message)
    }

    /// One period: what is left of the sensor frames, then the clock; the frames that come back, and the estimate.
    pub(crate) fn step(&mut self, tick: u32, down: &[Vec<u8>]) -> Result<(Vec<Frame>, Estimate), StationError> {
        self.tick = tick;
        let clock = self.frame(Message::Clock);
        // Behind a delimiter: what is cut off of the sensor frame must not reach into it.
        let mut bytes: Vec<u8> = down.concat();
        if bytes.last().is_some_and(|last| *last != 0) {
            bytes.push(0);
        }
        bytes.extend_from_slice(&clock);
        let ends = |frame: &Frame| frame.tick == tick && matches!(frame.message, Message::Estimate(_));
        let frames = self.exchange(&bytes, TICK, TICK_TRIES, ends)?;
        match frames.last().map(|frame| frame.message) {
            Some(Message::Estimate(estimate)) => Ok((frames, estimate)),
            _ => Err(StationError::Refused("the computer answers a tick without an estimate".to_owned())),
        }
    }

    /// Sends bytes and takes frames up to the one that ends the answer.
    fn exchange(
        &mut self,
        bytes: &[u8],
        patience: Duration,
        tries: u32,
        ends: impl Fn(&Frame) -> bool,
    ) -> Result<Vec<Frame>, StationError> {
        self.send(bytes)?;
        let mut tried = 1;
        loop {
            if let Some(frames) = self.listen(patience, &ends)? {
                return Ok(frames);
            }
            if tried >= tries {
                let waited = (patience * tries).as_millis();
                let what = format!("{}: no answer for {waited} ms", self.link.describe());
                return Err(LinkError::new(what, "see that the computer still runs, and start again").into());
            }
            tried += 1;
            self.asked_again += 1;
            // The clock alone: it is answered in the same words.
            let clock = bytes[bytes.len() - FRAME_LEN..].to_vec();
            self.send(&clock)?;
        }
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), StationError> {
        self.note(b'D', bytes)?;
        let mut answers = Vec::new();
        self.twin.answer(bytes, &mut answers);
        self.unmatched[1].extend(answers);
        self.bytes[0] += bytes.len() as u64;
        Ok(self.link.send(bytes)?)
    }

    /// Takes frames until one that ends the answer; `None` when none has come in time.
    fn listen(
        &mut self,
        patience: Duration,
        ends: impl Fn(&Frame) -> bool,
    ) -> Result<Option<Vec<Frame>>, StationError> {
        let begun = Instant::now();
        let (mut frames, mut bytes) = (Vec::new(), Vec::with_capacity(2 * FRAME_LEN));
        loop {
            bytes.clear();
            self.link.receive(&mut bytes, patience.saturating_sub(begun.elapsed()))?;
            if !bytes.is_empty() {
                self.note(b'U', &bytes)?;
                self.bytes[1] += bytes.len() as u64;
                self.digest.add(&bytes);
                self.unmatched[0].extend(&bytes);
            }
            let mut ended = false;
            for byte in &bytes {
                if let Some(frame) = self.receiver.push(*byte) {
                    ended |= ends(&frame);
                    frames.push(frame);
                }
            }
            if ended {
                self.compare();
                return Ok(Some(frames));
            }
            if begun.elapsed() >= patience {
                return Ok(None);
            }
        }
    }

    /// Compares what both have said so far.
    fn compare(&mut self) {
        let [board, twin] = &mut self.unmatched;
        let common = board.len().min(twin.len());
        let equal = board.drain(..common).eq(twin.drain(..common));
        if !equal && self.first_difference.is_none() {
            self.first_difference = Some(self.tick);
        }
    }

    /// From now on the twin is compared: both have been reset.
    pub(crate) fn begin_comparison(&mut self) {
        self.twin = Host::new();
        self.unmatched = [VecDeque::new(), VecDeque::new()];
        self.first_difference = None;
        self.digest = Digest::default();
        self.bytes = [0; 2];
        self.sequence = 0;
        self.receiver = Receiver::default();
    }

    /// Whether the board has said what its twin has said; the tick of the first difference.
    #[must_use]
    pub fn equals_twin(&self) -> (bool, Option<u32>) {
        let same = self.first_difference.is_none() && self.unmatched.iter().all(VecDeque::is_empty);
        (same, self.first_difference)
    }

    /// What the bench has counted on the way up.
    #[must_use]
    pub fn counts(&self) -> &Counts {
        self.receiver.counts()
    }

    /// Bytes down and up.
    #[must_use]
    pub fn bytes(&self) -> [u64; 2] {
        self.bytes
    }

    /// How often a tick was asked again.
    #[must_use]
    pub fn asked_again(&self) -> u32 {
        self.asked_again
    }

    /// Digest of everything that came up.
    #[must_use]
    pub fn digest(&self) -> u64 {
        self.digest.value()
    }

    /// What the link is.
    #[must_use]
    pub fn describe(&self) -> String {
        self.link.describe()
    }

    /// Sends recorded bytes and takes as many back as were recorded.
    pub(crate) fn replay(&mut self, tick: u32, down: &[u8], count: usize) -> Result<Vec<u8>, StationError> {
        self.tick = tick;
        self.link.send(down)?;
        let mut bytes = Vec::with_capacity(count);
        let begun = Instant::now();
        while bytes.len() < count && begun.elapsed() < COMMAND {
            self.link.receive(&mut bytes, COMMAND.saturating_sub(begun.elapsed()))?;
        }
        Ok(bytes)
    }
}

fn unexpected(message: &Message) -> StationError {
    StationError::Refused(format!("the computer answers a command with {message:?}"))
}
