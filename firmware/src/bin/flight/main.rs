//! The flight computer's program: one minute of simulated flight at 1 kHz, each step in a timer's interrupt.
//!
//! ```text
//! timer, 1 kHz, highest priority      tick.rs      step, deadline, watchdog
//!    asks the sensor for a row          |  ^
//! receive interrupt, lower priority   sensor.rs    puts the row into a queue for the next tick
//!    telemetry queue                    v
//! idle loop                           idle.rs      digest of all outputs, report
//! ```
//!
//! What the core has of its own, timer and interrupts, is in `core_arm.rs` and `core_riscv.rs`. The law comes from an image
//! that the build script made, and nothing here computes with doubles. On the host it prints the digest that every board must reach.

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
fn main() {
    use gimbal_firmware::minute;

    println!("flight f32 {} steps {:016x}", minute::STEPS, minute::digest::<f32>());
    println!("flight fixed {} steps {:016x}", minute::STEPS, minute::digest::<gimbal_servo::Fixed>());
}

#[cfg(target_os = "none")]
mod target {
    use crate::core_of_board::{self, singleton};
    use crate::{idle, sensor, tick, watchdog};
    use gimbal_firmware::minute::Flown;
    use gimbal_servo::{Law, Output};
    use heapless::spsc::Queue;

    pub(crate) type Axis = gimbal_firmware::Native;

    pub(crate) type Rows = Queue<gimbal_servo::Input<Axis>, 4>;
    pub(crate) type Outputs = Queue<Output<Axis>, 8>;

    pub(crate) fn run() -> Result<(), &'static str> {
        const TAKEN: &str = "started twice";
        // In memory of its own: the law is too large to be handed around on the stack.
        let law = singleton!(: Law<Axis> = Law::BLANK).ok_or(TAKEN)?;
        law.read_image(Axis::IMAGE).map_err(|_| "the law's image is not one of this library")?;
        let (row_in, row_out) = singleton!(: Rows = Queue::new()).ok_or(TAKEN)?.split();
        let (output_in, output_out) = singleton!(: Outputs = Queue::new()).ok_or(TAKEN)?.split();

        let tick = tick::Tick::new(law, row_out, output_in, watchdog::Watchdog::start());
        tick::hand_over(singleton!(: Option<tick::Tick> = None).ok_or(TAKEN)?.insert(tick));
        sensor::hand_over(row_in);
        core_of_board::start().ok_or("the board has no timer")?;
        sensor::trigger();
        idle::run(output_out)
    }
}
