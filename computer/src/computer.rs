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

use gimbal_servo::Number;
use gimbal_wire::{
    Ack, Computer as Bits, Estimate, FRAME_LEN, Faults, Frame, Identity, LoadEnd, LoadPart, Message, Mode, Outcome,
    PART_VALUES, Receiver, RingEnd, Sensor, Telemetry,
};
use heapless::Deque;

use crate::BUILD;
use crate::axis::{Axis, Stepped, bits, narrow};
use crate::limits;
use crate::parameters::{self, COUNT, Values};

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

    fn introduce(&mut self, frame: &Frame) {
        self.receiver.restart_sequence(frame.sequence);
        self.counts.computer =
            Bits::from_bits(self.counts.computer.bits() & !Bits::RESTARTED.bits()).unwrap_or_default();
        let identity = Identity {
            build: BUILD,
            model: self.model(),
            watchdog_ticks: limits::WATCHDOG_TICKS,
            parameters: u16::try_from(COUNT).unwrap_or(u16::MAX),
            mode: self.mode,
            number: u8::from(N::HAS_SCALES),
        };
        self.answer(Message::Identity(identity));
    }

    fn report(&mut self) {
        let Counts { model, estimator, computer, trips, safe_ticks, ignored, .. } = self.counts;
        self.answer(Message::Faults(Faults { model, estimator, computer, trips, safe_ticks, ignored }));
    }

    fn load_part(&mut self, part: &LoadPart) -> Result<(), (Outcome, u16)> {
        self.unless_running()?;
        let first = usize::from(part.index).saturating_mul(PART_VALUES);
        if first >= COUNT {
            return Err((Outcome::WrongModel, part.index));
        }
        if part.index == 0 {
            self.parts = 0;
        }
        for (place, value) in self.values.iter_mut().skip(first).zip(part.values) {
            *place = value;
        }
        self.parts |= 1_u64.checked_shl(u32::from(part.index)).unwrap_or(0);
        Ok(())
    }

    fn load_end(&mut self, end: LoadEnd) -> Result<(), (Outcome, u16)> {
        self.unless_running()?;
        let parts = COUNT.div_ceil(PART_VALUES);
        let all = parts == self.parts.count_ones() as usize && usize::from(end.count) == COUNT;
        if !all || parameters::digest(&self.values) != end.digest {
            return Err((Outcome::Incomplete, 0));
        }
        self.axis = None;
        self.mode = Mode::Empty;
        self.axis = Some(Axis::build(&self.values)?);
        self.mode = Mode::Ready;
        Ok(())
    }

    fn unless_running(&self) -> Result<(), (Outcome, u16)> {
        match self.mode {
            Mode::Empty | Mode::Ready => Ok(()),
            Mode::Running | Mode::Safe => Err((Outcome::WrongMode, 0)),
        }
    }

    fn reset(&mut self, whole: bool) {
        self.counts = Counts::default();
        self.waiting = None;
        self.used = None;
        self.watch = Watch::default();
        self.dump = None;
        self.last_estimate = None;
        if whole {
            // In place: a new one would be built on the stack first.
            self.receiver = Receiver::default();
            self.answers.clear();
            self.sequence = 0;
            self.axis = None;
            self.parts = 0;
            self.tick = None;
            self.mode = Mode::Empty;
            self.counts.computer = Bits::RESTARTED;
        } else if let Some(axis) = &mut self.axis {
            axis.restart();
            self.mode = Mode::Ready;
        }
    }

    fn run(&mut self, watchdog_ticks: u16) -> Result<(), (Outcome, u16)> {
        if self.mode != Mode::Ready {
            return Err((Outcome::WrongMode, 0));
        }
        if watchdog_ticks > limits::WATCHDOG_TICKS {
            return Err((Outcome::AboveLimit, limits::WATCHDOG_TICKS));
        }
        let patience = if watchdog_ticks == 0 { limits::WATCHDOG_TICKS } else { watchdog_ticks };
        self.watch = Watch { patience, ..Watch::default() };
        self.mode = Mode::Running;
        Ok(())
    }

    fn stop(&mut self) {
        if matches!(self.mode, Mode::Running | Mode::Safe) {
            self.mode = Mode::Ready;
        }
    }

    fn dump_ring(&mut self) -> Result<(), (Outcome, u16)> {
        if self.mode != Mode::Ready {
            return Err((Outcome::WrongMode, 0));
        }
        self.dump = Some(0);
        Ok(())
    }

    /// A sensor frame waits for the tick, unless a newer one has come before.
    fn keep(&mut self, frame: &Frame, sensor: Sensor) {
        let ahead_of = |last: u16| (1..=u16::MAX / 2).contains(&frame.sequence.wrapping_sub(last));
        let newest = self.waiting.map(|held| held.sequence).or(self.used.map(|(sequence, _)| sequence));
        if newest.is_none_or(ahead_of) {
            self.waiting = Some(Held { sequence: frame.sequence, tick: frame.tick, sensor });
        } else {
            self.counts.stale = self.counts.stale.saturating_add(1);
        }
    }

    /// One period.
    fn tick(&mut self, tick: u32) {
        // The bench asks again when an answer was lost on the way.
        if self.tick == Some(tick)
            && let Some(frame) = &self.last_estimate
        {
            let _ = self.answers.push_back(frame.emit());
            return;
        }
        self.tick = Some(tick);
        self.counts.within_tick = 0;
        let message = match (self.mode, self.axis.is_some()) {
            (Mode::Running | Mode::Safe, true) => self.step(tick),
            _ => self.idle(),
        };
        if tick.is_multiple_of(limits::TELEMETRY_TICKS) {
            let telemetry = self.telemetry();
            self.answer(telemetry);
        }
        self.last_estimate = Some(self.answer(message));
    }

    fn step(&mut self, tick: u32) -> Message {
        let sensor = self.fresh(tick);
        self.watch(sensor.is_some());
        let Some(axis) = &mut self.axis else { return self.idle() };
        let stepped = axis.step(sensor.as_ref());
        self.count(&stepped);
        let estimate = self.estimate(&stepped, tick);
        Message::Estimate(estimate)
    }

    /// The sensor frame that waits, if it is not too old.
    fn fresh(&mut self, tick: u32) -> Option<Sensor> {
        let held = self.waiting.take();
        let fresh = held.filter(|held| tick.wrapping_sub(held.tick) < limits::OLDEST_FRAME_TICKS);
        match (held, fresh) {
            (_, Some(held)) => self.used = Some((held.sequence, held.tick)),
            (Some(held), None) => {
                self.counts.stale = self.counts.stale.saturating_add(1);
                self.used = Some((held.sequence, self.used.map_or(held.tick, |(_, tick)| tick)));
            }
            (None, None) => {}
        }
        if fresh.is_none() {
            self.counts.held = self.counts.held.saturating_add(1);
        }
        fresh.map(|held| held.sensor)
    }

    fn watch(&mut self, fresh: bool) {
        if fresh {
            self.watch.silent = 0;
            self.watch.fresh = self.watch.fresh.saturating_add(1);
        } else {
            self.watch.fresh = 0;
            self.watch.silent = self.watch.silent.saturating_add(1);
        }
        if self.mode == Mode::Running && self.watch.silent >= self.watch.patience {
            self.trip();
        } else if self.mode == Mode::Safe && self.watch.fresh >= limits::RECOVERY_FRAMES {
            self.mode = Mode::Running;
        }
    }

    fn trip(&mut self) {
        self.mode = Mode::Safe;
        self.watch.fresh = 0;
        self.counts.trips = self.counts.trips.saturating_add(1);
        self.counts.computer |= Bits::WATCHDOG_TRIPPED;
    }

    fn count(&mut self, stepped: &Stepped) {
        self.counts.model |= bits(stepped.output.faults);
        self.counts.estimator |= stepped.estimate.flags.bits();
        if stepped.disagrees {
            self.counts.computer |= Bits::MODEL_DISAGREES;
        }
        if self.mode == Mode::Safe {
            self.counts.safe_ticks = self.counts.safe_ticks.saturating_add(1);
        }
    }

    fn estimate(&mut self, stepped: &Stepped, tick: u32) -> Estimate {
        let (mut gimbal_angle_rad, mut bound_rad) =
            (narrow(stepped.estimate.gimbal_angle_rad), narrow(stepped.estimate.bound_rad));
        if self.mode == Mode::Safe {
            (gimbal_angle_rad, bound_rad) = (0.0, limits::SAFE_BOUND_RAD);
        } else if !(-limits::CORRECTION_RAD..=limits::CORRECTION_RAD).contains(&gimbal_angle_rad) {
            let limit = limits::CORRECTION_RAD;
            gimbal_angle_rad = if gimbal_angle_rad > 0.0 { limit } else { -limit };
            self.counts.computer |= Bits::CORRECTION_CLAMPED;
        }
        let (sensor_sequence, age) =
            self.used.map_or((0, u8::MAX), |(sequence, sent)| (sequence, clipped(tick.wrapping_sub(sent))));
        Estimate {
            gimbal_angle_rad,
            bound_rad,
            disturbance_torque_nm: narrow(stepped.estimate.disturbance_torque_nm),
            innovation_rad: narrow(stepped.estimate.innovation_rad),
            modelled_gimbal_angle_rad: narrow(stepped.output.gimbal_angle_rad),
            modelled_gyro_angle_rad: narrow(stepped.output.gyro_angle_rad),
            flags: stepped.estimate.flags.bits(),
            faults: bits(stepped.output.faults),
            sensor_sequence,
            mode: self.mode,
            age,
        }
    }

    /// The answer to a tick while nothing steps: the safe output.
    fn idle(&self) -> Message {
        Message::Estimate(Estimate {
            gimbal_angle_rad: 0.0,
            bound_rad: limits::SAFE_BOUND_RAD,
            disturbance_torque_nm: 0.0,
            innovation_rad: 0.0,
            modelled_gimbal_angle_rad: 0.0,
            modelled_gyro_angle_rad: 0.0,
            flags: 0,
            faults: 0,
            sensor_sequence: 0,
            mode: self.mode,
            age: u8::MAX,
        })
    }

    fn telemetry(&self) -> Message {
        let (velocity, position) = self.axis.as_ref().map_or_else(Default::default, Axis::corrections);
        let link = self.receiver.counts();
        let clip = |count: u32| u16::try_from(count).unwrap_or(u16::MAX);
        Message::Telemetry(Telemetry {
            velocity_correction_mps: velocity.map(narrow),
            position_correction_m: position.map(narrow),
            accepted: link.accepted,
            checksum: clip(link.checksum),
            structure: clip(link.refused() - link.checksum),
            lost: clip(link.lost),
            held: self.counts.held,
            stale: self.counts.stale,
            computer: self.counts.computer,
        })
    }
}

fn clipped(age: u32) -> u8 {
    u8::try_from(age).unwrap_or(u8::MAX)
}
