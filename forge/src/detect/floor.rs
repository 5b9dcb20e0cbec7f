//! Weighs differences by a noise floor that changes with frequency and with time.
//!
//! First over frequency, by the mean spectrum of the whole record. What is white then is still not the same everywhere: the
//! noise of a logged rate shows where the vehicle turns about. So the series is cut into short frames, and each
//! frequency of each frame is weighed by its own noise, from several draws.

use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

use super::frames::{Frames, HOP};
use crate::scene::Outputs;

/// The first second is not scored: the state before the record is unknown.
pub const UNSCORED_S: f64 = 1.0;
/// Share of the record over which it fades in and out before the transform.
const TAPER: f64 = 0.04;
/// Values over which the power of a whitened random series is taken.
const SMOOTH: usize = 64;
/// Rows of one piece of the noise spectrum.
const PIECE: usize = 2048;
/// Frequencies to either side of one whose noise in the same frame counts for its own.
const BESIDE: usize = 2;
/// Least share of the mean noise that a frame can have.
const LEAST: f64 = 0.05;

/// Weighs differences by the noise floor.
pub struct Whitener {
    /// Channels that are logged.
    used: Vec<usize>,
    skip: usize,
    count: usize,
    length: usize,
    /// Transforms of that length, there and back.
    forward: Arc<dyn RealToComplex<f64>>,
    back: Arc<dyn ComplexToReal<f64>>,
    /// One over the noise amplitude by frequency, one list a channel used.
    weights: Vec<Vec<f64>>,
    frames: Frames,
    /// One over what the noise of each frequency of each frame is over its mean, one list a channel used.
    local: Vec<Vec<f64>>,
}

fn taper(place: usize, count: usize) -> f64 {
    let edge = (TAPER * count as f64).max(1.0);
    let near = (place.min(count - 1 - place) as f64 + 0.5) / edge;
    if near >= 1.0 { 1.0 } else { 0.5 - 0.5 * libm::cos(core::f64::consts::PI * near) }
}

/// Power of each frequency of a piece, mean over pieces that overlap by half; white noise of rms 1 gives 1.
fn spectrum(series: &[f64]) -> Vec<f64> {
    let forward = RealFftPlanner::<f64>::new().plan_fft_forward(PIECE);
    let window: Vec<f64> = (0..PIECE)
        .map(|place| 0.5 - 0.5 * libm::cos(2.0 * core::f64::consts::PI * (place as f64 + 0.5) / PIECE as f64))
        .collect();
    let power: f64 = window.iter().map(|value| value * value).sum();
    let mut sum = vec![0.0; PIECE / 2 + 1];
    let mut pieces = 0.0_f64;
    let mut output = forward.make_output_vec();
    for start in (0..=series.len().saturating_sub(PIECE)).step_by(PIECE / 2) {
        let piece = &series[start..(start + PIECE).min(series.len())];
        let mut input: Vec<f64> = piece.iter().zip(&window).map(|(value, weight)| value * weight).collect();
        input.resize(PIECE, 0.0);
        if forward.process(&mut input, &mut output).is_ok() {
            for (total, value) in sum.iter_mut().zip(&output) {
                *total += value.norm_sqr() / power;
            }
        }
        pieces += 1.0;
    }
    sum.iter().map(|total| total / pieces.max(1.0)).collect()
}

/// One over the amplitude of the noise at each frequency of a transform of `length` rows, from its mean spectrum.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a place in a list
fn weights(draws: &[Vec<f64>], length: usize) -> Vec<f64> {
    let mut power = vec![0.0; PIECE / 2 + 1];
    for noise in draws {
        for (total, value) in power.iter_mut().zip(spectrum(noise)) {
            *total += value / draws.len() as f64;
        }
    }
    let amplitude = |bin: usize| {
        let place = bin as f64 * PIECE as f64 / length as f64;
        let low = (place as usize).min(power.len() - 2);
        let value = power[low] + (power[low + 1] - power[low]) * (place - low as f64);
        1.0 / libm::sqrt(value.max(1e-40))
    };
    (0..=length / 2).map(amplitude).collect()
}

