//! The board's side: a running computer between any bytes and any frames. A tick answers, and within the limits; what
//! goes up is frames; and when the bench starts the computer anew, it is as if nothing had been.

#![no_main]

use std::sync::LazyLock;

use gimbal_computer::{Computer, limits, parameters};
use gimbal_fuzz::{body, stuffed};
use gimbal_servo::{Config, estimator};
use gimbal_wire::{Estimate, Frame, LoadEnd, LoadPart, Message, Mode, PART_VALUES, Receiver, Reset, Run, Sensor};
use libfuzzer_sys::fuzz_target;

struct Bench {
    computer: Box<Computer<f32>>,
    receiver: Receiver,
    sequence: u16,
    tick: u32,
}

impl Bench {
    fn started(from: &[Message]) -> Self {
        let mut bench = Self { computer: Box::default(), receiver: Receiver::default(), sequence: 0, tick: 0 };
        bench.start(from);
        bench
    }

    fn start(&mut self, messages: &[Message]) {
        for message in messages {
            self.send(*message);
            self.answers();
        }
        assert_eq!(self.computer.mode(), Mode::Running);
    }

    fn send(&mut self, message: Message) {
        self.sequence = self.sequence.wrapping_add(1);
        self.computer.receive(&Frame { sequence: self.sequence, tick: self.tick, message }.emit());
    }

    /// Every frame that goes up is whole.
    fn answers(&mut self) -> Vec<Frame> {
        let mut frames = Vec::new();
        while let Some(bytes) = self.computer.take() {
            frames.push(bytes.into_iter().find_map(|byte| self.receiver.push(byte)).expect("a frame"));
            assert!(frames.len() < 2_000, "an answer ends");
        }
        frames
    }

    fn tick(&mut self) -> Estimate {
        self.tick = self.tick.wrapping_add(1);
        self.send(Message::Sensor(Sensor {
            accel_mps2: [0.0, 9.8, 0.1],
            vehicle_rate_radps: 0.05,
            gyro_angle_rad: Some(1e-6 * (self.tick % 7) as f32),
            motor_torque_nm: None,
        }));
        self.answers();
        self.send(Message::Clock);
        match self.answers().last().expect("a tick answers").message {
            Message::Estimate(estimate) => estimate,
            other => panic!("{other:?}"),
        }
    }
}

fn model() -> Vec<Message> {
    let values = parameters::values(&Config::consistent(), &estimator::Config::default());
    let parts = (0..).zip(values.chunks(PART_VALUES)).map(|(index, part)| {
        Message::LoadPart(LoadPart { index, values: std::array::from_fn(|k| part.get(k).copied().unwrap_or_default()) })
    });
    let end = LoadEnd { count: values.len() as u16, digest: parameters::digest(&values) };
    let start = [Message::LoadEnd(end), Message::Run(Run { watchdog_ticks: 0 })];
    [Message::Reset(Reset { whole: true })].into_iter().chain(parts).chain(start).collect()
}

static MODEL: LazyLock<Vec<Message>> = LazyLock::new(model);
static FIRST: LazyLock<Estimate> = LazyLock::new(|| Bench::started(&MODEL).tick());

fuzz_target!(|bytes: &[u8]| {
    let mut bench = Bench::started(&MODEL);
    // A tick behind each portion. Its first byte says how long it is, and whether it is bytes of the line or a frame's
    // body, which gets a checksum that fits.
    let mut rest = bytes;
    while let Some((head, after)) = rest.split_first() {
        let (portion, later) = after.split_at(usize::from(head >> 1).min(after.len()));
        rest = later;
        if head & 1 == 0 {
            bench.computer.receive(portion);
        } else {
            bench.computer.receive(&stuffed(&body(portion)));
        }
        bench.answers();
        bench.computer.receive(&[0]);
        bench.answers();
        let estimate = bench.tick();
        assert!(estimate.gimbal_angle_rad.abs() <= limits::CORRECTION_RAD, "{estimate:?}");
        assert!(estimate.bound_rad.is_finite() && estimate.bound_rad >= 0.0, "{estimate:?}");
    }
    // The same tick gets the same reading.
    bench.tick = 0;
    bench.start(&MODEL);
    let first = bench.tick();
    assert_eq!((first.gimbal_angle_rad, first.bound_rad), (FIRST.gimbal_angle_rad, FIRST.bound_rad));
});
