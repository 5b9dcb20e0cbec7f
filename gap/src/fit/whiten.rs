//! Whitening: each channel divided by the spectrum of its noise.
//!
//! ```text
//! P(f) = w + l |G(f)|^2 + b / (1 + (f / f_c)^2)         w, l, b >= 0
//! ```
//!
//! w is the channel's own white noise, l the white noise of the logged inputs behind the loop G (torque on the gimbal
//! to the channel), b noise of low frequency with its corner. Only what has one of these shapes is noise. Fitted by
//! Whittle's likelihood to medians over segments, so that what happens now and then is no noise either; where there are
//! enough of them, rows at which the bearing turns around are left out. [`Slips`] whitens the noise that is there.

use std::fmt;
use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

use super::slip::Slips;
use crate::record::between;

/// Rows of a segment.
const SEGMENT: usize = 4096;
/// Bands in which power is taken, and steps of the fit.
const BANDS: usize = 36;
const STEPS: usize = 120;
/// Least power of noise, over the white noise that the samples themselves show.
const LEAST_POWER: f64 = 1e-3;
/// Corners that are tried [Hz].
const CORNERS_HZ: [f64; 10] = [0.3, 0.6, 1.2, 2.4, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0];

/// Power of a channel's noise over frequency, 1 for white noise of unit variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// w.
    pub white: f64,
    /// l.
    pub inputs: f64,
    /// b.
    pub low: f64,
    /// `f_c` [Hz].
    pub corner_hz: f64,
}

/// A whitening filter.
#[derive(Debug, Clone)]
pub struct Whitener {
    /// The noise of each channel.
    pub noise: Vec<Noise>,
    /// Rows that count.
    pub valid: Vec<bool>,
    /// `1 / sqrt(P)` at the lines of the transform.
    gains: Vec<Vec<f64>>,
    slips: Slips,
    plans: Plans,
}

/// The transforms there and back.
#[derive(Clone)]
pub(super) struct Plans {
    length: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    back: Arc<dyn ComplexToReal<f64>>,
}

impl fmt::Debug for Plans {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "transforms of {}", self.length)
    }
}

/// Where the noise of inputs acts.
#[derive(Debug, Clone, Copy)]
pub struct Loop<'a> {
    /// Each channel after an impulse of torque.
    pub impulse: &'a [Vec<f64>],
    /// Rows at which the bearing may turn around, and those just after.
    pub turning: &'a [bool],
    /// Time between two rows [s].
    pub period_s: f64,
}

impl Whitener {
    /// Fits the filter to a residual, channel by channel.
    #[must_use]
    pub fn new(residual: &[Vec<f64>], valid: &[bool], behind: Loop) -> Self {
        let rows = valid.len();
        let plans = Plans::new(rows + SEGMENT.min(rows));
        let step_hz = 1.0 / (plans.length as f64 * behind.period_s);
        let quiet: Vec<bool> = valid.iter().zip(behind.turning).map(|(valid, turning)| *valid && !turning).collect();
        let mut noise = Vec::new();
        let mut gains = Vec::new();
        for (channel, impulse) in residual.iter().zip(behind.impulse) {
            let response: Vec<f64> = plans.lines(impulse).iter().map(Complex::norm_sqr).collect();
            let shape = |hz: f64| between(&response, hz / step_hz);
            let counted = if enough(&quiet) { &quiet } else { valid };
            let own = Bands::new(channel, counted, behind.period_s).fit(&shape);
            let of = |line: usize| own.power(line as f64 * step_hz, response[line]);
            gains.push((0..=plans.length / 2).map(|line| 1.0 / of(line).max(LEAST_POWER).sqrt()).collect());
            noise.push(own);
        }
        Self { noise, valid: valid.to_vec(), gains, slips: Slips::default(), plans }
    }

    /// The same with what whitens the noise of the rate.
    pub(crate) fn with_slips(self, slips: Slips) -> Self {
        Self { slips, ..self }
    }

