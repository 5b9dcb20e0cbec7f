//! The receive interrupt: a row has come in, and waits in a queue for the next tick.
//!
//! The sensor answers on a synchronous serial port, the `PL022` (Arm DDI 0194), where the board file names one:
//! eight words of 16 bits make a row, the port's whole FIFO, and half of them raise its receive interrupt. The sensor
//! itself is played by the port's own loopback: the tick sends the eight words that an asked sensor would send. On a
//! board of yours loopback is off, and the tick sends what makes the sensor answer. Boards without such a port pend
//! an interrupt instead, and the words stay in memory.

// Registers of a peripheral are addresses.
#![allow(unsafe_code)]

use crate::core_of_board;
use crate::target::Axis;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use critical_section::Mutex;
use gimbal_firmware::{board, minute};
use gimbal_servo::{Input, Number};
use heapless::spsc::Producer;

/// What the interrupt owns.
struct Sensor {
    rows: Producer<'static, Input<Axis>>,
    next: u32,
    /// What has come in of the row, in halves of its signals, and how many.
    words: [u16; WORDS],
    received: usize,
}

/// Of 16 bits, a row's.
const WORDS: usize = 8;

static SENSOR: Mutex<RefCell<Option<Sensor>>> = Mutex::new(RefCell::new(None));

/// The sensor's next answer: acceleration along x, y and z, and the rate, as the law's signals. Written by the interrupt,
/// sent by the tick.
static ANSWER: [AtomicU32; 4] = [const { AtomicU32::new(0) }; 4];

/// Hands the interrupt its end of the queue.
pub(crate) fn hand_over(rows: Producer<'static, Input<Axis>>) {
    Sensor::answer(0);
    critical_section::with(|cs| SENSOR.replace(cs, Some(Sensor { rows, next: 0, words: [0; WORDS], received: 0 })));
    port::start();
}

/// Asks the sensor for a row.
pub(crate) fn trigger() {
    for word in answer() {
        port::send(word);
    }
    if board::SENSOR.is_none() {
        core_of_board::pend_receive();
    }
}

/// The sensor's answer as it goes over the port: of each signal the lower half first.
fn answer() -> [u16; WORDS] {
    let [x, y, z, rate] = ANSWER.each_ref().map(|signal| halves(signal.load(Relaxed)));
    [x[0], x[1], y[0], y[1], z[0], z[1], rate[0], rate[1]]
}

fn halves(bits: u32) -> [u16; 2] {
    let [a, b, c, d] = bits.to_le_bytes();
    [u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d])]
}

/// The interrupt.
pub(crate) fn receive() {
    // Taken out and put back, so that the tick waits for neither the row nor the queue.
    let Some(mut sensor) = critical_section::with(|cs| SENSOR.take(cs)) else { return };
    sensor.receive();
    critical_section::with(|cs| SENSOR.replace(cs, Some(sensor)));
}

impl Sensor {
    /// Takes what has come in; the interrupt comes with half a row, and again with the other half.
    fn receive(&mut self) {
        if board::SENSOR.is_none() {
            (self.words, self.received) = (answer(), WORDS);
        }
        while self.received < WORDS {
            let Some(word) = port::receive() else { return };
            self.words[self.received] = word;
            self.received += 1;
        }
        self.received = 0;
        let [x0, x1, y0, y1, z0, z1, rate0, rate1] = self.words;
        let signal = |low: u16, high: u16| <Axis as Number>::from_bits(u32::from(low) | u32::from(high) << 16);
        let row = minute::row([signal(x0, x1), signal(y0, y1), signal(z0, z1), signal(rate0, rate1)]);
        // A full queue means that the ticks have stopped; the row is lost, and the tick will find one missing.
        if self.next < minute::STEPS && self.rows.enqueue(row).is_ok() {
            self.next += 1;
            Self::answer(self.next);
        }
    }

    /// Prepares row `k` of the committed flight.
    fn answer(k: u32) {
        for (answer, signal) in ANSWER.iter().zip(minute::signals::<Axis>(k)) {
            answer.store(Number::to_bits(signal), Relaxed);
        }
    }
}

/// Registers of the PL022.
mod port {
    use gimbal_firmware::board;

    const CONTROL_0: u32 = 0x000;
    const CONTROL_1: u32 = 0x004;
    const DATA: u32 = 0x008;
    const STATUS: u32 = 0x00C;
    const PRESCALE: u32 = 0x010;
    const INTERRUPTS: u32 = 0x014;
    /// Words of 16 bits.
    const SIXTEEN_BITS: u32 = 15;
    const LOOPBACK: u32 = 1;
    const ENABLE: u32 = 1 << 1;
    /// The receive FIFO is not empty.
    const RECEIVED: u32 = 1 << 2;
    /// The receive FIFO is half full or more.
    const RECEIVE_INTERRUPT: u32 = 1 << 2;

    pub(super) fn start() {
        write(PRESCALE, 2);
        write(CONTROL_0, SIXTEEN_BITS);
        write(CONTROL_1, LOOPBACK | ENABLE);
        write(INTERRUPTS, RECEIVE_INTERRUPT);
    }

    pub(super) fn send(word: u16) {
        write(DATA, word.into());
    }

    /// A word that has come in.
    pub(super) fn receive() -> Option<u16> {
        if read(STATUS)? & RECEIVED == 0 { None } else { u16::try_from(read(DATA)? & 0xFFFF).ok() }
    }

    fn write(register: u32, value: u32) {
        if let Some((base, _)) = board::SENSOR {
            // SAFETY: the board's file gives the address of this peripheral, and nothing else uses it.
            unsafe { ((base + register) as *mut u32).write_volatile(value) };
        }
    }

    fn read(register: u32) -> Option<u32> {
        // SAFETY: as above.
        board::SENSOR.map(|(base, _)| unsafe { ((base + register) as *const u32).read_volatile() })
    }
}
