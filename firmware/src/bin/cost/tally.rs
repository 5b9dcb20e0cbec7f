//! Counts added up.

use gimbal_firmware::semihosting::println;

/// Counts of the steps of one kind.
#[derive(Clone, Copy)]
pub(crate) struct Tally {
    steps: u32,
    sum: u64,
    min: u32,
    max: u32,
}

impl Tally {
    pub(crate) const EMPTY: Self = Self { steps: 0, sum: 0, min: u32::MAX, max: 0 };

    pub(crate) fn add(&mut self, count: u32) {
        self.steps += 1;
        self.sum += u64::from(count);
        self.min = self.min.min(count);
        self.max = self.max.max(count);
    }

    /// Mean in thousandths of an instruction: text of a float would need the code to print it.
    pub(crate) fn print(&self, kind: &str, name: &str, number: &str) {
        if self.steps > 0 {
            let mean_milli = self.sum * 1000 / u64::from(self.steps);
            println!("{kind} {name} {number} {} {} {mean_milli} {}", self.steps, self.min, self.max);
        }
    }
}
