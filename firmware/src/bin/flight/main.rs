//! The flight computer's program: one minute of simulated flight at 1 kHz, each step in a timer's interrupt.
//!
//! ```text
//! SysTick, 1 kHz, highest priority    tick.rs      step, deadline, watchdog
//!    asks the sensor for a row          |  ^
//! receive interrupt, lower priority   sensor.rs    puts the row into a queue for the next tick
//!    telemetry queue                    v
//! idle loop                           idle.rs      digest of all outputs, report
//! ```
//!
//! On the host it prints the digest that every board must reach.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod idle;
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod sensor;
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod tick;
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod watchdog;

#[cfg(all(target_os = "none", target_arch = "arm"))]
gimbal_firmware::program!(target::run);

/// The interrupts are those of Cortex-M.
#[cfg(all(target_os = "none", not(target_arch = "arm")))]
mod elsewhere {
    gimbal_firmware::program!(run);

    fn run() -> Result<(), &'static str> {
        Err("flight runs on Cortex-M alone")
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    use gimbal_firmware::cases::MINUTE;

    println!("flight f32 {} steps {:016x}", MINUTE.steps, MINUTE.output_digest::<f32>());
    println!("flight fixed {} steps {:016x}", MINUTE.steps, MINUTE.output_digest::<gimbal_servo::Fixed>());
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    use crate::{idle, sensor, tick, watchdog};
    use cortex_m::Peripherals;
    use cortex_m::singleton;
    use gimbal_firmware::cases::MINUTE;
    use gimbal_servo::{Law, Output};
    use heapless::spsc::Queue;

    pub(crate) type Axis = gimbal_firmware::Native;

    pub(crate) type Rows = Queue<gimbal_servo::Input<Axis>, 4>;
    pub(crate) type Outputs = Queue<Output<Axis>, 8>;

    pub(crate) fn run() -> Result<(), &'static str> {
        const TAKEN: &str = "started twice";
        let peripherals = Peripherals::take().ok_or(TAKEN)?;
        // In memory of its own: the law is too large to be handed around on the stack.
        let built = singleton!(: Option<Law<Axis>> = None).ok_or(TAKEN)?;
        *built = (MINUTE.config)().build::<Axis>().ok();
        let law: &'static Law<Axis> = built.as_ref().ok_or("the law cannot be built")?;
        let (row_in, row_out) = singleton!(: Rows = Queue::new()).ok_or(TAKEN)?.split();
        let (output_in, output_out) = singleton!(: Outputs = Queue::new()).ok_or(TAKEN)?.split();

        sensor::start(law, row_in);
        tick::start(law, row_out, output_in, watchdog::Watchdog::start(), peripherals);
        idle::run(output_out)
    }
}
