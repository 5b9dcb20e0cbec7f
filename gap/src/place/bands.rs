//! Power of a residual over frequency, in units of its white noise.

use realfft::RealFftPlanner;

use crate::window::hann;

/// Rows of a segment.
const SEGMENT: usize = 2048;
/// Edges of the bands that are told [Hz].
const EDGES: [f64; 8] = [0.0, 1.0, 3.0, 10.0, 30.0, 80.0, 200.0, 500.0];

/// Mean power of segments, 1 for white noise of unit variance.
#[derive(Debug, Clone, Default)]
pub struct Spectrum {
    /// Distance of the lines [Hz].
    pub step_hz: f64,
    /// Power of each line.
    pub power: Vec<f64>,
}

/// A band and its share of the excess.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// [Hz].
    pub from_hz: f64,
    /// [Hz].
    pub to_hz: f64,
    /// Share of the excess over all bands.
    pub share: f64,
}

impl Spectrum {
    /// Welch's mean over the segments in which every row counts.
    #[must_use]
    pub fn new(values: &[f64], valid: &[bool], sigma: f64, period_s: f64) -> Self {
        let length = SEGMENT.min(values.len());
        let mut planner = RealFftPlanner::<f64>::new();
        let transform = planner.plan_fft_forward(length);
        let window = hann(length);
        let gain: f64 = window.iter().map(|value| value * value).sum::<f64>() * sigma * sigma;
        let mut power = vec![0.0; length / 2 + 1];
        let mut count = 0.0;
        let mut start = 0;
        let mut lines = transform.make_output_vec();
        while start + length <= values.len() {
            if valid[start..start + length].iter().all(|valid| *valid) {
                let mut segment: Vec<f64> =
                    values[start..start + length].iter().zip(&window).map(|(value, window)| value * window).collect();
                if transform.process(&mut segment, &mut lines).is_ok() {
                    for (power, line) in power.iter_mut().zip(&lines) {
                        *power += line.norm_sqr() / gain;
                    }
                    count += 1.0;
                }
            }
            start += length / 2;
        }
        if count > 0.0 {
            for power in &mut power {
                *power /= count;
            }
        }
        Self { step_hz: 1.0 / (length as f64 * period_s), power }
    }

    /// Mean power between two frequencies.
    #[must_use]
    pub fn mean(&self, from_hz: f64, to_hz: f64) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for (line, power) in self.power.iter().enumerate() {
            let hz = line as f64 * self.step_hz;
            if hz >= from_hz && hz < to_hz {
                sum += power;
                count += 1.0;
            }
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// The bands with the shares of what is above white noise.
    #[must_use]
    pub fn bands(spectra: &[Self]) -> Vec<Band> {
        let excess = |from: f64, to: f64| -> f64 {
            spectra.iter().map(|spectrum| (spectrum.mean(from, to) - 1.0).max(0.0) * (to - from)).sum()
        };
        let all: f64 = EDGES.windows(2).map(|edge| excess(edge[0], edge[1])).sum();
        EDGES
            .windows(2)
            .map(|edge| Band { from_hz: edge[0], to_hz: edge[1], share: excess(edge[0], edge[1]) / all.max(1e-30) })
            .collect()
    }
}
