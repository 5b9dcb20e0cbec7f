//! The logged rate and specific force without their sensors' noise.
//!
//! Where the bearing hardly slips, friction turns every error of the logged rate into torque; noise of the specific force makes
//! an unbalance too small, the more the less the force changes (errors in variables). Wiener's filter takes out what is noise
//! by the signal's own spectrum, and what hangs on the signal is as large as it is:
//!
//! ```text
//! W(f) = max(0, 1 - N / P(f))        P the power of the signal as logged, N that of its white noise
//! ```
//!
//! White motion and white noise look alike in a signal; the outputs tell them apart. The filter stays when the
//! nominal prediction from the filtered signal is closer to them in what is quick.

use realfft::RealFftPlanner;

use crate::window::hann;

use super::Record;
use super::colour::colour;
use super::rough::rough;
use crate::simulate::{Inputs, Physics, Prediction, predict};

/// Rows of a segment in which the spectrum is taken.
const SEGMENT: usize = 2048;
/// Lines that pass as they are, and one in how many is as low as noise is.
const SLOWEST: usize = 3;
const LOWEST: usize = 20;
/// A row whose filtered rate is off by more standard deviations keeps its own: a step, no noise.
const STEP: f64 = 4.0;
/// Rows around a step that keep theirs too.
const AROUND: usize = 20;
/// Share of an output's quick misfit that the filter may leave.
const BETTER: f64 = 0.995;
/// What a filter of the specific force must take away of the misfit over its mean square, so that it matters: were it force and
/// no noise, it would leave more by fourteen standard errors.
const SURE: f64 = 200.0;
/// Rows between those of which third differences are taken: what is slower than 10 Hz, where parameters are off, is hardly
/// in them.
const APART: usize = 8;

/// Inputs in the place of others, what they predict, and each output's quick misfit over that of before.
struct Instead {
    inputs: Inputs,
    prediction: Prediction,
    ratios: Vec<f64>,
}

impl Record {
    /// Takes out what sensors add, where the outputs show it: noise of the rate, and hum.
    pub fn quieten(&mut self, physics: &Physics) {
        let as_logged = self.predicted(physics, &self.inputs);
        let hushed = self.hush_inputs(physics, as_logged);
        let filtered = self.filter_rate(physics, hushed);
        let nominal = self.filter_force(physics, filtered);
        if let Some(hushed) = self.hushed(&nominal) {
            *self = hushed;
        }
    }

    /// Filters the rate where that brings the prediction closer, and tells what is predicted then.
    fn filter_rate(&mut self, physics: &Physics, as_logged: Prediction) -> Prediction {
        let rate = &self.inputs.rate_radps;
        let noise = |_: &[f64]| rough(rate, &vec![true; rate.len()]);
        let Some((rate_radps, pass)) = filtered(rate, noise) else { return as_logged };
        let filtered = self.instead(physics, Inputs { rate_radps, ..self.inputs.clone() }, &as_logged);
        let ratios = &filtered.ratios;
        if ratios.iter().all(|ratio| *ratio < 2.0 - BETTER) && ratios.iter().any(|ratio| *ratio < BETTER) {
            self.inputs = filtered.inputs;
            self.rate_noise.pass = pass;
            return filtered.prediction;
        }
        as_logged
    }

    /// Filters the specific force where that brings the prediction closer, and tells what is predicted then.
    fn filter_force(&mut self, physics: &Physics, as_is: Prediction) -> Prediction {
        let axes = self.inputs.accel_mps2.each_ref();
        let quiet = axes.map(|axis| filtered(axis, lowest).map(|(quiet, _)| quiet));
        if quiet.iter().all(Option::is_none) {
            return as_is;
        }
        let mut inputs = self.inputs.clone();
        for (axis, quiet) in inputs.accel_mps2.iter_mut().zip(quiet) {
            if let Some(quiet) = quiet {
                *axis = quiet;
            }
        }
        let filtered = self.instead(physics, inputs, &as_is);
        let nearer: f64 = filtered.ratios.iter().map(|ratio| 1.0 - ratio).sum();
        if nearer * self.rows() as f64 > SURE {
            self.inputs = filtered.inputs;
            return filtered.prediction;
        }
        as_is
    }

    /// What other inputs make of the prediction.
    fn instead(&self, physics: &Physics, mut inputs: Inputs, before: &Prediction) -> Instead {
        inputs.complete(&physics.config.bearing, self.inputs.turned_rad[0]);
        let prediction = self.predicted(physics, &inputs);
        let (before, after) = (self.misfit(before), self.misfit(&prediction));
        let ratios = after.iter().zip(&before).map(|(after, before)| after / before).collect();
        Instead { inputs, prediction, ratios }
    }

    /// What a platform shows that begins as the first rows do.
    pub(super) fn predicted(&self, physics: &Physics, inputs: &Inputs) -> Prediction {
        predict(physics, inputs, &self.begin(physics, inputs), usize::MAX)
    }

