//! The idle loop: telemetry, the log, and the report at the end.

use crate::core_of_board::{self, TIMER_HZ};
use crate::target::Axis;
use crate::tick::COUNTS;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use gimbal_firmware::{board, info, minute, warning};
use gimbal_servo::{Digest, Faults, Output};
use heapless::spsc::Consumer;

// Time of a log line: the tick.
#[cfg(feature = "defmt")]
gimbal_firmware::log::defmt::timestamp!("{=u32:ms}", COUNTS.ticks.load(Relaxed));

/// Steps between two lines of telemetry.
const TELEMETRY: u32 = 10_000;

/// Takes outputs until the minute is over, sleeping in between; an error if anything was late or lost.
pub(crate) fn run(mut outputs: Consumer<'static, Output<Axis>>) -> Result<(), &'static str> {
    let mut log = Log { steps: 0, faults: Faults::NONE, missed: 0 };
    let mut digest = Digest::default();
    info!("board {}, {} steps", board::NAME, minute::STEPS);
    while log.steps < minute::STEPS {
        while let Some(output) = outputs.dequeue() {
            digest.add_output(&output);
            log.note(&output);
        }
        if log.steps < minute::STEPS {
            core_of_board::sleep();
        }
    }
    let number = if cfg!(target_abi = "eabihf") { "f32" } else { "fixed" };
    info!("flight {} {} steps {:016x}", number, log.steps, digest.value());
    let microseconds = |count: &AtomicU32| u64::from(count.load(Relaxed)) * 1_000_000 / u64::from(TIMER_HZ);
    info!("longest tick {} us, latest start {} us", microseconds(&COUNTS.longest), microseconds(&COUNTS.latest));
    let [missed, lost] = [&COUNTS.missed, &COUNTS.lost].map(|count| count.load(Relaxed));
    let without_row = COUNTS.without_row.load(Relaxed);
    info!("deadlines missed {}, ticks without a row {}, outputs lost {}", missed, without_row, lost);
    if missed + without_row + lost == 0 { Ok(()) } else { Err("a contract of the tick was broken") }
}

/// What has been logged.
struct Log {
    steps: u32,
    faults: Faults,
    missed: u32,
}

impl Log {
    /// One output: a line when its faults differ from the last one's, when a deadline was missed, and now and then.
    fn note(&mut self, output: &Output<Axis>) {
        self.steps += 1;
        if output.faults != self.faults {
            self.faults = output.faults;
            say!("step {}: faults {}", self.steps, self.faults);
        }
        if self.steps.is_multiple_of(TELEMETRY) {
            say!(
                "step {}: phi {}, theta {}, faults {}",
                self.steps,
                output.gimbal_angle_rad,
                output.gyro_angle_rad,
                output.faults
            );
        }
        let missed = COUNTS.missed.load(Relaxed);
        if missed != self.missed {
            self.missed = missed;
            warning!("deadlines missed so far: {}", missed);
        }
    }
}

/// A line whose values `core::fmt` shows with `{:?}` and defmt with `{}`; text takes code and time, so it is left out
/// where there is no defmt.
#[cfg(feature = "defmt")]
macro_rules! say {
    ($($part:tt)*) => { gimbal_firmware::info!($($part)*) };
}
#[cfg(not(feature = "defmt"))]
macro_rules! say {
    ($format:literal $(, $value:expr)*) => { $( let _ = $value; )* };
}
use say;
