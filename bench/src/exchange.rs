//! Bytes down and frames up: numbered, recorded, counted, and compared with what the twin says to the same bytes.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use gimbal_servo::Digest;
use gimbal_wire::{FRAME_LEN, Frame, Message, Receiver};

use crate::link::{Host, Link, LinkError};
use crate::record::Recorder;
use crate::station::StationError;

/// Longest wait within which nobody looks whether the user has interrupted.
const SLICE: Duration = Duration::from_millis(100);

/// How long an answer is waited for.
#[derive(Debug, Clone, Copy)]
pub struct Patience {
    /// Longest time for an answer, in which an emulator starts and a model is built, on a machine that is busy.
    pub answer: Duration,
    /// Whether the user has had enough.
    pub interrupted: fn() -> bool,
}

impl Default for Patience {
    /// Half a minute: a command takes milliseconds, and hundreds of times that on a machine that does other work.
    fn default() -> Self {
        Self { answer: Duration::from_secs(30), interrupted: || false }
    }
}

/// A link with its record and its twin.
pub(crate) struct Exchange {
    link: Box<dyn Link>,
    patience: Patience,
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

impl Exchange {
    pub(crate) fn new(link: Box<dyn Link>, patience: Patience) -> Self {
        Self {
            link,
            patience,
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

    /// From now on frames bear this tick.
    pub(crate) fn set_tick(&mut self, tick: u32) {
        self.tick = tick;
    }

    /// The next frame to be sent.
    pub(crate) fn frame(&mut self, message: Message) -> [u8; FRAME_LEN] {
        self.sequence = self.sequence.wrapping_add(1);
        Frame { sequence: self.sequence, tick: self.tick, message }.emit()
    }

    /// Records from now on.
    pub(crate) fn record(&mut self, recorder: Recorder) {
        self.recorder = Some(recorder);
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

    /// Sends bytes and takes frames up to the one that ends the answer. With `again`, the last frame of the bytes is
    /// sent once more whenever that time has passed without an answer.
    pub(crate) fn ask(
        &mut self,
        bytes: &[u8],
        again: Option<Duration>,
        ends: impl Fn(&Frame) -> bool,
    ) -> Result<Vec<Frame>, StationError> {
        self.send(bytes)?;
        let begun = Instant::now();
        loop {
            let left = self.patience.answer.saturating_sub(begun.elapsed());
            if let Some(frames) = self.listen(again.map_or(left, |again| again.min(left)), &ends)? {
                return Ok(frames);
            }
            if begun.elapsed() >= self.patience.answer {
                return Err(self.silent("no answer"));
            }
            self.asked_again += 1;
            let last = bytes[bytes.len().saturating_sub(FRAME_LEN)..].to_vec();
            self.send(&last)?;
        }
    }

    /// Asks until somebody answers: the other end may only just be starting.
    pub(crate) fn call(&mut self, bytes: &[u8], ends: impl Fn(&Frame) -> bool) -> Result<(), StationError> {
        const AGAIN: Duration = Duration::from_secs(2);
        let begun = Instant::now();
        loop {
            self.link.send(bytes)?;
            let left = self.patience.answer.saturating_sub(begun.elapsed());
            if self.listen(AGAIN.min(left), &ends)?.is_some() {
                break;
            }
            if begun.elapsed() >= self.patience.answer {
                return Err(self.silent("nobody answers"));
            }
        }
        // Answers to what was asked more than once.
        let rest = Duration::from_millis(5).min(self.patience.answer);
        while self.listen(rest, |_| true)?.is_some() {}
        Ok(())
    }

    fn silent(&self, what: &str) -> StationError {
        let (link, waited_s) = (self.link.describe(), self.patience.answer.as_secs_f64());
        let mend = "is it the program `hil`, at this baud rate, and does it still run? A slow one needs --patience-s";
        LinkError::new(format!("{link}: {what} in {waited_s} s"), mend).into()
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
    fn listen(&mut self, longest: Duration, ends: impl Fn(&Frame) -> bool) -> Result<Option<Vec<Frame>>, StationError> {
        let begun = Instant::now();
        let (mut frames, mut bytes) = (Vec::new(), Vec::with_capacity(2 * FRAME_LEN));
        loop {
            bytes.clear();
            self.link.receive(&mut bytes, SLICE.min(longest.saturating_sub(begun.elapsed())))?;
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
            if (self.patience.interrupted)() {
                return Err(StationError::Interrupted);
            }
            if begun.elapsed() >= longest {
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

    /// Whether the board has said what its twin has said; the tick of the first difference.
    pub(crate) fn equals_twin(&self) -> (bool, Option<u32>) {
        let same = self.first_difference.is_none() && self.unmatched.iter().all(VecDeque::is_empty);
        (same, self.first_difference)
    }

    /// Bytes down and up.
    pub(crate) fn bytes(&self) -> [u64; 2] {
        self.bytes
    }

    /// How often a tick was asked again.
    pub(crate) fn asked_again(&self) -> u32 {
        self.asked_again
    }

    /// Digest of everything that came up.
    pub(crate) fn digest(&self) -> u64 {
        self.digest.value()
    }

    /// What the link is.
    pub(crate) fn describe(&self) -> String {
        self.link.describe()
    }

    /// Digest of the program at its other end, where it is known.
    pub(crate) fn image(&self) -> Option<u64> {
        self.link.image()
    }

    /// Sends recorded bytes and takes as many back as were recorded.
    pub(crate) fn replay(&mut self, tick: u32, down: &[u8], count: usize) -> Result<Vec<u8>, StationError> {
        self.tick = tick;
        self.link.send(down)?;
        let mut bytes = Vec::with_capacity(count);
        let begun = Instant::now();
        while bytes.len() < count && begun.elapsed() < self.patience.answer {
            if (self.patience.interrupted)() {
                return Err(StationError::Interrupted);
            }
            self.link.receive(&mut bytes, SLICE.min(self.patience.answer.saturating_sub(begun.elapsed())))?;
        }
        Ok(bytes)
    }
}
