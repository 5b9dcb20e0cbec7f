//! The last seconds before an alarm, for the diagnosis on the ground.

use core::num::NonZeroU32;

use heapless::Deque;

use crate::number::Number;
use crate::signals::{Input, Output};

/// One row kept, in the full scales of the axis' units and of the estimator's theta.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record<N> {
    /// Number of the row since the recorder was made; wraps.
    pub row: u32,
    /// theta as measured [rad]; `None` where it was missing.
    pub measured_gyro_angle_rad: Option<N>,
    /// theta as modelled [rad].
    pub modelled_gyro_angle_rad: N,
    /// The row's inputs.
    pub input: Input<N>,
}

/// A ring of the last `ROWS` rows kept, one row in every few; it stops at the first alarm.
#[derive(Debug)]
pub struct Recorder<N: Number, const ROWS: usize> {
    ring: Deque<Record<N>, ROWS>,
    every: NonZeroU32,
    row: u32,
    stopped: bool,
}

impl<N: Number, const ROWS: usize> Recorder<N, ROWS> {
    /// An empty ring that keeps one row in `every`; 0 counts as 1.
    #[must_use]
    pub fn new(every: u32) -> Self {
        Self { ring: Deque::new(), every: NonZeroU32::new(every).unwrap_or(NonZeroU32::MIN), row: 0, stopped: false }
    }

    /// Takes a row; `alarm` stops the ring.
    pub fn record(&mut self, measured: Option<N>, input: &Input<N>, output: &Output<N>, alarm: bool) {
        self.stopped |= alarm;
        if !self.stopped && self.row % self.every == 0 {
            if self.ring.is_full() {
                self.ring.pop_front();
            }
            let record = Record {
                row: self.row,
                measured_gyro_angle_rad: measured,
                modelled_gyro_angle_rad: output.gyro_angle_rad,
                input: *input,
            };
            // There is room now.
            let _ = self.ring.push_back(record);
        }
        self.row = self.row.wrapping_add(1);
    }

    /// The rows kept, the oldest first.
    pub fn rows(&self) -> impl Iterator<Item = &Record<N>> {
        self.ring.iter()
    }

    /// Whether an alarm has stopped the ring.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stopped
    }

    /// Goes on after an alarm.
    pub fn resume(&mut self) {
        self.stopped = false;
    }
}
