//! A computer and someone who talks to it.

#![allow(dead_code, reason = "no test file uses all of it")]

use gimbal_computer::{Computer, parameters};
use gimbal_servo::{Config, estimator};
use gimbal_wire::{Ack, Estimate, Faults, Frame, LoadEnd, LoadPart, Message, Outcome, Receiver, Run, Sensor};

/// A bench that counts its frames.
pub(crate) struct Bench {
    pub(crate) computer: Computer<f32>,
    pub(crate) receiver: Receiver,
    pub(crate) sequence: u16,
    pub(crate) tick: u32,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self { computer: Computer::new(), receiver: Receiver::default(), sequence: 0, tick: 0 }
    }

    pub(crate) fn send(&mut self, message: Message) {
        self.sequence = self.sequence.wrapping_add(1);
        let frame = Frame { sequence: self.sequence, tick: self.tick, message };
        self.computer.receive(&frame.emit());
    }

    pub(crate) fn answers(&mut self) -> Vec<Message> {
        let mut messages = Vec::new();
        while let Some(frame) = self.computer.take() {
            messages.extend(frame.into_iter().filter_map(|byte| self.receiver.push(byte)).map(|frame| frame.message));
        }
        messages
    }

    pub(crate) fn ask(&mut self, message: Message) -> Message {
        self.send(message);
        let answers = self.answers();
        assert_eq!(answers.len(), 1, "{answers:?}");
        answers[0]
    }

    pub(crate) fn command(&mut self, message: Message) -> Ack {
        match self.ask(message) {
            Message::Ack(ack) => ack,
            other => panic!("{other:?}"),
        }
    }

    pub(crate) fn load(&mut self, axis: &Config, estimator: &estimator::Config) -> Ack {
        self.load_values(&parameters::values(axis, estimator))
    }

    pub(crate) fn load_values(&mut self, values: &parameters::Values) -> Ack {
        for (index, part) in values.chunks(3).enumerate() {
            let mut three = [0.0; 3];
            three[..part.len()].copy_from_slice(part);
            let index = u16::try_from(index).expect("few");
            assert_eq!(self.command(Message::LoadPart(LoadPart { index, values: three })).outcome, Outcome::Done);
        }
        let count = u16::try_from(values.len()).expect("few");
        self.command(Message::LoadEnd(LoadEnd { count, digest: parameters::digest(values) }))
    }

    pub(crate) fn started() -> Self {
        let mut bench = Self::new();
        assert_eq!(bench.load(&Config::consistent(), &estimator::Config::default()).outcome, Outcome::Done);
        assert_eq!(bench.command(Message::Run(Run { watchdog_ticks: 0 })).outcome, Outcome::Done);
        bench
    }

    pub(crate) fn clock(&mut self) -> Estimate {
        self.tick += 1;
        self.send(Message::Clock);
        match self.answers().last() {
            Some(Message::Estimate(estimate)) => *estimate,
            other => panic!("{other:?}"),
        }
    }

    pub(crate) fn step(&mut self, gyro_angle_rad: f32) -> Estimate {
        self.tick += 1;
        self.send(sensor(gyro_angle_rad));
        self.tick -= 1;
        self.clock()
    }

    pub(crate) fn faults(&mut self) -> Faults {
        match self.ask(Message::ReadFaults) {
            Message::Faults(faults) => faults,
            other => panic!("{other:?}"),
        }
    }
}

pub(crate) fn sensor(gyro_angle_rad: f32) -> Message {
    Message::Sensor(Sensor {
        accel_mps2: [0.0, 9.8, 0.0],
        vehicle_rate_radps: 0.05,
        gyro_angle_rad: Some(gyro_angle_rad),
        motor_torque_nm: Some(1e-3 + gyro_angle_rad),
    })
}

/// theta that never repeats, as a noisy sensor's.
pub(crate) fn wobble(k: u32) -> f32 {
    1e-5 * ((k % 7) as f32 - 3.0)
}
