//! Whitening: each channel divided by the spectrum of its noise.
//!
//! ```text
//! P(f) = w + l |G(f)|^2 + n |N(f)|^2 + b / (1 + (f / f_c)^2)         w, l, n, b >= 0
//! ```
//!
//! w is the channel's own white noise, l the white noise of the logged inputs behind the loop G (torque on the gimbal
//! to the channel), n the pick-off's noise as the servo answers it ([`super::shapes`]), b noise of low frequency with its corner. Only what has one of these shapes is noise. Fitted by
//! Whittle's likelihood to medians over segments, so that what happens now and then is no noise either. Where the
//! bearing turns around at once, [`Slips`] whitens the noise of the logged rate; where it does so slowly, that noise
//! comes through the slope of the friction law: `P + s^2 W(f) |G(f)|^2`, s the torque that the rate's noise makes, W
//! Wiener's filter: of noise and motion it leaves that much to be off.

use super::plans::Plans;
use super::shapes::Shapes;
use super::signals::of_channel;
use super::slip::Slips;
use crate::record::RateNoise;

/// Rows of a segment.
const SEGMENT: usize = 4096;
/// Bands in which power is taken, and steps of the fit.
const BANDS: usize = 36;
const STEPS: usize = 120;
/// Least power of noise, over the white noise that the samples themselves show.
const LEAST_POWER: f64 = 1e-3;
/// What noise of low frequency must bring: few lines show it, and it hides what is slow [nats].
const SHOWN_NATS: f64 = 1.5;
/// Corners that are tried [Hz].
const CORNERS_HZ: [f64; 10] = [0.3, 0.6, 1.2, 2.4, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0];

/// Power of a channel's noise over frequency, 1 for white noise of unit variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// w.
    pub white: f64,
    /// l.
    pub inputs: f64,
    /// n.
    pub in_loop: f64,
    /// b.
    pub low: f64,
    /// `f_c` [Hz].
    pub corner_hz: f64,
    /// Lowest frequency at which it was measured [Hz].
    pub from_hz: f64,
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
    /// The same while the bearing turns around slowly.
    turning_gains: Vec<Vec<f64>>,
    turning: Vec<bool>,
    slips: Slips,
    plans: Plans,
}

/// Where the noise of inputs acts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Loop<'a> {
    /// Transforms of the record's rows ([`Whitener::plans_of`]).
    pub(super) plans: &'a Plans,
    /// What noise looks like in each channel.
    pub shapes: &'a [Shapes],
    /// Rows at which the bearing may turn around, and those just after.
    pub turning: &'a [bool],
    /// s of the rate's noise as logged, in units of the impulse; zero where it is whitened turn by turn.
    pub turning_noise: f64,
    /// What is left of that noise.
    pub rate_noise: &'a RateNoise,
    /// Time between two rows [s].
    pub period_s: f64,
}

impl Whitener {
    /// Transforms with room for what a filter remembers.
    pub(super) fn plans_of(rows: usize) -> Plans {
        Plans::new(rows + SEGMENT.min(rows))
    }

    /// Fits the filter to a residual, channel by channel.
    #[must_use]
    pub(crate) fn new(residual: &[Vec<f64>], valid: &[bool], behind: Loop) -> Self {
        let plans = behind.plans;
        let step_hz = 1.0 / (plans.length() as f64 * behind.period_s);
        let quiet: Vec<bool> = valid.iter().zip(behind.turning).map(|(valid, turning)| *valid && !turning).collect();
        let turns: Vec<bool> = valid.iter().zip(behind.turning).map(|(valid, turning)| *valid && *turning).collect();
        let slow = behind.turning_noise > 0.0;
        let mut noise = Vec::new();
        let (mut gains, mut turning_gains) = (Vec::new(), Vec::new());
        for (channel, shapes) in residual.iter().zip(behind.shapes) {
            // where hardly anything else is, the rows that turn around show their noise themselves
            let aside = Some(Bands::new(channel, &quiet, Of::Most, behind.period_s));
            let aside = aside.filter(|bands| enough(&quiet) && bands.any());
            let most = if aside.is_some() { behind.turning_noise.powi(2) } else { 0.0 };
            let own = aside.unwrap_or_else(|| Bands::new(channel, valid, Of::Most, behind.period_s)).fit(shapes);
            let passed = |hz: f64| behind.rate_noise.pass(2.0 * hz * behind.period_s) * shapes.at(hz)[0];
            // at most what the slope makes of it: the gimbal follows the bearing and takes a part away
            let turning_power = if most > 0.0 {
                let turns = Bands::new(channel, &turns, Of::All, behind.period_s);
                turns.fit_more(&|hz| own.power(hz, shapes.at(hz)), &passed, most)
            } else {
                0.0
            };
            let powers = own.powers(shapes, plans.length() / 2, step_hz);
            let gain = |more: f64| -> Vec<f64> {
                let of = |(line, power): (usize, &f64)| power + more * passed(line as f64 * step_hz);
                powers.iter().enumerate().map(of).map(|power| 1.0 / power.max(LEAST_POWER).sqrt()).collect()
            };
            gains.push(gain(0.0));
            turning_gains.push(if slow { gain(turning_power) } else { Vec::new() });
            noise.push(own);
        }
        let turning = behind.turning.iter().map(|turning| slow && *turning).collect();
        Self {
            noise,
            valid: valid.to_vec(),
            gains,
            turning_gains,
            turning,
            slips: Slips::default(),
            plans: plans.clone(),
        }
    }

