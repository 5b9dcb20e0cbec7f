//! Power of a channel's noise over frequency, from what is left of it.
//!
//! ```text
//! P(f) = w + l |G(f)|^2 + n |N(f)|^2 + b / (1 + (f / f_c)^s)         w, l, n, b >= 0     s = 1, 2, 4, 8
//! ```
//!
//! w is the channel's own white noise, l the white noise of the logged inputs behind the loop G (torque on the gimbal
//! to the channel), n the pick-off's noise as the servo answers it, sampled or filtered ([`super::shapes`]), b noise that
//! ends at a corner: with s = 2 it is slow; with s = 1 it is flicker, which has no corner in the log or one where it ends,
//! and which a lag may end at a higher frequency; with s = 4 or 8 it is white noise of a sensor behind a filter against
//! aliasing. Only what has one of these shapes is noise. Fitted by Whittle's likelihood to medians over segments, so that
//! what happens now and then is no noise either.

use super::plans::Plans;
use super::shapes::{Shapes, passed};
use crate::window::hann;

/// Rows of a segment.
pub(super) const SEGMENT: usize = 4096;
/// Bands in which power is taken, the lowest line of them, and steps of the fit.
const BANDS: usize = 36;
const FIRST_LINE: f64 = 1.5;
const STEPS: usize = 120;
/// Rows of a segment for what is slower, its bands, and what a degree of freedom counts there: what has been fitted took
/// some of them.
const LONG_SEGMENT: usize = 8 * SEGMENT;
/// Least length of it over that of the others: one that is hardly longer shows an effect that is slow, and not much else.
const LEAST_LONG: usize = 4;
const SLOW_BANDS: usize = 6;
const SLOW_COUNTS: f64 = 0.5;
/// What noise of low frequency must bring: few lines show it, and it hides what is slow [nats].
const SHOWN_NATS: f64 = 1.5;
/// Corners that are tried of the slope 2, and of the slope 1: that one must bring more, as it goes on rising where
/// nothing is measured [Hz], [nats].
const CORNERS_HZ: [f64; 10] = [0.3, 0.6, 1.2, 2.4, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0];
/// The lowest one of a walk, which rises as long as a log is: what rises below so many times the lowest frequency that is
/// measured, and is likelier by so much than none, may [Hz], [nats].
const WALK_HZ: f64 = 0.05;
const UNMEASURED: f64 = 2.0;
const WALKS_NATS: f64 = 8.0;
const FLICKER_CORNERS_HZ: [f64; 3] = [0.05, 1.0, 10.0];
const FLICKER_ENDS_HZ: [f64; 3] = [25.0, 60.0, 150.0];
const FLICKER_NATS: f64 = 3.5;
/// Corners of filters against aliasing, of second and of fourth order [Hz].
const FILTERS_HZ: [f64; 13] = [80.0, 90.0, 100.0, 112.0, 125.0, 140.0, 160.0, 180.0, 200.0, 225.0, 250.0, 280.0, 320.0];
const FILTER_ORDERS: [i32; 2] = [2, 4];
/// Least white noise that slow noise is compared with, and steps of frequency in which its end is looked for.
const LEAST_WHITE: f64 = 1e-3;
const FINER: f64 = 1.1;
const MOST_STEPS: usize = 120;
/// Below this frequency the noise of the logged inputs may be flicker: accelerometers of which a bias wanders [Hz].
pub(super) const INPUTS_CORNER_HZ: f64 = 5.0;

/// Power of a channel's noise over frequency, 1 for white noise of unit variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// w.
    pub white: f64,
    /// l.
    pub inputs: f64,
    /// n, held between samples, on lines, and behind a filter.
    pub in_loop: [f64; 3],
    /// b.
    pub low: f64,
    /// Its shape.
    pub slow: Slow,
    /// Lowest frequency at which it was measured [Hz].
    pub from_hz: f64,
}

/// Shape of noise of low frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Slow {
    /// There is none.
    None,
    /// `1 / (1 + (f / f_c)^(2 n))`, `f_c` in Hz, n.
    Steep(f64, i32),
    /// `1 / (1 + f / f_c)`.
    Flicker(f64),
    /// The same from below all logs on, behind a lag: `1 / ((1 + f / f_c) (1 + (f / f_e)^2))`, `f_e` in Hz.
    Filtered(f64),
}

impl Slow {
    /// All that are tried beside none, and what each must bring [nats].
    fn all() -> impl Iterator<Item = (Self, f64)> {
        let steep = CORNERS_HZ.map(|corner_hz| (Self::Steep(corner_hz, 1), SHOWN_NATS));
        let flicker = FLICKER_CORNERS_HZ.map(|corner_hz| (Self::Flicker(corner_hz), FLICKER_NATS));
        let filtered = FLICKER_ENDS_HZ.map(|end_hz| (Self::Filtered(end_hz), FLICKER_NATS));
        let behind = FILTER_ORDERS
            .into_iter()
            .flat_map(|order| FILTERS_HZ.map(|end_hz| (Self::Steep(end_hz, order), SHOWN_NATS)));
        steep.into_iter().chain(flicker).chain(filtered).chain(behind)
    }

