//! Transforms of real series there and back, of a length that is quick.

use std::fmt;
use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

/// The transforms there and back.
#[derive(Clone)]
pub(crate) struct Plans {
    length: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    back: Arc<dyn ComplexToReal<f64>>,
}

impl fmt::Debug for Plans {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "transforms of {}", self.length)
    }
}

impl Plans {
    /// Of at least so many rows: a power of two, or three, five, nine or fifteen times one.
    pub(crate) fn new(least: usize) -> Self {
        let mut length = least.next_power_of_two();
        for odd in [3, 5, 9, 15] {
            let other = odd * (least.div_ceil(odd)).next_power_of_two();
            length = length.min(other.max(2));
        }
        let mut planner = RealFftPlanner::<f64>::new();
        Self { length, forward: planner.plan_fft_forward(length), back: planner.plan_fft_inverse(length) }
    }

    /// Rows of a transform.
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// The lines of values, with zeros up to the length.
    pub(crate) fn lines(&self, values: impl Iterator<Item = f64>) -> Vec<Complex<f64>> {
        let mut padded = Vec::with_capacity(self.length);
        padded.extend(values);
        padded.resize(self.length, 0.0);
        let mut lines = self.forward.make_output_vec();
        // lengths are the plan's own
        let _ = self.forward.process(&mut padded, &mut lines);
        lines
    }

    /// The values whose lines these are, times their number.
    pub(crate) fn series(&self, lines: &mut [Complex<f64>]) -> Vec<f64> {
        lines[0].im = 0.0;
        if let Some(last) = lines.last_mut() {
            last.im = 0.0;
        }
        let mut series = self.back.make_output_vec();
        let _ = self.back.process(lines, &mut series);
        series
    }
}