    /// The same with the filter fitted to what this one makes white.
    pub(crate) fn measured_again(mut self, residual: &[Vec<f64>], behind: Loop) -> Self {
        let (channels, whitened) = (residual.len(), self.apply(residual));
        let step_hz = 1.0 / (self.plans.length() as f64 * behind.period_s);
        for (channel, shapes) in behind.shapes.iter().enumerate() {
            let series: Vec<f64> = of_channel(&whitened, channel, channels).collect();
            let mut bands = Bands::new(&series, &self.valid, Of::Most, behind.period_s);
            for (power, &hz) in bands.power.iter_mut().zip(&bands.hz) {
                *power *= self.noise[channel].power(hz, shapes.at(hz));
            }
            let own = bands.fit(shapes);
            let powers = own.powers(shapes, self.plans.length() / 2, step_hz);
            self.gains[channel] = powers.iter().map(|power| 1.0 / power.max(LEAST_POWER).sqrt()).collect();
            self.noise[channel] = own;
        }
        self
    }

    /// The same with what whitens the noise of the rate turn by turn.
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

    /// Through the filters of frequencies alone.
    pub(crate) fn filter(&self, signals: &[Vec<f64>]) -> Vec<f64> {
        let (channels, rows) = (signals.len(), self.valid.len());
        let mut out = vec![0.0; channels * rows];
        for (channel, signal) in signals.iter().enumerate() {
            let masked = signal.iter().zip(&self.valid).map(|(value, valid)| if *valid { *value } else { 0.0 });
            let lines = self.plans.lines(masked);
            let filters = [(&self.gains[channel], false), (&self.turning_gains[channel], true)];
            for (gain, turning) in filters.into_iter().filter(|(gain, _)| !gain.is_empty()) {
                let mut lines = lines.clone();
                for (line, gain) in lines.iter_mut().zip(gain) {
                    *line *= gain / self.plans.length() as f64;
                }
                let series = self.plans.series(&mut lines);
                let counts = self.valid.iter().zip(&self.turning).map(|(valid, turns)| *valid && *turns == turning);
                for ((row, value), counts) in out.chunks_exact_mut(channels).zip(&series).zip(counts) {
                    if counts {
                        row[channel] = *value;
                    }
                }
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

impl Noise {
    fn power(&self, hz: f64, [inputs, in_loop]: [f64; 2]) -> f64 {
        self.white + self.inputs * inputs + self.in_loop * in_loop + self.low * low(hz, self.corner_hz)
    }

    /// At the lines of a transform. Below what was measured it does not fall: which of the shapes the noise has, a few
    /// lines do not tell, and what does not change would stand out of one of them and not of another.
    fn powers(&self, shapes: &Shapes, last: usize, step_hz: f64) -> Vec<f64> {
        let least = self.power(self.from_hz, shapes.at(self.from_hz));
        let at = |line: usize| {
            let hz = line as f64 * step_hz;
            self.power(hz, shapes.line(line)).max(if hz < self.from_hz { least } else { 0.0 })
        };
        (0..=last).map(at).collect()
    }
}

/// The shape of noise of low frequency; of none without a corner.
fn low(hz: f64, corner_hz: f64) -> f64 {
    if corner_hz > 0.0 { 1.0 / (1.0 + (hz / corner_hz) * (hz / corner_hz)) } else { 0.0 }
}

/// What power is taken of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Of {
    /// The median of segments that count for half at least: what happens now and then is no noise.
    Most,
    /// The mean of segments that count for a tenth at least: noise that comes in bursts.
    All,
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
    fn new(values: &[f64], valid: &[bool], of: Of, period_s: f64) -> Self {
        let length = SEGMENT.min(values.len());
        let plans = Plans::new(length);
        let window: Vec<f64> =
            (0..length).map(|k| 0.5 - 0.5 * (std::f64::consts::TAU * (k as f64 + 0.5) / length as f64).cos()).collect();
        let least = if of == Of::Most { 0.5 } else { 0.1 };
        let mut segments: Vec<Vec<f64>> = Vec::new();
        for start in (0..=values.len() - length).step_by((length / 2).max(1)) {
            let counts = |k: &usize| valid[start + k];
            let gain: f64 = (0..length).filter(counts).map(|k| window[k] * window[k]).sum();
            let all: f64 = window.iter().map(|value| value * value).sum();
            if gain > least * all {
                // what does not change is no noise, and would leak into all bands where rows are missing
                let weight: f64 = (0..length).filter(counts).map(|k| window[k]).sum();
                let mean = (0..length).filter(counts).map(|k| window[k] * values[start + k]).sum::<f64>() / weight;
                let sample = |k: usize| if counts(&k) { (values[start + k] - mean) * window[k] } else { 0.0 };
                segments.push(plans.lines((0..length).map(sample)).iter().map(|line| line.norm_sqr() / gain).collect());
            }
        }
        let step_hz = 1.0 / (plans.length() as f64 * period_s);
        let (first, last) = (1.5 * step_hz, 0.5 / period_s);
        let edge = |band: usize| first * (last / first).powf(band as f64 / BANDS as f64);
        let mut bands = Self { hz: Vec::new(), power: Vec::new(), weight: Vec::new() };
        for band in 0..BANDS {
            let (from, to) = ((edge(band) / step_hz).ceil() as usize, (edge(band + 1) / step_hz).ceil() as usize);
            let to = to.min(plans.length() / 2);
            if segments.is_empty() || to <= from {
                continue;
            }
            let mut means: Vec<f64> =
                segments.iter().map(|power| power[from..to].iter().sum::<f64>() / (to - from) as f64).collect();
            means.sort_by(f64::total_cmp);
            // the median of a chi square of n degrees over its mean
            let n = 2.0 * (to - from) as f64 * length as f64 / plans.length() as f64;
            let median = (1.0 - 2.0 / (9.0 * n.max(1.0))).powi(3);
            bands.hz.push(0.5 * (from + to - 1) as f64 * step_hz);
            bands.power.push(match of {
                Of::Most => 0.5 * (means[(means.len() - 1) / 2] + means[means.len() / 2]) / median,
                Of::All => means.iter().sum::<f64>() / means.len() as f64,
            });
            bands.weight.push(n * segments.len() as f64);
        }
        bands
    }

    fn any(&self) -> bool {
        !self.hz.is_empty()
    }

    /// How much of a shape more makes the measured powers most likely.
    fn fit_more(&self, known: &dyn Fn(f64) -> f64, more: &dyn Fn(f64) -> f64, most: f64) -> f64 {
        let parts: Vec<(f64, f64)> = self.hz.iter().map(|&hz| (known(hz), more(hz))).collect();
        let mut share = most;
        for _ in 0..STEPS {
            let (mut up, mut down) = (0.0, 0.0);
            for (((known, more), measured), weight) in parts.iter().zip(&self.power).zip(&self.weight) {
                let model = (known + share * more).max(1e-300);
                up += weight * more * measured / (model * model);
                down += weight * more / model;
            }
            share = (share * up / down.max(1e-300)).min(most);
        }
        share
    }

    /// The shapes that make the measured powers most likely.
    fn fit(&self, shapes: &Shapes) -> Noise {
        let from_hz = self.hz.first().copied().unwrap_or(0.0);
        let mut best = (f64::MAX, Noise { white: 1.0, inputs: 0.0, in_loop: 0.0, low: 0.0, corner_hz: 1.0, from_hz });
        if !self.any() {
            return best.1;
        }
        let mean = self.power.iter().sum::<f64>() / self.power.len() as f64;
        let peak = |of: usize| self.hz.iter().map(|hz| shapes.at(*hz)[of]).fold(1e-300, f64::max);
        let peaks = [peak(0), peak(1)];
        for corner_hz in std::iter::once(0.0).chain(CORNERS_HZ) {
            let basis = |&hz: &f64| {
                let [inputs, in_loop] = shapes.at(hz);
                [1.0, inputs / peaks[0], in_loop / peaks[1], low(hz, corner_hz)]
            };
            let bases: Vec<[f64; 4]> = self.hz.iter().map(basis).collect();
            let mut share = [mean, 0.1 * mean, 0.1 * mean, 0.1 * mean];
            let power = |share: &[f64; 4], basis: &[f64; 4]| -> f64 {
                share.iter().zip(basis).map(|(a, b)| a * b).sum::<f64>().max(1e-300)
            };
            for _ in 0..STEPS {
                let (mut up, mut down) = ([0.0; 4], [0.0; 4]);
                for ((basis, measured), weight) in bases.iter().zip(&self.power).zip(&self.weight) {
                    let model = power(&share, basis);
                    for part in 0..4 {
                        up[part] += weight * basis[part] * measured / (model * model);
                        down[part] += weight * basis[part] / model;
                    }
                }
                for part in 0..4 {
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
            let unlikely = unlikely + if corner_hz > 0.0 { 2.0 * SHOWN_NATS } else { 0.0 };
            if unlikely < best.0 {
                let [white, inputs, in_loop, low] = share;
                let (inputs, in_loop) = (inputs / peaks[0], in_loop / peaks[1]);
                best = (unlikely, Noise { white, inputs, in_loop, low, corner_hz, from_hz });
            }
        }
        best.1
    }
}

fn enough(valid: &[bool]) -> bool {
    4 * valid.iter().filter(|valid| **valid).count() > valid.len()
}