impl Whitener {
    /// From draws of the noise floor; `used` are the channels that the log has.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a thousand rows
    pub fn new(draws: &[Outputs], used: &[usize], period_s: f64) -> Self {
        let skip = (UNSCORED_S / period_s) as usize;
        let count = draws.first().map_or(0, |noise| noise[0].len() - skip);
        let length = count.next_power_of_two();
        let of = |channel: &usize| draws.iter().map(|noise| noise[*channel][skip..].to_vec()).collect();
        let noise: Vec<Vec<Vec<f64>>> = used.iter().map(of).collect();
        let mut planner = RealFftPlanner::<f64>::new();
        let mut whitener = Self {
            used: used.to_vec(),
            skip,
            count,
            length,
            forward: planner.plan_fft_forward(length),
            back: planner.plan_fft_inverse(length),
            weights: noise.iter().map(|draws| weights(draws, length)).collect(),
            frames: Frames::new(count),
            local: Vec::new(),
        };
        whitener.local = noise.iter().enumerate().map(|(place, draws)| whitener.local_of(place, draws)).collect();
        whitener
    }

    /// One over how much the whitened noise of a channel is, frequency by frequency of each frame, over that of white noise.
    fn local_of(&self, place: usize, draws: &[Vec<f64>]) -> Vec<f64> {
        let tapers: Vec<f64> = (0..self.count).map(|row| taper(row, self.count)).collect();
        let white = self.frames.white_power(&tapers);
        let mut power = vec![0.0; self.frames.cells()];
        for noise in draws {
            for (total, [re, im]) in power.iter_mut().zip(self.frames.of(&self.whitened(place, noise))) {
                *total += (re * re + im * im) / draws.len() as f64;
            }
        }
        let near = |at: usize| {
            let (frame, line) = (at / (HOP + 1), at % (HOP + 1));
            let (from, to) = (line.saturating_sub(BESIDE), (line + BESIDE).min(HOP));
            let of_frame =
                |powers: &[f64]| powers[frame * (HOP + 1) + from..=frame * (HOP + 1) + to].iter().sum::<f64>();
            let (own, expected) = (of_frame(&power), of_frame(&white));
            // where the record fades out nothing is known of it
            if expected < 1e-3 { 1.0 } else { 1.0 / libm::sqrt((own / expected).max(LEAST)) }
        };
        (0..power.len()).map(near).collect()
    }

    /// Transform of a difference over the amplitude of the noise.
    fn lines(&self, place: usize, difference: &[f64]) -> Vec<Complex<f64>> {
        let mut input: Vec<f64> =
            difference.iter().enumerate().map(|(row, value)| value * taper(row, self.count)).collect();
        input.resize(self.length, 0.0);
        let mut lines = self.forward.make_output_vec();
        if self.forward.process(&mut input, &mut lines).is_err() {
            lines.fill(Complex::default());
        }
        for (value, weight) in lines.iter_mut().zip(&self.weights[place]) {
            *value *= *weight;
        }
        lines
    }

    /// A difference after the mean spectrum of the noise: noise is white then, of rms 1.
    fn whitened(&self, place: usize, difference: &[f64]) -> Vec<f64> {
        let mut lines = self.lines(place, difference);
        // what rounding leaves there is no part of a real series
        lines[0].im = 0.0;
        if let Some(last) = lines.last_mut() {
            last.im = 0.0;
        }
        let mut series = vec![0.0; self.length];
        if self.back.process(&mut lines, &mut series).is_err() {
            series.fill(0.0);
        }
        series.truncate(self.count);
        series.iter().map(|value| value / self.length as f64).collect()
    }

    fn difference_of(&self, place: usize, with: &Outputs, without: &Outputs) -> Vec<f64> {
        let channel = self.used[place];
        with[channel][self.skip..].iter().zip(&without[channel][self.skip..]).map(|(a, b)| a - b).collect()
    }

    /// The whitened difference of two runs; its norm is d.
    #[must_use]
    pub fn difference(&self, with: &Outputs, without: &Outputs) -> Vec<f64> {
        let mut all = Vec::with_capacity(2 * self.used.len() * self.frames.cells());
        for (place, local) in self.local.iter().enumerate() {
            let whitened = self.whitened(place, &self.difference_of(place, with, without));
            for ([re, im], weight) in self.frames.of(&whitened).into_iter().zip(local) {
                all.extend([re * weight, im * weight]);
            }
        }
        all
    }

