//! Counts the instructions of the wire: a frame in, a frame out, and a whole tick of the flight computer.

#![cfg_attr(target_os = "none", no_std, no_main)]

gimbal_firmware::arm_program!(target::run, "wire");

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    use core::hint::black_box;
    use cortex_m::singleton;
    use gimbal_computer::{Computer, parameters};
    use gimbal_firmware::{Native, counter::Counter, frames, semihosting::println};
    use gimbal_servo::{Config, estimator};
    use gimbal_wire::{FRAME_LEN, Frame, LoadEnd, LoadPart, Message, PART_VALUES, Receiver, Run, Sensor};

    const TICKS: u32 = 1_000;

    /// Counts of one kind of work.
    struct Tally {
        sum: u64,
        least: u32,
        most: u32,
    }

    impl Tally {
        const EMPTY: Self = Self { sum: 0, least: u32::MAX, most: 0 };

        fn add(&mut self, count: u32) {
            self.sum += u64::from(count);
            self.least = self.least.min(count);
            self.most = self.most.max(count);
        }

        fn print(&self, name: &str) {
            println!("wire {name} {TICKS} {} {} {}", self.least, self.sum * 1000 / u64::from(TICKS), self.most);
        }
    }

    pub(crate) fn run() -> Result<(), &'static str> {
        let mut counter = Counter::start();
        let computer = singleton!(: Computer<Native> = Computer::new()).ok_or("started twice")?;
        load(computer);
        let (mut receive, mut emit, mut tick) = (Tally::EMPTY, Tally::EMPTY, Tally::EMPTY);
        let mut receiver = Receiver::default();
        for k in 0..TICKS {
            let sensor = frame(k, sensor(k));
            let mut bytes = [0; FRAME_LEN];
            emit.add(counter.count(|| bytes = black_box(sensor).emit()));
            let bytes = black_box(bytes);
            let mut came = None;
            receive.add(counter.count(|| came = frames::receive(&mut receiver, &bytes)));
            if black_box(came).is_none() {
                return Err("a frame is refused");
            }
            let clock = frame(k, Message::Clock).emit();
            tick.add(counter.count(|| {
                computer.receive(&bytes);
                computer.receive(&clock);
            }));
            while let Some(answer) = computer.take() {
                black_box(answer);
            }
        }
        emit.print("emit");
        receive.print("receive");
        tick.print("tick");
        println!("wire size {} {}", size_of::<Computer<Native>>(), size_of::<Receiver>());
        Ok(())
    }

    fn frame(k: u32, message: Message) -> Frame {
        let [low, high, ..] = k.to_le_bytes();
        Frame { sequence: u16::from_le_bytes([low, high]), tick: k, message }
    }

    /// Steady acceleration, theta with a little noise.
    fn sensor(k: u32) -> Message {
        let noise = [0.0, 2e-6, -1e-6, 1e-6, -3e-6, 3e-6, -2e-6][(k % 7) as usize];
        Message::Sensor(Sensor {
            accel_mps2: [0.0, 9.8, 0.1],
            vehicle_rate_radps: 0.05,
            gyro_angle_rad: Some(noise),
            motor_torque_nm: Some(1e-3 + noise),
        })
    }

    fn load(computer: &mut Computer<Native>) {
        let values = parameters::values(&Config::consistent(), &estimator::Config::default());
        for (index, part) in (0..).zip(values.chunks(PART_VALUES)) {
            let mut three = [0.0; PART_VALUES];
            three[..part.len()].copy_from_slice(part);
            computer.receive(&frame(0, Message::LoadPart(LoadPart { index, values: three })).emit());
            computer.take();
        }
        let count = u16::try_from(values.len()).unwrap_or(u16::MAX);
        let end = LoadEnd { count, digest: parameters::digest(&values) };
        computer.receive(&frame(0, Message::LoadEnd(end)).emit());
        computer.take();
        computer.receive(&frame(0, Message::Run(Run { watchdog_ticks: 0 })).emit());
        computer.take();
    }
}
