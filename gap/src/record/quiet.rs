//! The logged rate without its sensor's noise.
//!
//! Where the bearing hardly slips, friction turns every error of the logged rate into torque. Wiener's filter takes
//! out what is noise by the rate's own spectrum:
//!
//! ```text
//! W(f) = max(0, 1 - N / P(f))        P the power of the logged rate, N that of its white noise
//! ```
//!
//! Noise that drives a prediction makes every fit prefer platforms that answer it less: the errors of the input bend the
//! parameters. What is left out of a filtered rate is not correlated with what is kept, and bends nothing.
//!
//! White motion and white noise look alike in the rate; the outputs tell them apart. The filter stays when what it takes
//! out of the nominal prediction is missing in them: most of it was noise.

use nalgebra::{DMatrix, DVector};
use realfft::RealFftPlanner;

use super::rough::rough;
use super::{Channel, Record};
use crate::simulate::{Inputs, Physics, Prediction, predict};

/// Rows of a segment in which the spectrum is taken.
const SEGMENT: usize = 2048;
/// A row whose filtered rate is off by more standard deviations keeps its own: a step, no noise.
const STEP: f64 = 4.0;
/// Rows around a step that keep theirs too.
const AROUND: usize = 20;
/// Rows at each end that are neither worth a cubic nor left out.
const FEW: usize = 16;
/// Rows between the samples of third differences in which the outputs are asked: those that tell most.
const APART: [usize; 3] = [6, 12, 25];
/// Standard error of the share of noise from which on they do not tell.
const MOST_ERROR: f64 = 0.5;

impl Record {
    /// Filters the rate where that brings the prediction closer.
    pub fn quieten(&mut self, physics: &Physics) {
        let Some((rate_radps, pass)) = filtered(&self.inputs.rate_radps) else { return };
        let mut inputs = Inputs { rate_radps, ..self.inputs.clone() };
        inputs.complete(&physics.config.bearing, self.inputs.turned_rad[0]);
        if self.noise_share(physics, &inputs).is_some_and(|share| share > 0.5) {
            self.inputs = inputs;
            let ends = rows_of(&pass);
            self.rate_noise.pass = pass;
            if ends > FEW
                && let Some(middle) = self.between_ends(ends, &physics.config.bearing)
            {
                *self = middle;
            }
        }
    }

    /// How much of what quiet inputs take out of the nominal prediction was noise; none where the outputs cannot tell.
    fn noise_share(&self, physics: &Physics, quiet: &Inputs) -> Option<f64> {
        let run = |inputs: &Inputs| predict(physics, inputs, &self.begin(physics, inputs), usize::MAX);
        let (logged, quiet) = (run(&self.inputs), run(quiet));
        let told = |apart: usize| {
            let each = self.channels.iter().map(|channel| Told::by(channel, &logged, &quiet, apart));
            each.fold(Told::default(), |sum, own| Told {
                along: sum.along + own.along,
                square: sum.square + own.square,
            })
        };
        let best = APART.map(told).into_iter().max_by(|a, b| a.square.total_cmp(&b.square))?;
        (best.square > 1.0 / (MOST_ERROR * MOST_ERROR)).then(|| best.along / best.square)
    }
}

/// What an output tells of the share `c` of a change d of the prediction that was noise, by least squares on its misfit
/// m, both over the misfit's deviation: `c = (m . d) / (d . d)`, of variance `1 / (d . d)`.
#[derive(Debug, Clone, Copy, Default)]
struct Told {
    along: f64,
    square: f64,
}

impl Told {
    fn by(channel: &Channel, logged: &Prediction, quiet: &Prediction, apart: usize) -> Self {
        let [logged, quiet] = [logged, quiet].map(|run| crate::fit::predicted(channel.signal, run));
        // what is smooth is no noise of the rate: a gap, or where friction came in
        let third = |of: &dyn Fn(usize) -> f64, k: usize| {
            of(k) - 3.0 * of(k - apart) + 3.0 * of(k - 2 * apart) - of(k - 3 * apart)
        };
        let (mut along, mut square, mut misfit, mut rows) = (0.0, 0.0, 0.0, 0.0);
        for k in 3 * apart..channel.values.len() {
            if (0..=3).all(|back| channel.valid[k - back * apart]) {
                let m = third(&|row| channel.values[row] - logged[row], k);
                let d = third(&|row| quiet[row] - logged[row], k);
                (along, square, misfit, rows) = (along + m * d, square + d * d, misfit + m * m, rows + 1.0);
            }
        }
        let over = rows / misfit.max(1e-300);
        Self { along: over * along, square: over * square }
    }
}

/// Noise of the rate that drives the predictions.
#[derive(Debug, Clone)]
pub struct RateNoise {
    /// Rms of the white noise as logged [rad/s].
    pub rms_radps: f64,
    /// W from zero to half the sampling rate, evenly.
    pub pass: Vec<f64>,
}

impl RateNoise {
    pub(super) fn logged(rate_radps: &[f64]) -> Self {
        Self { rms_radps: rough(rate_radps, &vec![true; rate_radps.len()]), pass: vec![1.0] }
    }

