//! Power of a residual over frequency, in units of its white noise.

use realfft::RealFftPlanner;

use crate::window::hann;

/// Rows of a segment.
const SEGMENT: usize = 2048;
/// Share of its rows that may be missing.
const MISSING: f64 = 0.02;
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
    /// Welch's mean over the segments in which nearly every row counts; one that does not has the value before it.
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
        let mut last = 0.0;
        let held = values.iter().zip(valid).map(|(value, valid)| {
            last = if *valid { *value } else { last };
            last
        });
        let held: Vec<f64> = held.collect();
        while start + length <= values.len() {
            let missing = valid[start..start + length].iter().filter(|valid| !**valid).count();
            if missing as f64 <= MISSING * length as f64 {
                let mut segment: Vec<f64> =
                    held[start..start + length].iter().zip(&window).map(|(value, window)| value * window).collect();
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

#[cfg(test)]
mod tests {
    use super::Spectrum;

    #[test]
    fn closed_form_a_tone_has_its_power_though_some_rows_are_missing() {
        let tone = |k: u32| 2.0 * (std::f64::consts::TAU * 0.05 * f64::from(k)).sin();
        let mut values: Vec<f64> = (0..8192).map(tone).collect();
        let mut valid = vec![true; 8192];
        let whole = Spectrum::new(&values, &valid, 1.0, 1e-3).mean(45.0, 55.0);
        for row in (100..8192).step_by(200) {
            (values[row], valid[row]) = (0.0, false);
        }
        let most = Spectrum::new(&values, &valid, 1.0, 1e-3).mean(45.0, 55.0);
        assert!(whole > 50.0 && (most / whole - 1.0).abs() < 0.02, "{whole}, {most}");
        valid.iter_mut().step_by(20).for_each(|valid| *valid = false);
        assert!(Spectrum::new(&values, &valid, 1.0, 1e-3).mean(45.0, 55.0) < 1e-9);
    }
}
