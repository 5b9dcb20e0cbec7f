//! The flight computer's program: one minute of simulated flight at 1 kHz, each step in a timer's interrupt.
//!
//! ```text
//! timer, 1 kHz, highest priority      tick.rs      model, estimator, gap monitor; deadline, watchdog
//!    asks the sensor for a row          |  ^
//! receive interrupt, lower priority   sensor.rs    puts the row into a queue for the next tick
//!    telemetry queue                    v
//! idle loop                           idle.rs      telemetry, digest of all outputs, report
//! ```
//!
//! What the core has of its own, timer and interrupts, is in `core_arm.rs` and `core_riscv.rs`. The laws come from images
//! that the build script made, and nothing here computes with doubles. On the host it prints the digest that every board
//! must reach.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg_attr(target_arch = "arm", path = "core_arm.rs")]
#[cfg_attr(target_arch = "riscv32", path = "core_riscv.rs")]
#[cfg(target_os = "none")]
mod core_of_board;
#[cfg(target_os = "none")]
mod idle;
#[cfg(target_os = "none")]
mod sensor;
#[cfg(target_os = "none")]
mod tick;
#[cfg(target_os = "none")]
mod watchdog;

#[cfg(target_os = "none")]
gimbal_firmware::program!(target::run);

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    use gimbal_firmware::minute::{self, Flown};
    use gimbal_servo::estimator::Flags;

    fn tell<N: Flown>(number: &str) -> Result<(), Box<dyn std::error::Error>> {
        const SHOWN: [Flags; 5] =
            [Flags::SATURATED, Flags::OFFSET_HELD, Flags::SETTLING, Flags::GYRO_MISSING, Flags::TORQUE_MISSING];
        let seen = minute::seen::<N>()?;
        println!("flight {number} {} steps {:016x}", seen.steps, seen.digest.value());
        eprintln!("{number}: {:?}, monitor disagrees: {}", seen.flags, seen.disagrees);
        if SHOWN.iter().all(|flag| seen.flags.contains(*flag)) && !seen.disagrees {
            Ok(())
        } else {
            Err(format!("{number}: the minute no longer shows what it is to show: {SHOWN:?}, no disagreement").into())
        }
    }
    tell::<f32>("f32")?;
    tell::<gimbal_servo::Fixed>("fixed")
}

#[cfg(target_os = "none")]
mod target {
    use crate::core_of_board::{self, singleton};
    use crate::{idle, sensor, tick, watchdog};
    use gimbal_firmware::onboard::{Laws, Row, Told};
    use heapless::spsc::Queue;

    pub(crate) type Axis = gimbal_firmware::Native;

    pub(crate) type Rows = Queue<Row<Axis>, 4>;
    pub(crate) type Telemetry = Queue<Told<Axis>, 8>;

    pub(crate) fn run() -> Result<(), &'static str> {
        const TAKEN: &str = "started twice";
        // In memory of their own: the laws are too large to be handed around on the stack.
        let laws = singleton!(: Laws<Axis> = Laws::BLANK).ok_or(TAKEN)?;
        laws.read_images().map_err(|_| "a law's image is not one of this library")?;
        let (row_in, row_out) = singleton!(: Rows = Queue::new()).ok_or(TAKEN)?.split();
        let (told_in, told_out) = singleton!(: Telemetry = Queue::new()).ok_or(TAKEN)?.split();

        let tick = tick::Tick::new(laws.start(), row_out, told_in, watchdog::Watchdog::start());
        tick::hand_over(singleton!(: Option<tick::Tick> = None).ok_or(TAKEN)?.insert(tick));
        sensor::hand_over(row_in);
        core_of_board::start().ok_or("the board has no timer")?;
        sensor::trigger();
        idle::run(told_out)
    }
}
