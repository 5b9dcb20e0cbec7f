//! The computer itself: commands, ticks, watchdog.
//!
//! ```text
//! empty --load--> ready --run--> running <--> safe       stop: ready;  reset: ready, or empty if whole
//! ```
//!
//! A tick takes the newest sensor frame since the last one. Without one, or with one that is too old, the last row is
//! held and the estimator is told that its sensors are missing; after the watchdog's patience the output is the safe
//! one: no correction, the widest bound, mode *safe*. The model steps on meanwhile, so that nothing is lost when frames
//! come again. The watchdog's patience can be shortened by the bench, never lengthened.

mod answer;
mod commands;
mod tick;

use gimbal_servo::Number;
use gimbal_wire::{Ack, Computer as Bits, FRAME_LEN, Frame, Message, Mode, Outcome, Receiver, RingEnd, Sensor};
use heapless::Deque;

use crate::axis::Axis;
use crate::limits;
use crate::parameters::{COUNT, Values};

/// Answers that wait to be taken; a tick gives two at most.
const WAITING: usize = 16;

/// A flight computer.
pub struct Computer<N: Number> {
    receiver: Receiver,
    answers: Deque<[u8; FRAME_LEN], WAITING>,
    sequence: u16,
    tick: Option<u32>,
    mode: Mode,
    /// Parameters under way, and a bit for each part that has come.
    values: Values,
    parts: u64,
    axis: Option<Axis<N>>,
    waiting: Option<Held>,
    /// Sequence number and tick of the sensor frame used last.
    used: Option<(u16, u32)>,
    watch: Watch,
    counts: Counts,
    /// The next row of the ring that is to be sent.
    dump: Option<usize>,
    last_estimate: Option<Frame>,
}

/// A sensor frame that waits for its tick.
#[derive(Clone, Copy)]
struct Held {
    sequence: u16,
    tick: u32,
    sensor: Sensor,
}

/// The watchdog.
#[derive(Clone, Copy, Default)]
struct Watch {
    patience: u16,
    silent: u16,
    fresh: u16,
}

/// What has been counted since the last reset.
#[derive(Clone, Copy, Default)]
struct Counts {
    model: u16,
    estimator: u16,
    computer: Bits,
    trips: u16,
    safe_ticks: u32,
    ignored: u32,
    held: u16,
    stale: u16,
    /// Frames since the last tick.
    within_tick: u16,
}

impl<N: Number> Default for Computer<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<N: Number> Computer<N> {
    /// As after power-on.
    #[must_use]
    pub fn new() -> Self {
        Self {
            receiver: Receiver::default(),
            answers: Deque::new(),
            sequence: 0,
            tick: None,
            mode: Mode::Empty,
            values: [0.0; COUNT],
            parts: 0,
            axis: None,
            waiting: None,
            used: None,
            watch: Watch::default(),
            counts: Counts::default(),
            dump: None,
            last_estimate: None,
        }
    }

    /// Takes bytes from the link. At most one tick's answers fit: take them before the next call.
    pub fn receive(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.receive_byte(byte);
        }
    }

    /// Takes one byte; whether it completed a frame.
    pub fn receive_byte(&mut self, byte: u8) -> bool {
        let Some(frame) = self.receiver.push(byte) else { return false };
        self.obey(&frame);
        true
    }

    /// The next frame to be sent.
    pub fn take(&mut self) -> Option<[u8; FRAME_LEN]> {
        if let Some(frame) = self.answers.pop_front() {
            return Some(frame);
        }
        let row = self.dump?;
        let axis = self.axis.as_ref()?;
        if let Some(kept) = axis.kept(row) {
            self.dump = Some(row.saturating_add(1));
            return Some(self.stamped(Message::RingRow(kept)).emit());
        }
        self.dump = None;
        let rows = u16::try_from(row).unwrap_or(u16::MAX);
        let stopped = axis.ring.is_stopped();
        Some(self.stamped(Message::RingEnd(RingEnd { rows, stopped })).emit())
    }

    /// Nothing has come from the bench for too long by the board's own clock: the safe output, until frames come again.
    ///
    /// For boards with a timer of their own; the bench's clock stands still when the bench does.
    pub fn silence(&mut self) {
        if self.mode == Mode::Running {
            self.trip();
        }
    }

    /// What the computer is doing.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// What has come in so far.
    #[must_use]
    pub fn link(&self) -> &gimbal_wire::Counts {
        self.receiver.counts()
    }

    fn obey(&mut self, frame: &Frame) {
        if matches!(self.mode, Mode::Running | Mode::Safe) && frame.message != Message::Clock {
            self.counts.within_tick = self.counts.within_tick.saturating_add(1);
            if self.counts.within_tick > limits::FRAMES_A_TICK {
                self.counts.ignored = self.counts.ignored.saturating_add(1);
                self.counts.computer |= Bits::OVERLOADED;
                return;
            }
        }
        let acked = match frame.message {
            Message::Sensor(sensor) => return self.keep(frame, sensor),
            Message::Clock => return self.tick(frame.tick),
            Message::Hello(_) => return self.introduce(frame),
            Message::ReadFaults => return self.report(),
            Message::LoadPart(part) => self.load_part(&part),
            Message::LoadEnd(end) => self.load_end(end),
            Message::Reset(reset) => {
                self.reset(reset.whole);
                Ok(())
            }
            Message::Run(run) => self.run(run.watchdog_ticks),
            Message::Stop => {
                self.stop();
                Ok(())
            }
            Message::DumpRing => self.dump_ring(),
            // What goes up has no meaning on the way down.
            Message::Identity(_)
            | Message::Ack(_)
            | Message::Faults(_)
            | Message::RingRow(_)
            | Message::RingEnd(_)
            | Message::Estimate(_)
            | Message::Telemetry(_) => return,
        };
        let (outcome, parameter) = acked.map_or_else(|refused| refused, |()| (Outcome::Done, 0));
        let command = frame.message.kind() as u8;
        let model = self.model();
        self.answer(Message::Ack(Ack { command, outcome, sequence: frame.sequence, parameter, model }));
    }

    fn model(&self) -> u64 {
        self.axis.as_ref().map_or(0, |axis| axis.digest)
    }

    fn stamped(&mut self, message: Message) -> Frame {
        let frame = Frame { sequence: self.sequence, tick: self.tick.unwrap_or_default(), message };
        self.sequence = self.sequence.wrapping_add(1);
        frame
    }

    fn answer(&mut self, message: Message) -> Frame {
        let frame = self.stamped(message);
        // A full queue means that nobody takes answers: the newest is left out, and its number shows it.
        let _ = self.answers.push_back(frame.emit());
        frame
    }
}