    /// Third differences of each output's misfit, squared and summed.
    fn misfit(&self, prediction: &Prediction) -> Vec<f64> {
        let of = |channel: &super::Channel| {
            let predicted = crate::fit::predicted(channel.signal, prediction);
            let off = |k: usize| channel.values[k] - predicted[k];
            let all = |k: &usize| (0..4).all(|step| channel.valid[k - step * APART]);
            let third = |k: usize| off(k) - 3.0 * (off(k - APART) - off(k - 2 * APART)) - off(k - 3 * APART);
            (3 * APART..self.rows()).filter(all).map(|k| third(k).powi(2)).sum::<f64>().max(1e-300)
        };
        self.channels.iter().map(of).collect()
    }
}

/// Noise of the rate that drives the predictions.
#[derive(Debug, Clone)]
pub struct RateNoise {
    /// Rms of the white noise as logged [rad/s].
    pub rms_radps: f64,
    /// W from zero to half the sampling rate, evenly.
    pub pass: Vec<f64>,
    /// How much more power it has where it is slower: its mean over rows is then more than they let expect.
    pub colour: f64,
}

impl RateNoise {
    pub(super) fn logged(rate_radps: &[f64]) -> Self {
        let rms_radps = rough(rate_radps, &vec![true; rate_radps.len()]);
        Self { rms_radps, pass: vec![1.0], colour: colour(rate_radps) }
    }

    /// W at a share of half the sampling rate.
    #[must_use]
    pub fn pass(&self, share: f64) -> f64 {
        between(&self.pass, share * (self.pass.len() - 1) as f64)
    }
}

/// White noise of a signal whose motion may be as quick; none of one too short for a spectrum.
pub(super) fn white_noise(values: &[f64]) -> Option<f64> {
    (values.len() >= 2 * SEGMENT).then(|| lowest(&spectrum(values)))
}

/// White noise of a signal whose motion may be as quick, by its spectrum: what it has where that is lowest.
fn lowest(spectrum: &[f64]) -> f64 {
    let mut lines = spectrum.to_vec();
    lines.sort_by(f64::total_cmp);
    lines[lines.len() / LOWEST].sqrt()
}

/// A signal through Wiener's filter for the white noise that its spectrum tells, steps kept, and the filter; none when there is
/// nothing to filter.
fn filtered(values: &[f64], noise: impl Fn(&[f64]) -> f64) -> Option<(Vec<f64>, Vec<f64>)> {
    let rows = values.len();
    if rows < 2 * SEGMENT {
        return None;
    }
    let spectrum = spectrum(values);
    let noise = noise(&spectrum);
    if noise < 1e-9 {
        return None;
    }
    let pass: Vec<f64> = spectrum
        .iter()
        .enumerate()
        .map(|(line, power)| if line < SLOWEST { 1.0 } else { (1.0 - noise * noise / power).max(0.0) })
        .collect();
    // mirrored at both ends
    let edge = SEGMENT / 2;
    let mut padded: Vec<f64> = (1..=edge).rev().map(|k| 2.0 * values[0] - values[k]).collect();
    padded.extend_from_slice(values);
    padded.extend((1..=edge).map(|k| 2.0 * values[rows - 1] - values[rows - 1 - k]));
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
    let step = |k: usize| (smooth[k] - values[k]).abs() > STEP * noise;
    let mut kept = vec![false; rows];
    for k in (0..rows).filter(|&k| step(k)) {
        kept[k.saturating_sub(AROUND)..(k + AROUND).min(rows)].fill(true);
    }
    Some(((0..rows).map(|k| if kept[k] { values[k] } else { smooth[k] }).collect(), pass))
}

/// Power of a signal from zero to half the sampling rate, white noise of 1 having 1: the mean over segments and a few lines.
fn spectrum(values: &[f64]) -> Vec<f64> {
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(SEGMENT);
    let mut lines = transform.make_output_vec();
    let window = hann(SEGMENT);
    let power: f64 = window.iter().map(|value| value * value).sum();
    let mut sums = vec![0.0; lines.len()];
    let mut segments = 0.0;
    for start in (0..=values.len() - SEGMENT).step_by(SEGMENT / 2) {
        let segment = &values[start..start + SEGMENT];
        let mean = segment.iter().sum::<f64>() / SEGMENT as f64;
        let mut tapered: Vec<f64> =
            segment.iter().zip(&window).map(|(value, window)| (value - mean) * window).collect();
        if transform.process(&mut tapered, &mut lines).is_ok() {
            sums.iter_mut().zip(&lines).for_each(|(sum, line)| *sum += line.norm_sqr() / power);
            segments += 1.0;
        }
    }
    let last = sums.len() - 1;
    let around = |line: usize| {
        let around = &sums[line.saturating_sub(2)..=(line + 2).min(last)];
        around.iter().sum::<f64>() / around.len() as f64 / segments
    };
    (0..=last).map(around).collect()
}

/// A value between two lines.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a line")]
pub(crate) fn between(values: &[f64], place: f64) -> f64 {
    let low = (place as usize).min(values.len() - 1);
    let high = (low + 1).min(values.len() - 1);
    values[low] + (place - low as f64) * (values[high] - values[low])
}
