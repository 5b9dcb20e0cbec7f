//! The tick.
//!
//! # Timing contract
//!
//! 1. `SysTick` runs at 1 kHz and above every other interrupt: nothing delays the tick but a critical section, and those
//!    are a few instructions long.
//! 2. A tick takes one row from the queue, does one step and puts one output into the telemetry queue. It never waits,
//!    and its longest path is bounded: the step has no unbounded loop, both queues are lock-free.
//! 3. Its deadline is the next tick. One that runs into it is counted as missed, and the watchdog is not fed.
//! 4. A tick without a row repeats the last one, and counts it.
//!
//! `cargo xtask test` (stage `target-flight`) holds all four true, on the emulated boards and with a forced overload.

// Priorities are part of the contract; setting them may break a critical section that relies on them, and none does.
#![allow(unsafe_code)]

use crate::sensor;
use crate::target::Axis;
use crate::watchdog::Watchdog;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m::Peripherals;
use cortex_m::peripheral::scb::SystemHandler;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use cortex_m_rt::exception;
use critical_section::Mutex;
use gimbal_firmware::board::COUNTER_HZ;
use gimbal_servo::{Input, Law, Output, State};
use heapless::spsc::{Consumer, Producer};

const TICK_HZ: u32 = 1_000;
const RELOAD: u32 = COUNTER_HZ / TICK_HZ - 1;

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
    /// Longest tick that met its deadline [counts of `SysTick`].
    pub(crate) longest: AtomicU32,
    /// Latest start after the timer's zero [counts of `SysTick`].
    pub(crate) latest: AtomicU32,
}

pub(crate) static COUNTS: Counts = Counts {
    ticks: AtomicU32::new(0),
    missed: AtomicU32::new(0),
    without_row: AtomicU32::new(0),
    lost: AtomicU32::new(0),
    longest: AtomicU32::new(0),
    latest: AtomicU32::new(0),
};

/// What the tick owns.
struct Tick {
    law: &'static Law<Axis>,
    state: State<Axis>,
    rows: Consumer<'static, Input<Axis>>,
    outputs: Producer<'static, Output<Axis>>,
    row: Option<Input<Axis>>,
    watchdog: Watchdog,
    number: u32,
}

static TICK: Mutex<RefCell<Option<Tick>>> = Mutex::new(RefCell::new(None));

/// Hands the tick what it owns and starts the timer.
pub(crate) fn start(
    law: &'static Law<Axis>,
    rows: Consumer<'static, Input<Axis>>,
    outputs: Producer<'static, Output<Axis>>,
    watchdog: Watchdog,
    mut peripherals: Peripherals,
) {
    let tick = Tick { law, state: law.start(), rows, outputs, row: None, watchdog, number: 0 };
    critical_section::with(|cs| TICK.replace(cs, Some(tick)));
    // SAFETY: no critical section relies on a priority.
    unsafe { peripherals.SCB.set_priority(SystemHandler::SysTick, 0) };
    // SAFETY: the same; only interrupt 0 is used, and the tick is above it.
    unsafe { peripherals.NVIC.set_priority(sensor::Receive, 0x80) };
    let mut timer = peripherals.SYST;
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(RELOAD);
    timer.clear_current();
    timer.enable_counter();
    timer.enable_interrupt();
    sensor::trigger();
}

#[exception]
fn SysTick() {
    static mut OWNED: Option<Tick> = None;
    if OWNED.is_none() {
        *OWNED = critical_section::with(|cs| TICK.take(cs));
    }
    if let Some(tick) = OWNED {
        tick.run();
    }
}

impl Tick {
    fn run(&mut self) {
        let start = SYST::get_current();
        // The first tick has just taken over what it owns, which the others need not.
        if self.number > 0 {
            raise(&COUNTS.latest, RELOAD - start);
        }
        match self.rows.dequeue() {
            Some(row) => self.row = Some(row),
            None => add_one(&COUNTS.without_row),
        }
        // Until the first row has come there is nothing to step with.
        if let Some(row) = self.row {
            let output = self.law.step(&mut self.state, row);
            if self.outputs.enqueue(output).is_err() {
                add_one(&COUNTS.lost);
            }
        }
        sensor::trigger();
        self.number += 1;
        COUNTS.ticks.store(self.number, Relaxed);
        self.overload();

        // The timer has passed zero again: the next tick already waits.
        if SCB::is_pendst_pending() {
            add_one(&COUNTS.missed);
        } else {
            raise(&COUNTS.longest, start - SYST::get_current());
            self.watchdog.feed();
        }
    }

    /// Takes too long on purpose, to show what happens then: ten ticks of one period and a half, or all from the 1,000th.
    fn overload(&self) {
        const FIRST: u32 = 1_000;
        let too_long = (cfg!(feature = "overload") && (FIRST..FIRST + 10).contains(&self.number))
            || (cfg!(feature = "hang") && self.number >= FIRST);
        if too_long {
            let mut last = SYST::get_current();
            let mut passed = 0;
            while passed < RELOAD + RELOAD / 2 {
                let now = SYST::get_current();
                passed += if now <= last { last - now } else { last + RELOAD + 1 - now };
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
