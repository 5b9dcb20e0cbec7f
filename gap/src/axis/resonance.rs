//! A mass on a spring behind the one that is measured: its column, and the frequencies at which a residual speaks for one.
//!
//! ```text
//! effort = J a + J2 b + ...        b = -s^2/(s^2 + 2 d w s + w^2) a        J2 >= 0
//! ```
//!
//! b is how much more the mass on the spring accelerates than what carries it; all of the inertia is in J. w is the
//! frequency with the carrier held.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::beside::{Beside, apart};
use super::library::Shape;
use super::motion::Motion;

/// Frequencies that are tried: from so many periods in the log, in such steps, up to the band's edge.
const PERIODS: f64 = 10.0;
const STEP: f64 = 1.06;
/// Dampings that are tried: with more of it, a mode takes what friction does about a reversal.
const DAMPINGS: [f64; 3] = [0.01, 0.03, 0.08];
/// Modes that are offered, and how far apart they are.
const OFFERED: usize = 3;
const APART: f64 = 1.2;

/// b at every row, by the bilinear transform with its own frequency kept.
pub(super) fn column(acceleration: &[f64], period_s: f64, frequency_hz: f64, damping: f64) -> Vec<f64> {
    let w = TAU * frequency_hz;
    let c = w / (0.5 * w * period_s).tan();
    let (first, middle, last) =
        (c * c + 2.0 * damping * w * c + w * w, 2.0 * (w * w - c * c), c * c - 2.0 * damping * w * c + w * w);
    let (mut inputs, mut outputs) = ([0.0; 2], [0.0; 2]);
    let next = |&a: &f64| {
        let second = a - 2.0 * inputs[0] + inputs[1];
        let b = (-c * c * second - middle * outputs[0] - last * outputs[1]) / first;
        inputs = [a, inputs[0]];
        outputs = [b, outputs[0]];
        b
    };
    acceleration.iter().map(next).collect()
}

/// Modes that take most of what base columns and a constant leave of a balance.
pub(super) fn modes(motion: &Motion, target: &[f64], base: &[Vec<f64>]) -> Vec<Shape> {
    let Some(beside) = Beside::new(target.to_vec(), base) else { return Vec::new() };
    let gain = |shape: Shape| (beside.gain(&shape.on_grid(motion)[0]), shape);
    let highest_hz = motion.band_hz.min(0.4 / motion.period_s);
    let frequencies = std::iter::successors(Some(PERIODS / motion.length_s()), |hz| Some(hz * STEP));
    let all: Vec<Shape> = frequencies
        .take_while(|hz| *hz < highest_hz)
        .flat_map(|frequency_hz| DAMPINGS.map(|damping| Shape::Mode { frequency_hz, damping }))
        .collect();
    let all: Vec<(f64, Shape)> = all.into_par_iter().map(gain).collect();
    apart(all, OFFERED, APART, |shape| shape.numbers()[0].1)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::column;

    #[test]
    fn closed_form_gain_below_at_and_above_the_resonance() {
        let (hz, damping, period_s) = (8.0, 0.06, 1e-3);
        for over in [0.2, 1.0, 4.0] {
            let wave = |k: u32| (TAU * over * hz * f64::from(k) * period_s).sin();
            let answer = column(&(0..20_000).map(wave).collect::<Vec<_>>(), period_s, hz, damping);
            let peak = answer[15_000..].iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
            let square: f64 = over * over;
            let expected = square / (1.0 - square).hypot(2.0 * damping * over);
            assert!((peak / expected - 1.0).abs() < 0.01, "{over}: {peak}, {expected}");
        }
    }
}
