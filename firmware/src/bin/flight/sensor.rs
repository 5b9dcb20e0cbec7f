//! The receive interrupt: a row has come in, and waits in a queue for the next tick.
//!
//! On a board of yours this is the interrupt of the serial port or bus that the sensor sits on. Here the tick pends the
//! interrupt, as a sensor that is triggered answers, and the row comes from the committed flight.

// An interrupt's number is a promise to the hardware, and enabling one is too.
#![allow(unsafe_code)]

use crate::target::Axis;
use core::cell::RefCell;
use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::NVIC;
use cortex_m_rt::exception;
use critical_section::Mutex;
use gimbal_firmware::cases::MINUTE;
use gimbal_servo::{Input, Law};
use heapless::spsc::Producer;

/// The first interrupt of the board.
#[derive(Clone, Copy)]
pub(crate) struct Receive;

// SAFETY: every core has an interrupt 0.
unsafe impl InterruptNumber for Receive {
    fn number(self) -> u16 {
        0
    }
}

/// What the interrupt owns.
struct Sensor {
    law: &'static Law<Axis>,
    rows: Producer<'static, Input<Axis>>,
    next: u32,
}

static SENSOR: Mutex<RefCell<Option<Sensor>>> = Mutex::new(RefCell::new(None));

/// Hands the interrupt its end of the queue and enables it.
pub(crate) fn start(law: &'static Law<Axis>, rows: Producer<'static, Input<Axis>>) {
    critical_section::with(|cs| SENSOR.replace(cs, Some(Sensor { law, rows, next: 0 })));
    // SAFETY: no critical section relies on the interrupt being masked.
    unsafe { NVIC::unmask(Receive) };
}

/// Asks the sensor for a row.
pub(crate) fn trigger() {
    NVIC::pend(Receive);
}

/// The interrupts' handler; 0 is the only one enabled.
#[exception]
unsafe fn DefaultHandler(_number: i16) {
    // Taken out and put back, so that the tick waits for neither the row nor the queue.
    let Some(mut sensor) = critical_section::with(|cs| SENSOR.take(cs)) else { return };
    sensor.receive();
    critical_section::with(|cs| SENSOR.replace(cs, Some(sensor)));
}

impl Sensor {
    fn receive(&mut self) {
        // A full queue means that the ticks have stopped; the row waits, and the tick will find one missing.
        if self.next < MINUTE.steps && self.rows.ready() {
            let row = MINUTE.input(self.law, self.next);
            if self.rows.enqueue(row).is_ok() {
                self.next += 1;
            }
        }
    }
}
