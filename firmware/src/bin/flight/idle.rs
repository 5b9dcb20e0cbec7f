//! The idle loop: telemetry, and the report at the end.

use crate::target::Axis;
use crate::tick::COUNTS;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use gimbal_firmware::cases::MINUTE;
use gimbal_firmware::{board, semihosting::println};
use gimbal_servo::{Digest, Output};
use heapless::spsc::Consumer;

/// Takes outputs until the minute is over, sleeping in between; an error if anything was late or lost.
pub(crate) fn run(mut outputs: Consumer<'static, Output<Axis>>) -> Result<(), &'static str> {
    let mut digest = Digest::default();
    let mut steps = 0;
    while steps < MINUTE.steps {
        while let Some(output) = outputs.dequeue() {
            digest.add_output(&output);
            steps += 1;
        }
        if steps < MINUTE.steps {
            cortex_m::asm::wfi();
        }
    }
    let number = if cfg!(target_abi = "eabihf") { "f32" } else { "fixed" };
    println!("flight {number} {steps} steps {:016x}", digest.value());
    let microseconds = |count: &AtomicU32| u64::from(count.load(Relaxed)) * 1_000_000 / u64::from(board::COUNTER_HZ);
    let (longest, latest) = (microseconds(&COUNTS.longest), microseconds(&COUNTS.latest));
    println!("longest tick {longest} us, latest start {latest} us");
    let [missed, lost] = [&COUNTS.missed, &COUNTS.lost].map(|count| count.load(Relaxed));
    let without_row = COUNTS.without_row.load(Relaxed);
    println!("deadlines missed {missed}, ticks without a row {without_row}, outputs lost {lost}");
    if missed + without_row + lost == 0 { Ok(()) } else { Err("a contract of the tick was broken") }
}