    /// W at a share of half the sampling rate.
    #[must_use]
    pub fn pass(&self, share: f64) -> f64 {
        between(&self.pass, share * (self.pass.len() - 1) as f64)
    }
}

/// The rate through Wiener's filter, steps kept, and the filter; none when there is nothing to filter.
fn filtered(rate_radps: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let rows = rate_radps.len();
    let noise = rough(rate_radps, &vec![true; rows]);
    if rows < 2 * SEGMENT || noise < 1e-9 {
        return None;
    }
    let pass = pass(rate_radps, noise);
    // mirrored at both ends, about where the motion ends: the last sample alone has the noise in it
    let edge = SEGMENT / 2;
    let length = rows_of(&pass).min(edge);
    let (first, last) = (end(rate_radps[..length].iter()), end(rate_radps[rows - length..].iter().rev()));
    let mut padded: Vec<f64> = (1..=edge).rev().map(|k| 2.0 * first - rate_radps[k]).collect();
    padded.extend_from_slice(rate_radps);
    padded.extend((1..=edge).map(|k| 2.0 * last - rate_radps[rows - 1 - k]));
    let slope = (padded[padded.len() - 1] - padded[0]) / padded.len() as f64;
    let line: Vec<f64> = (0..padded.len()).map(|k| padded[0] + slope * k as f64).collect();
    padded.iter_mut().zip(&line).for_each(|(value, line)| *value -= line);
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, back) = (planner.plan_fft_forward(padded.len()), planner.plan_fft_inverse(padded.len()));
    let mut lines = forward.make_output_vec();
    forward.process(&mut padded, &mut lines).ok()?;
    let (count, length) = (lines.len(), padded.len() as f64);
    for (index, line) in lines.iter_mut().enumerate() {
        let place = index as f64 / (count - 1) as f64 * (pass.len() - 1) as f64;
        *line *= between(&pass, place) / length;
    }
    let mut smooth = back.make_output_vec();
    back.process(&mut lines, &mut smooth).ok()?;
    let smooth: Vec<f64> = (0..rows).map(|k| smooth[k + edge] + line[k + edge]).collect();
    let step = |k: usize| (smooth[k] - rate_radps[k]).abs() > STEP * noise;
    let mut kept = vec![false; rows];
    for k in (0..rows).filter(|&k| step(k)) {
        kept[k.saturating_sub(AROUND)..(k + AROUND).min(rows)].fill(true);
    }
    Some(((0..rows).map(|k| if kept[k] { rate_radps[k] } else { smooth[k] }).collect(), pass))
}

/// Rows of half a period of the fastest motion that a filter lets through.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
fn rows_of(pass: &[f64]) -> usize {
    let fastest = pass.iter().take_while(|share| **share > 0.5).count().max(1);
    ((pass.len() - 1) as f64 / fastest as f64) as usize
}

/// Where samples begin, by the cubic through all of them; the first one itself where they are few.
fn end<'a>(samples: impl ExactSizeIterator<Item = &'a f64>) -> f64 {
    let rows = samples.len();
    let values = DVector::from_iterator(rows, samples.copied());
    let at = |row: usize| row as f64 / rows as f64;
    let powers = DMatrix::from_fn(rows, 4, |row, power| std::iter::repeat_n(at(row), power).product());
    let cubic = (rows > FEW).then(|| powers.svd(true, true).solve(&values, 1e-12).ok()).flatten();
    cubic.map_or(values[0], |cubic| cubic[0])
}

/// W from zero to half the sampling rate.
fn pass(values: &[f64], noise: f64) -> Vec<f64> {
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(SEGMENT);
    let mut lines = transform.make_output_vec();
    let window: Vec<f64> =
        (0..SEGMENT).map(|k| 0.5 - 0.5 * (std::f64::consts::TAU * (k as f64 + 0.5) / SEGMENT as f64).cos()).collect();
    let power: f64 = window.iter().map(|value| value * value).sum();
    let mut spectrum = vec![0.0; lines.len()];
    let mut segments = 0.0;
    for start in (0..=values.len() - SEGMENT).step_by(SEGMENT / 2) {
        let segment = &values[start..start + SEGMENT];
        let mean = segment.iter().sum::<f64>() / SEGMENT as f64;
        let mut tapered: Vec<f64> =
            segment.iter().zip(&window).map(|(value, window)| (value - mean) * window).collect();
        if transform.process(&mut tapered, &mut lines).is_ok() {
            spectrum.iter_mut().zip(&lines).for_each(|(sum, line)| *sum += line.norm_sqr() / power);
            segments += 1.0;
        }
    }
    let last = spectrum.len() - 1;
    (0..=last)
        .map(|line| {
            if line < 3 {
                return 1.0;
            }
            let around = &spectrum[line.saturating_sub(2)..=(line + 2).min(last)];
            let mean = around.iter().sum::<f64>() / around.len() as f64 / segments;
            (1.0 - noise * noise / mean).max(0.0)
        })
        .collect()
}

/// A value between two lines.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a line")]
pub(crate) fn between(values: &[f64], place: f64) -> f64 {
    let low = (place as usize).min(values.len() - 1);
    let high = (low + 1).min(values.len() - 1);
    values[low] + (place - low as f64) * (values[high] - values[low])
}
