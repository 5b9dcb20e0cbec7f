//! The main loop of the examples of the 1 kHz call.

use crate::cases::FLIGHT;
use crate::semihosting::println;
use gimbal_servo::{Digest, Output};
use heapless::spsc::Consumer;

/// Takes the outputs of the flight as the tick makes them, asleep in between; prints their number and digest.
pub fn listen(telemetry: &mut Consumer<'_, Output<f32>>) {
    let (mut digest, mut steps) = (Digest::default(), 0);
    while steps < FLIGHT.steps {
        if let Some(output) = telemetry.dequeue() {
            digest.add_output(&output);
            steps += 1;
        } else {
            cortex_m::asm::wfi();
        }
    }
    println!("tick f32 {steps} steps {:016x}", digest.value());
}