    fn at(self, hz: f64) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Steep(corner_hz, order) => passed(hz, corner_hz, order),
            Self::Flicker(corner_hz) => 1.0 / (1.0 + hz / corner_hz),
            Self::Filtered(end_hz) => Self::Flicker(FLICKER_CORNERS_HZ[0]).at(hz) * passed(hz, end_hz, 1),
        }
    }
}

impl Noise {
    pub(super) fn power(&self, hz: f64, shapes: [f64; 4]) -> f64 {
        self.white + self.inputs * shapes[0] + self.of_loop(shapes) + self.low * self.slow.at(hz)
    }

    /// How far slow noise is above the white one where the log shows least of it, in amplitude, and from which frequency on it is
    /// below that [Hz]; none where there is none.
    pub(crate) fn slow_over_white(&self) -> Option<[f64; 2]> {
        // of higher order it is white noise behind a filter
        if matches!(self.slow, Slow::None | Slow::Steep(_, 2..)) {
            return None;
        }
        let over = |hz: f64| (self.low * self.slow.at(hz) / self.white.max(LEAST_WHITE)).sqrt();
        let higher = std::iter::successors(Some(self.from_hz), |hz| Some(FINER * hz)).take(MOST_STEPS);
        let end_hz = higher.take_while(|hz| over(*hz) > 1.0).last()?;
        Some([over(self.from_hz), end_hz])
    }

    /// Of the pick-off in the loop.
    pub(super) fn of_loop(&self, [_, shapes @ ..]: [f64; 4]) -> f64 {
        self.in_loop.iter().zip(shapes).map(|(size, shape)| size * shape).sum()
    }

    /// At the lines of a transform. Below what was measured it does not fall: which of the shapes the noise has, a few
    /// lines do not tell, and what does not change would stand out of one of them and not of another.
    pub(super) fn powers(&self, shapes: &Shapes, last: usize, step_hz: f64) -> Vec<f64> {
        let least = self.power(self.from_hz, shapes.at(self.from_hz));
        let at = |line: usize| {
            let hz = line as f64 * step_hz;
            self.power(hz, shapes.line(line)).max(if hz < self.from_hz { least } else { 0.0 })
        };
        (0..=last).map(at).collect()
    }
}

/// What power is taken of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    /// The median of segments that count for half at least: what happens now and then is no noise.
    Most,
    /// The mean of segments that count for a tenth at least: noise that comes in bursts.
    All,
}

/// Measured power in bands.
pub(super) struct Bands {
    pub(super) hz: Vec<f64>,
    pub(super) power: Vec<f64>,
    /// Degrees of freedom.
    weight: Vec<f64>,
    /// How many of the first are of longer segments.
    slow: usize,
}

/// Segments of which powers are taken.
struct Segments<'a> {
    /// Rows of each, and their transform.
    length: usize,
    plans: &'a Plans,
    /// Highest frequency [Hz].
    to_hz: f64,
    /// Bands up to there.
    bands: usize,
    /// What a degree of freedom counts.
    counts: f64,
}