    /// The whitened samples of all channels, row after row; masked rows are zero.
    #[must_use]
    pub fn apply(&self, signals: &[Vec<f64>]) -> Vec<f64> {
        let mut whitened = self.filter(signals);
        self.slips.apply(&mut whitened);
        whitened
    }

    /// Through the filter of frequencies alone.
    pub(crate) fn filter(&self, signals: &[Vec<f64>]) -> Vec<f64> {
        let (channels, rows) = (signals.len(), self.valid.len());
        let mut out = vec![0.0; channels * rows];
        for (channel, signal) in signals.iter().enumerate() {
            let masked: Vec<f64> =
                signal.iter().zip(&self.valid).map(|(value, valid)| if *valid { *value } else { 0.0 }).collect();
            let mut lines = self.plans.lines(&masked);
            for (line, gain) in lines.iter_mut().zip(&self.gains[channel]) {
                *line *= gain / self.plans.length as f64;
            }
            let series = self.plans.series(&mut lines);
            for k in (0..rows).filter(|&k| self.valid[k]) {
                out[k * channels + channel] = series[k];
            }
        }
        out
    }

    /// The transforms, and what each line is divided by for the noise while nothing turns around.
    pub(super) fn plans(&self) -> &Plans {
        &self.plans
    }

    pub(super) fn slips(&self) -> &Slips {
        &self.slips
    }

    pub(super) fn gains(&self) -> &[Vec<f64>] {
        &self.gains
    }

    /// Samples of all channels.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.gains.len() * self.valid.len()
    }

    /// Samples that count.
    #[must_use]
    pub fn count(&self) -> usize {
        self.gains.len() * self.valid.iter().filter(|valid| **valid).count()
    }
}

impl Plans {
    fn new(least: usize) -> Self {
        let mut length = least.next_power_of_two();
        for odd in [3, 5, 9, 15] {
            let other = odd * (least.div_ceil(odd)).next_power_of_two();
            length = length.min(other.max(2));
        }
        let mut planner = RealFftPlanner::<f64>::new();
        Self { length, forward: planner.plan_fft_forward(length), back: planner.plan_fft_inverse(length) }
    }

    pub(super) fn length(&self) -> usize {
        self.length
    }

    pub(super) fn lines(&self, values: &[f64]) -> Vec<Complex<f64>> {
        let mut padded = values.to_vec();
        padded.resize(self.length, 0.0);
        let mut lines = self.forward.make_output_vec();
        // lengths are the plan's own
        let _ = self.forward.process(&mut padded, &mut lines);
        lines
    }

    /// The values whose lines these are, times their number.
    pub(super) fn series(&self, lines: &mut [Complex<f64>]) -> Vec<f64> {
        lines[0].im = 0.0;
        if let Some(last) = lines.last_mut() {
            last.im = 0.0;
        }
        let mut series = self.back.make_output_vec();
        let _ = self.back.process(lines, &mut series);
        series
    }
}

impl Noise {
    fn power(&self, hz: f64, response: f64) -> f64 {
        self.white + self.inputs * response + self.low * low(hz, self.corner_hz)
    }
}

fn low(hz: f64, corner_hz: f64) -> f64 {
    1.0 / (1.0 + (hz / corner_hz) * (hz / corner_hz))
}

/// Measured power in bands.
struct Bands {
    hz: Vec<f64>,
    power: Vec<f64>,
    /// Degrees of freedom.
    weight: Vec<f64>,
}

