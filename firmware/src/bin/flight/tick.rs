//! The tick.
//!
//! # Timing contract
//!
//! 1. The timer runs at 1 kHz and, on Cortex-M, above every other interrupt: nothing delays the tick but a critical
//!    section, and those are a few instructions long.
//! 2. A tick takes one row from the queue, does one step of the model, of the estimator and of the gap monitor, and puts
//!    what they tell into the telemetry queue. It never waits, and its longest path is bounded: none of the three has an
//!    unbounded loop, both queues are lock-free.
//! 3. Its deadline is the next tick. One that runs into it is counted as missed, and the watchdog is not fed.
//! 4. A tick without a row holds the last one's input, tells the estimator that gyro and motor were not read, and counts it.
//!
//! `cargo xtask test` (stage `target-flight`) holds all four true, on the emulated boards, with a forced overload and with rows left out.

use crate::core_of_board::{TIMER_HZ, next_tick_waits, since_tick};
use crate::sensor;
use crate::target::Axis;
use crate::watchdog::Watchdog;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use critical_section::Mutex;
use gimbal_firmware::onboard::{Onboard, Row, Told};
use gimbal_servo::estimator::Measured;
use heapless::spsc::{Consumer, Producer};

pub(crate) const TICK_HZ: u32 = 1_000;
const PERIOD: u32 = TIMER_HZ / TICK_HZ;

/// What the ticks have counted so far; written by the tick alone.
#[derive(Debug)]
pub(crate) struct Counts {
    /// Ticks so far.
    pub(crate) ticks: AtomicU32,
    /// Ticks that ran into the next one.
    pub(crate) missed: AtomicU32,
    /// Ticks that found no new row.
    pub(crate) without_row: AtomicU32,
    /// Outputs for which the telemetry queue had no room.
    pub(crate) lost: AtomicU32,
    /// Longest tick that met its deadline [counts of the timer].
    pub(crate) longest: AtomicU32,
    /// All ticks that met theirs, together [counts of the timer].
    pub(crate) together: AtomicU32,
    /// Latest start after the timer's zero [counts of the timer].
    pub(crate) latest: AtomicU32,
}

pub(crate) static COUNTS: Counts = Counts {
    ticks: AtomicU32::new(0),
    missed: AtomicU32::new(0),
    without_row: AtomicU32::new(0),
    lost: AtomicU32::new(0),
    longest: AtomicU32::new(0),
    together: AtomicU32::new(0),
    latest: AtomicU32::new(0),
};

/// What the tick owns.
pub(crate) struct Tick {
    onboard: Onboard<'static, Axis>,
    rows: Consumer<'static, Row<Axis>>,
    telemetry: Producer<'static, Told<Axis>>,
    row: Option<Row<Axis>>,
    watchdog: Watchdog,
    number: u32,
}

static TICK: Mutex<RefCell<Option<&'static mut Tick>>> = Mutex::new(RefCell::new(None));

/// Hands the interrupt what it owns.
pub(crate) fn hand_over(tick: &'static mut Tick) {
    critical_section::with(|cs| TICK.replace(cs, Some(tick)));
}

/// The timer's interrupt.
pub(crate) fn tick() {
    let Some(tick) = critical_section::with(|cs| TICK.take(cs)) else { return };
    tick.run();
    critical_section::with(|cs| TICK.replace(cs, Some(tick)));
}

impl Tick {
    pub(crate) fn new(
        onboard: Onboard<'static, Axis>,
        rows: Consumer<'static, Row<Axis>>,
        telemetry: Producer<'static, Told<Axis>>,
        watchdog: Watchdog,
    ) -> Self {
        Self { onboard, rows, telemetry, row: None, watchdog, number: 0 }
    }

    fn run(&mut self) {
        raise(&COUNTS.latest, since_tick());
        let start = since_tick();
        if let Some(row) = self.rows.dequeue() {
            self.row = Some(row);
        } else {
            self.row = self.row.map(|row| Row { measured: Measured::default(), ..row });
            add_one(&COUNTS.without_row);
        }
        // Until the first row has come there is nothing to step with.
        if let Some(row) = &self.row {
            let told = self.onboard.step(row);
            if self.telemetry.enqueue(told).is_err() {
                add_one(&COUNTS.lost);
            }
        }
        if !self.forgets() {
            sensor::trigger();
        }
        self.number += 1;
        COUNTS.ticks.store(self.number, Relaxed);
        self.overload();

        if next_tick_waits() {
            add_one(&COUNTS.missed);
        } else {
            let took = since_tick() - start;
            raise(&COUNTS.longest, took);
            COUNTS.together.store(COUNTS.together.load(Relaxed).saturating_add(took), Relaxed);
            self.watchdog.feed();
        }
    }

    /// Whether it does not ask the sensors, on purpose and three times, to show what happens then.
    fn forgets(&self) -> bool {
        cfg!(feature = "no-rows") && (1_000..1_003).contains(&self.number)
    }

    /// Takes too long on purpose, to show what happens then: ten ticks of one period and a half, or all from the 1,000th.
    fn overload(&self) {
        const FIRST: u32 = 1_000;
        let too_long = (cfg!(feature = "overload") && (FIRST..FIRST + 10).contains(&self.number))
            || (cfg!(feature = "hang") && self.number >= FIRST);
        if too_long {
            let (mut last, mut passed) = (since_tick(), 0);
            while passed < PERIOD + PERIOD / 2 {
                let now = since_tick();
                // On Cortex-M the timer starts again while the tick goes on.
                passed += if now >= last { now - last } else { now + PERIOD - last };
                last = now;
            }
        }
    }
}

/// Load and store, for Armv6-M has no more: the tick is the only writer.
fn add_one(count: &AtomicU32) {
    count.store(count.load(Relaxed) + 1, Relaxed);
}

fn raise(largest: &AtomicU32, value: u32) {
    largest.store(largest.load(Relaxed).max(value), Relaxed);
}
