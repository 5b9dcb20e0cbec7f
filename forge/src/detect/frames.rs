//! Short frames of a series and their transforms: a tight frame, in which the sum of squares is that of the series.

use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{RealFftPlanner, RealToComplex};

/// Rows from one frame to the next; each is twice as long.
pub(super) const HOP: usize = 64;

/// Frames of a series of a certain length. Values are in the order of frames, `HOP + 1` frequencies each.
pub(super) struct Frames {
    /// Rows of the series.
    count: usize,
    /// Root of a Hann window: the squares of neighbouring ones sum to 1.
    window: Vec<f64>,
    forward: Arc<dyn RealToComplex<f64>>,
}

impl Frames {
    pub(super) fn new(count: usize) -> Self {
        let sine = |place: usize| libm::sin(core::f64::consts::PI * (place as f64 + 0.5) / (2 * HOP) as f64);
        let forward = RealFftPlanner::<f64>::new().plan_fft_forward(2 * HOP);
        Self { count, window: (0..2 * HOP).map(sine).collect(), forward }
    }

    fn frames(&self) -> usize {
        self.count.div_ceil(HOP) + 1
    }

    /// Frequencies of all frames.
    pub(super) fn cells(&self) -> usize {
        self.frames() * (HOP + 1)
    }

    /// Rows of one frame with the places of the window that they stand at; the first one begins before the series.
    fn rows(&self, frame: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let begin = frame * HOP;
        (0..2 * HOP)
            .filter(move |place| (HOP..HOP + self.count).contains(&(begin + place)))
            .map(move |place| (begin + place - HOP, place))
    }

    /// Weight of a frequency, by which the sum of squares is kept.
    fn scale(line: usize) -> f64 {
        let twice = if line == 0 || line == HOP { 1.0 } else { 2.0 };
        libm::sqrt(twice / (2 * HOP) as f64)
    }

    /// Real and imaginary part of each frequency of each frame.
    pub(super) fn of(&self, series: &[f64]) -> Vec<[f64; 2]> {
        let (mut input, mut output) = (self.forward.make_input_vec(), self.forward.make_output_vec());
        let mut all = Vec::with_capacity(self.cells());
        for frame in 0..self.frames() {
            input.fill(0.0);
            for (row, place) in self.rows(frame) {
                input[place] = series[row] * self.window[place];
            }
            if self.forward.process(&mut input, &mut output).is_ok() {
                let scaled = |(line, value): (usize, &Complex<f64>)| {
                    [value.re * Self::scale(line), value.im * Self::scale(line)]
                };
                all.extend(output.iter().enumerate().map(scaled));
            }
        }
        all
    }

    /// Mean square of each frequency of each frame for white noise of rms 1 that fades as told.
    pub(super) fn white_power(&self, fade: &[f64]) -> Vec<f64> {
        let mut all = Vec::with_capacity(self.cells());
        for frame in 0..self.frames() {
            let power: f64 = self.rows(frame).map(|(row, place)| libm::pow(fade[row] * self.window[place], 2.0)).sum();
            all.extend((0..=HOP).map(|line| power * libm::pow(Self::scale(line), 2.0)));
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_the_sum_of_squares_is_that_of_the_series() {
        for count in [1, 63, 64, 65, 1000] {
            let series: Vec<f64> = (0..count).map(|row| libm::sin(0.7 * row as f64 * row as f64) + 0.2).collect();
            let cells = Frames::new(count).of(&series);
            let sum: f64 = cells.iter().map(|[re, im]| re * re + im * im).sum();
            let expected: f64 = series.iter().map(|value| value * value).sum();
            assert!((sum / expected - 1.0).abs() < 1e-12, "{count}: {sum} {expected}");
        }
    }
}
