//! A tick: the newest sensor frame, a step of the model, the watchdog.

use gimbal_servo::Number;
use gimbal_wire::{Computer as Bits, Frame, Message, Mode, Sensor};

use super::{Computer, Held};
use crate::axis::{Stepped, bits};
use crate::limits;

impl<N: Number> Computer<N> {
    /// A sensor frame waits for the tick, unless a newer one has come before.
    pub(super) fn keep(&mut self, frame: &Frame, sensor: Sensor) {
        let ahead_of = |last: u16| (1..=u16::MAX / 2).contains(&frame.sequence.wrapping_sub(last));
        let newest = self.waiting.map(|held| held.sequence).or(self.used.map(|(sequence, _)| sequence));
        if newest.is_none_or(ahead_of) {
            self.waiting = Some(Held { sequence: frame.sequence, tick: frame.tick, sensor });
        } else {
            self.counts.stale = self.counts.stale.saturating_add(1);
        }
    }

    /// One period.
    pub(super) fn tick(&mut self, tick: u32) {
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

    pub(super) fn trip(&mut self) {
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
}
