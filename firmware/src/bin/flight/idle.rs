//! The idle loop: telemetry, the log, and the report at the end.

use crate::core_of_board::{self, TIMER_HZ};
use crate::target::Axis;
use crate::tick::{COUNTS, Counts};
use core::sync::atomic::Ordering::Relaxed;
use gimbal_firmware::minute::Seen;
use gimbal_firmware::onboard::Told;
use gimbal_firmware::{board, info, minute, warning};
use gimbal_servo::Faults;
use gimbal_servo::estimator::Flags;
use heapless::spsc::Consumer;

// Time of a log line: the tick.
#[cfg(feature = "defmt")]
gimbal_firmware::log::defmt::timestamp!("{=u32:ms}", COUNTS.ticks.load(Relaxed));

/// Steps between two lines of telemetry.
const TELEMETRY: u32 = 10_000;

/// Takes outputs until the minute is over, sleeping in between; an error if anything was late or lost.
pub(crate) fn run(mut telemetry: Consumer<'static, Told<Axis>>) -> Result<(), &'static str> {
    let mut log = Log { faults: Faults::NONE, flags: Flags::NONE, disagrees: false, missed: 0 };
    let mut seen = Seen::default();
    info!("board {}, {} steps", board::NAME, minute::STEPS);
    while seen.steps < minute::STEPS {
        while let Some(told) = telemetry.dequeue() {
            seen.add(&told);
            log.note(seen.steps, &told);
        }
        if seen.steps < minute::STEPS {
            core_of_board::sleep();
        }
    }
    // Before the lines below take their time: the sensors have no more rows for the ticks that come.
    let Counts { missed, without_row, lost, together, longest, latest, .. } = &COUNTS;
    let [missed, without_row, lost] = [missed, without_row, lost].map(|count| count.load(Relaxed));
    let [together, longest, latest] = [together, longest, latest].map(|count| count.load(Relaxed));
    let number = if cfg!(target_abi = "eabihf") { "f32" } else { "fixed" };
    info!("flight {} {} steps {:016x}", number, seen.steps, seen.digest.value());
    let microseconds = |count: u32| u64::from(count) * 1_000_000 / u64::from(TIMER_HZ);
    let mean = together / minute::STEPS;
    info!(
        "mean tick {} us, longest {} us, latest start {} us",
        microseconds(mean),
        microseconds(longest),
        microseconds(latest)
    );
    info!("deadlines missed {}, ticks without a row {}, outputs lost {}", missed, without_row, lost);
    if missed + without_row + lost == 0 { Ok(()) } else { Err("a contract of the tick was broken") }
}

/// What has been logged.
struct Log {
    faults: Faults,
    flags: Flags,
    disagrees: bool,
    missed: u32,
}

impl Log {
    /// A line where faults or the estimate's lasting flags differ from the last one's, where the monitor disagrees or a deadline
    /// was missed, and now and then.
    fn note(&mut self, step: u32, told: &Told<Axis>) {
        // Others come and go with a single reading.
        const LOGGED: [Flags; 5] =
            [Flags::SATURATED, Flags::OFFSET_HELD, Flags::BOUND_TOO_WIDE, Flags::GYRO_LOST, Flags::OFFSET_DOUBTFUL];
        let Told { output, estimate, report } = told;
        if output.faults != self.faults {
            self.faults = output.faults;
            say!("step {}: faults {}", step, self.faults);
        }
        let other = |flag: &Flags| self.flags.contains(*flag) != estimate.flags.contains(*flag);
        if LOGGED.iter().any(other) {
            say!("step {}: estimate {} +- {}, {}", step, estimate.gimbal_angle_rad, estimate.bound_rad, estimate.flags);
            self.flags = estimate.flags;
        }
        if report.disagrees && !self.disagrees {
            self.disagrees = true;
            say!("step {}: theta is not the model's, residual {}", step, report.residual_rad);
        }
        if step.is_multiple_of(TELEMETRY) {
            say!(
                "step {}: phi {}, theta {}, faults {}; estimate {} +- {}, {}",
                step,
                output.gimbal_angle_rad,
                output.gyro_angle_rad,
                output.faults,
                estimate.gimbal_angle_rad,
                estimate.bound_rad,
                estimate.flags
            );
        }
        let missed = COUNTS.missed.load(Relaxed);
        if missed != self.missed {
            self.missed = missed;
            warning!("step {}: deadlines missed so far: {}", step, missed);
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
