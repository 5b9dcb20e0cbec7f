//! Power of what is left of a channel, in bands of frequency, and the noise that makes it likeliest.
//!
//! Fitted by Whittle's likelihood to medians over segments, so that what happens now and then is no noise.

use super::noise::{Noise, Slow, WALK_HZ};
use super::plans::Plans;
use super::shapes::Shapes;
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
/// What rises below so many times the lowest frequency that is measured, and is likelier by so much than none, may rise as long as
/// the log is: it is a walk [nats].
const UNMEASURED: f64 = 2.0;
const WALKS_NATS: f64 = 8.0;
/// Below this frequency the noise of the logged inputs may be flicker: accelerometers of which a bias wanders [Hz].
pub(super) const INPUTS_CORNER_HZ: f64 = 5.0;

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
            return (f64::MAX, Noise::white(1.0, from_hz));
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