impl Bands {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "lines")]
    fn new(values: &[f64], valid: &[bool], period_s: f64) -> Self {
        let length = SEGMENT.min(values.len());
        let plans = Plans::new(length);
        let window: Vec<f64> =
            (0..length).map(|k| 0.5 - 0.5 * (std::f64::consts::TAU * (k as f64 + 0.5) / length as f64).cos()).collect();
        let mut segments: Vec<Vec<f64>> = Vec::new();
        for start in (0..=values.len() - length).step_by((length / 2).max(1)) {
            let sample = |k: usize| if valid[start + k] { values[start + k] * window[k] } else { 0.0 };
            let gain: f64 = (0..length).filter(|&k| valid[start + k]).map(|k| window[k] * window[k]).sum();
            let all: f64 = window.iter().map(|value| value * value).sum();
            if gain > 0.5 * all {
                let tapered: Vec<f64> = (0..length).map(sample).collect();
                segments.push(plans.lines(&tapered).iter().map(|line| line.norm_sqr() / gain).collect());
            }
        }
        let step_hz = 1.0 / (plans.length as f64 * period_s);
        let (first, last) = (1.5 * step_hz, 0.5 / period_s);
        let edge = |band: usize| first * (last / first).powf(band as f64 / BANDS as f64);
        let mut bands = Self { hz: Vec::new(), power: Vec::new(), weight: Vec::new() };
        for band in 0..BANDS {
            let (from, to) = ((edge(band) / step_hz).ceil() as usize, (edge(band + 1) / step_hz).ceil() as usize);
            let to = to.min(plans.length / 2);
            if segments.is_empty() || to <= from {
                continue;
            }
            let mut means: Vec<f64> =
                segments.iter().map(|power| power[from..to].iter().sum::<f64>() / (to - from) as f64).collect();
            means.sort_by(f64::total_cmp);
            // the median of a chi square of n degrees over its mean
            let n = 2.0 * (to - from) as f64 * length as f64 / plans.length as f64;
            let median = (1.0 - 2.0 / (9.0 * n.max(1.0))).powi(3);
            bands.hz.push(0.5 * (from + to - 1) as f64 * step_hz);
            bands.power.push(means[means.len() / 2] / median);
            bands.weight.push(n * segments.len() as f64);
        }
        bands
    }

    fn any(&self) -> bool {
        !self.hz.is_empty()
    }

    /// The shapes that make the measured powers most likely.
    fn fit(&self, response: &dyn Fn(f64) -> f64) -> Noise {
        let mut best = (f64::MAX, Noise { white: 1.0, inputs: 0.0, low: 0.0, corner_hz: 1.0 });
        if !self.any() {
            return best.1;
        }
        let mean = self.power.iter().sum::<f64>() / self.power.len() as f64;
        let peak = self.hz.iter().map(|hz| response(*hz)).fold(1e-300, f64::max);
        for corner_hz in CORNERS_HZ {
            let bases: Vec<[f64; 3]> =
                self.hz.iter().map(|&hz| [1.0, response(hz) / peak, low(hz, corner_hz)]).collect();
            let mut share = [mean, 0.1 * mean, 0.1 * mean];
            let power = |share: &[f64; 3], basis: &[f64; 3]| -> f64 {
                share.iter().zip(basis).map(|(a, b)| a * b).sum::<f64>().max(1e-300)
            };
            for _ in 0..STEPS {
                let (mut up, mut down) = ([0.0; 3], [0.0; 3]);
                for ((basis, measured), weight) in bases.iter().zip(&self.power).zip(&self.weight) {
                    let model = power(&share, basis);
                    for part in 0..3 {
                        up[part] += weight * basis[part] * measured / (model * model);
                        down[part] += weight * basis[part] / model;
                    }
                }
                for part in 0..3 {
                    share[part] *= up[part] / down[part].max(1e-300);
                }
            }
            let unlikely: f64 = bases
                .iter()
                .zip(&self.power)
                .zip(&self.weight)
                .map(|((basis, measured), weight)| {
                    let model = power(&share, basis);
                    weight * (model.ln() + measured / model)
                })
                .sum();
            if unlikely < best.0 {
                let [white, inputs, low] = share;
                best = (unlikely, Noise { white, inputs: inputs / peak, low, corner_hz });
            }
        }
        best.1
    }
}

fn enough(valid: &[bool]) -> bool {
    4 * valid.iter().filter(|valid| **valid).count() > valid.len()
}
