//! The receive interrupt: a row has come in, and waits in a queue for the next tick.
//!
//! The sensors answer on a synchronous serial port, the `PL022` (Arm DDI 0194), where the board file names one: sixteen
//! words of 16 bits make a row, twice what the port's FIFO holds, and half a FIFO raises its receive interrupt. The tick
//! sends the first eight words, and the interrupt another for each that has come. The sensors themselves are played by
//! the port's own loopback: what is sent is what asked sensors would send. On a board of yours loopback is off, and the
//! words sent are those that make the sensors answer. Boards without such a port pend an interrupt instead, and the words
//! stay in memory.
//!
//! | word | content |
//! |---|---|
//! | 0-13 | acceleration along x, y, z, vehicle rate, external torque, theta, motor torque, as the laws take them; of each the lower half first |
//! | 14 | whether theta and the motor torque have been read |
//! | 15 | sum of all before: a row that does not fit it is thrown away, and the tick finds none |

// Registers of a peripheral are addresses.
#![allow(unsafe_code)]

use crate::core_of_board;
use crate::target::Axis;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use critical_section::Mutex;
use gimbal_firmware::minute::{self, SIGNALS, Sent};
use gimbal_firmware::{board, onboard::Row};
use gimbal_servo::Number;
use heapless::spsc::Producer;

/// What the interrupt owns.
struct Sensor {
    rows: Producer<'static, Row<Axis>>,
    next: u32,
    /// What has come in of the row, and how many words.
    words: [u16; WORDS],
    received: usize,
}

/// Of 16 bits, a row's.
const WORDS: usize = 16;
/// Words that the port holds.
const FIFO: usize = 8;

static SENSOR: Mutex<RefCell<Option<Sensor>>> = Mutex::new(RefCell::new(None));

/// The sensors' next answer, two words in each. Written by the interrupt, sent by the tick and the interrupt.
static ANSWER: [AtomicU32; WORDS / 2] = [const { AtomicU32::new(0) }; WORDS / 2];

/// Hands the interrupt its end of the queue.
pub(crate) fn hand_over(rows: Producer<'static, Row<Axis>>) {
    Sensor::answer(0);
    critical_section::with(|cs| SENSOR.replace(cs, Some(Sensor { rows, next: 0, words: [0; WORDS], received: 0 })));
    port::start();
}

/// Asks the sensors for a row.
pub(crate) fn trigger() {
    if board::SENSOR.is_none() {
        core_of_board::pend_receive();
        return;
    }
    // In one piece: the interrupt sends what follows.
    critical_section::with(|_| (0..FIFO).for_each(|index| port::send(answer(index))));
}

/// A word of the sensors' answer.
fn answer(index: usize) -> u16 {
    let [lower, upper] = halves(ANSWER[index / 2].load(Relaxed));
    if index.is_multiple_of(2) { lower } else { upper }
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
    /// Takes what has come in; the interrupt comes with half a FIFO, and again with the next half.
    fn receive(&mut self) {
        while self.received < WORDS {
            let next = if board::SENSOR.is_none() { Some(answer(self.received)) } else { port::receive() };
            let Some(word) = next else { return };
            self.words[self.received] = word;
            self.received += 1;
            let following = self.received + FIFO - 1;
            if board::SENSOR.is_some() && following < WORDS {
                port::send(answer(following));
            }
        }
        self.received = 0;
        // A full queue means that the ticks have stopped; the row is lost, and the tick will find one missing.
        if let Some(sent) = parse(&self.words)
            && self.next < minute::STEPS
            && self.rows.enqueue(minute::row(&sent)).is_ok()
        {
            self.next += 1;
            Self::answer(self.next);
        }
    }

    /// Prepares row `k` of the committed minute.
    fn answer(k: u32) {
        let Sent { signals, there } = minute::sent::<Axis>(k);
        let mut sum = there;
        for (answer, signal) in ANSWER.iter().zip(signals) {
            let bits = Number::to_bits(signal);
            sum = halves(bits).into_iter().fold(sum, u16::wrapping_add);
            answer.store(bits, Relaxed);
        }
        ANSWER[SIGNALS].store(u32::from(there) | u32::from(sum) << 16, Relaxed);
    }
}

/// A row whose sum fits.
fn parse(words: &[u16; WORDS]) -> Option<Sent<Axis>> {
    let [signals @ .., there, sum] = words;
    if signals.iter().fold(*there, |sum, word| sum.wrapping_add(*word)) != *sum {
        return None;
    }
    let signal = |i: usize| u32::from(signals[2 * i]) | u32::from(signals[2 * i + 1]) << 16;
    Some(Sent { signals: core::array::from_fn(|i| <Axis as Number>::from_bits(signal(i))), there: *there })
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