impl Bands {
    /// Of segments, and of longer ones for what is slower than these show.
    pub(super) fn new(values: &[f64], valid: &[bool], of: Of, period_s: f64) -> Self {
        let mut bands = Self { hz: Vec::new(), power: Vec::new(), weight: Vec::new(), slow: 0 };
        let (length, long) = (SEGMENT.min(values.len()), LONG_SEGMENT.min(values.len()));
        let plans = Plans::new(length);
        if long >= LEAST_LONG * length {
            let shown_hz = FIRST_LINE / (plans.length() as f64 * period_s);
            bands.add(
                values,
                valid,
                of,
                period_s,
                &Segments {
                    length: long,
                    plans: &Plans::new(long),
                    to_hz: shown_hz,
                    bands: SLOW_BANDS,
                    counts: SLOW_COUNTS,
                },
            );
            bands.slow = bands.hz.len();
        }
        bands.add(
            values,
            valid,
            of,
            period_s,
            &Segments { length, plans: &plans, to_hz: 0.5 / period_s, bands: BANDS, counts: 1.0 },
        );
        bands
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "lines")]
    fn add(&mut self, values: &[f64], valid: &[bool], of: Of, period_s: f64, segments: &Segments) {
        let &Segments { length, plans, to_hz, bands, counts: weight } = segments;
        let window = hann(length);
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
        let first = FIRST_LINE * step_hz;
        let edge = |band: usize| first * (to_hz / first).powf(band as f64 / bands as f64);
        for band in 0..bands {
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
            self.hz.push(0.5 * (from + to - 1) as f64 * step_hz);
            self.power.push(match of {
                Of::Most => 0.5 * (means[(means.len() - 1) / 2] + means[means.len() / 2]) / median,
                Of::All => means.iter().sum::<f64>() / means.len() as f64,
            });
            self.weight.push(weight * n * segments.len() as f64);
        }
    }

    pub(super) fn any(&self) -> bool {
        !self.hz.is_empty()
    }

    /// How sure it is that the lowest bands together have less power than 1, up to whichever of them that shows most [nats].
    pub(super) fn below_one(&self) -> f64 {
        let (mut power, mut weight, mut most) = (0.0, 0.0, 0.0_f64);
        for (band, own) in self.power.iter().zip(&self.weight).skip(self.slow) {
            power += own * band;
            weight += own;
            let mean: f64 = power / weight;
            if mean < 1.0 {
                most = most.max(0.5 * weight * (mean - 1.0 - mean.max(1e-30).ln()));
            }
        }
        most
    }

    /// How much of a shape more makes the measured powers most likely.
    pub(super) fn fit_more(&self, known: &dyn Fn(f64) -> f64, more: &dyn Fn(f64) -> f64, most: f64) -> f64 {
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
    pub(super) fn fit(&self, shapes: &Shapes) -> Noise {
        self.fitted(shapes, f64::INFINITY, 0.0).1
    }

    /// How much likelier the measured powers are where the noise of the logged inputs may have any size than where it has
    /// at most this one, white or rising below the corner of such sensors [nats].
    pub(super) fn beyond_inputs(&self, shapes: &Shapes, most: f64) -> f64 {
        let known = [0.0, INPUTS_CORNER_HZ].map(|corner_hz| self.fitted(shapes, most, corner_hz).0);
        0.5 * (known[0].min(known[1]) - self.fitted(shapes, f64::INFINITY, 0.0).0)
    }

    /// -2 ln of the likelihood, and the shapes, with l at most so large and `1 + f_c / f` times it at f.
    fn fitted(&self, shapes: &Shapes, most_inputs: f64, corner_hz: f64) -> (f64, Noise) {
        let from_hz = self.hz.first().copied().unwrap_or(0.0);
        if !self.any() {
            return (
                f64::MAX,
                Noise { white: 1.0, inputs: 0.0, in_loop: [0.0; 3], low: 0.0, slow: Slow::None, from_hz },
            );
        }
        let mean = self.power.iter().sum::<f64>() / self.power.len() as f64;
        let peak = |of: usize| self.hz.iter().map(|hz| shapes.at(*hz)[of]).fold(1e-300, f64::max);
        let peaks = [0, 1, 2, 3].map(peak);
        let with = |slow: Slow, must_bring: f64| {
            let basis = |&hz: &f64| {
                let [inputs, held, on_lines, filtered] = shapes.at(hz);
                let inputs = inputs / peaks[0] * (1.0 + corner_hz / hz);
                [1.0, inputs, held / peaks[1], on_lines / peaks[2], filtered / peaks[3], slow.at(hz)]
            };
            let bases: Vec<[f64; 6]> = self.hz.iter().map(basis).collect();
            let mut share = [mean, 0.1 * mean, 0.03 * mean, 0.03 * mean, 0.03 * mean, 0.1 * mean];
            let power = |share: &[f64; 6], basis: &[f64; 6]| -> f64 {
                share.iter().zip(basis).map(|(a, b)| a * b).sum::<f64>().max(1e-300)
            };
            for _ in 0..STEPS {
                let (mut up, mut down) = ([0.0; 6], [0.0; 6]);
                for ((basis, measured), weight) in bases.iter().zip(&self.power).zip(&self.weight) {
                    let model = power(&share, basis);
                    for part in 0..6 {
                        up[part] += weight * basis[part] * measured / (model * model);
                        down[part] += weight * basis[part] / model;
                    }
                }
                for part in 0..6 {
                    share[part] *= up[part] / down[part].max(1e-300);
                }
                share[1] = share[1].min(most_inputs * peaks[0]);
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
            let [white, inputs, in_loop @ .., low] = share;
            let (inputs, in_loop) = (inputs / peaks[0], [0, 1, 2].map(|place| in_loop[place] / peaks[1 + place]));
            (unlikely + 2.0 * must_bring, Noise { white, inputs, in_loop, low, slow, from_hz })
        };
        let none = with(Slow::None, 0.0);
        let likelier = |best: (f64, Noise), own: (f64, Noise)| if own.0 < best.0 { own } else { best };
        let best = Slow::all().map(|(slow, must_bring)| with(slow, must_bring)).fold(none, likelier);
        let is_unmeasured = matches!(best.1.slow, Slow::Steep(corner_hz, 1) if corner_hz < UNMEASURED * from_hz);
        if is_unmeasured && none.0 - best.0 > 2.0 * WALKS_NATS {
            return (best.0, with(Slow::Steep(WALK_HZ, 1), 0.0).1);
        }
        best
    }
}
