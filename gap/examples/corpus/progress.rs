//! A line on standard error for each log that is done.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// So many of so many.
pub(crate) struct Progress {
    all: usize,
    done: AtomicUsize,
    start: Instant,
}

impl Progress {
    pub(crate) fn new(all: usize) -> Self {
        Self { all, done: AtomicUsize::new(0), start: Instant::now() }
    }

    /// One more, and what came of it.
    pub(crate) fn step(&self, told: &str) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        let elapsed = self.start.elapsed().as_secs_f64();
        let left = elapsed / done as f64 * (self.all - done.min(self.all)) as f64;
        eprintln!("{done} of {}, {left:.0} s left | {told}", self.all);
    }
}
