//! Commands of the bench, and what becomes of each.

use gimbal_servo::Number;
use gimbal_wire::{
    Computer as Bits, Faults, Frame, Identity, LoadEnd, LoadPart, Message, Mode, Outcome, PART_VALUES, Receiver,
};

use super::{Computer, Counts, Watch};
use crate::BUILD;
use crate::axis::Axis;
use crate::limits;
use crate::parameters::{self, COUNT};

/// Why a command is refused, and the parameter that is wrong.
pub(super) type Refused = (Outcome, u16);

impl<N: Number> Computer<N> {
    pub(super) fn introduce(&mut self, frame: &Frame) {
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

    pub(super) fn report(&mut self) {
        let Counts { model, estimator, computer, trips, safe_ticks, ignored, .. } = self.counts;
        self.answer(Message::Faults(Faults { model, estimator, computer, trips, safe_ticks, ignored }));
    }

    pub(super) fn load_part(&mut self, part: &LoadPart) -> Result<(), Refused> {
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

    pub(super) fn load_end(&mut self, end: LoadEnd) -> Result<(), Refused> {
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

    fn unless_running(&self) -> Result<(), Refused> {
        match self.mode {
            Mode::Empty | Mode::Ready => Ok(()),
            Mode::Running | Mode::Safe => Err((Outcome::WrongMode, 0)),
        }
    }

    pub(super) fn reset(&mut self, whole: bool) {
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

    pub(super) fn run(&mut self, watchdog_ticks: u16) -> Result<(), Refused> {
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

    pub(super) fn stop(&mut self) {
        if matches!(self.mode, Mode::Running | Mode::Safe) {
            self.mode = Mode::Ready;
        }
    }

    pub(super) fn dump_ring(&mut self) -> Result<(), Refused> {
        if self.mode != Mode::Ready {
            return Err((Outcome::WrongMode, 0));
        }
        self.dump = Some(0);
        Ok(())
    }
}