    /// d of a random series: by its power s over that of the noise, `sqrt(sum s^2 / 2)` over all independent values of the
    /// spectrum.
    #[must_use]
    pub fn power_of(&self, with: &Outputs, without: &Outputs) -> f64 {
        let per_line = 2.0 / self.length as f64;
        let block = |values: &[f64]| {
            let squares: f64 = values.iter().map(|value| value * value * per_line).sum();
            // a mean of n squares, squared, is more than the square of what it stands for
            squares * squares / (values.len() as f64 + 2.0)
        };
        let of = |place: usize| -> f64 {
            let lines = self.lines(place, &self.difference_of(place, with, without));
            lines.iter().flat_map(|value| [value.re, value.im]).collect::<Vec<_>>().chunks(SMOOTH).map(block).sum()
        };
        let padding = self.length as f64 / self.count as f64;
        (0.5 * padding * (0..self.used.len()).map(of).sum::<f64>()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    fn white(rms: f64, draw: &mut Draw) -> Outputs {
        core::array::from_fn(|_| (0..11_000).map(|_| rms * draw.normal()).collect())
    }

    fn still() -> Outputs {
        core::array::from_fn(|_| vec![0.0; 11_000])
    }

    fn norm(values: &[f64]) -> f64 {
        values.iter().map(|value| value * value).sum::<f64>().sqrt()
    }

    #[test]
    fn white_noise_of_some_power_stands_out_by_it_and_by_the_root_of_half_the_rows() {
        let mut draw = Draw::new(&Draw::seed_of(5), 0);
        // rows that are no power of two: the transform is padded
        let draws: Vec<Outputs> = (0..6).map(|_| white(1.0, &mut draw)).collect();
        let random = white(0.3, &mut draw);
        let whitener = Whitener::new(&draws, &[0], 1e-3);
        let d = whitener.power_of(&random, &still());
        let expected = 0.3 * 0.3 * (0.5_f64 * 10_000.0).sqrt();
        assert!((d / expected - 1.0).abs() < 0.1, "{d} {expected}");
    }

    #[test]
    fn closed_form_in_white_noise_a_difference_counts_by_the_root_of_its_squares() {
        let mut draw = Draw::new(&Draw::seed_of(6), 0);
        let draws: Vec<Outputs> = (0..30).map(|_| white(2.0, &mut draw)).collect();
        let whitener = Whitener::new(&draws, &[0], 1e-3);
        for hertz in [0.0, 3.0, 60.0] {
            let mut wave = still();
            for (row, value) in wave[0].iter_mut().enumerate() {
                *value = 0.1 * libm::cos(2.0 * core::f64::consts::PI * hertz * row as f64 * 1e-3);
            }
            let faded: Vec<f64> =
                wave[0][1000..].iter().enumerate().map(|(row, value)| value * taper(row, 10_000) / 2.0).collect();
            let (d, expected) = (norm(&whitener.difference(&wave, &still())), norm(&faded));
            assert!((d / expected - 1.0).abs() < 0.1, "{hertz}: {d} {expected}");
        }
    }

    #[test]
    fn closed_form_what_shows_where_the_noise_is_ten_times_as_much_counts_a_tenth() {
        let mut draw = Draw::new(&Draw::seed_of(7), 0);
        let loud = |row: usize| (row / 500) % 4 == 1;
        let draws: Vec<Outputs> = (0..6)
            .map(|_| {
                let mut noise = white(1.0, &mut draw);
                for (row, value) in noise[0].iter_mut().enumerate() {
                    *value *= if loud(row) { 10.0 } else { 1.0 };
                }
                noise
            })
            .collect();
        let whitener = Whitener::new(&draws, &[0], 1e-3);
        // a pulse in the middle of the first loud span after the record fades in, and one between two of them
        let pulse = |middle: usize| {
            let mut wave = still();
            for (row, value) in wave[0].iter_mut().enumerate() {
                *value = libm::exp(-0.5 * libm::pow((row as f64 - middle as f64) / 20.0, 2.0));
            }
            norm(&whitener.difference(&wave, &still()))
        };
        let expected = (20.0 * core::f64::consts::PI.sqrt()).sqrt();
        let (in_loud, between) = (pulse(4750), pulse(5500));
        assert!((in_loud / expected * 10.0 - 1.0).abs() < 0.15, "{in_loud} {expected}");
        assert!((between / expected - 1.0).abs() < 0.15, "{between} {expected}");
    }
}
