//! Power of a channel's noise over frequency.
//!
//! ```text
//! P(f) = w + l |G(f)|^2 + n |N(f)|^2 + b / (1 + (f / f_c)^s)         w, l, n, b >= 0     s = 1, 2, 4, 8
//! ```
//!
//! w is the channel's own white noise, l the white noise of the logged inputs behind the loop G (torque on the gimbal
//! to the channel), n the pick-off's noise as the servo answers it, sampled or filtered ([`super::shapes`]), b noise that
//! ends at a corner: with s = 2 it is slow; with s = 1 it is flicker, which has no corner in the log or one where it ends,
//! and which a lag may end at a higher frequency; with s = 4 or 8 it is white noise of a sensor behind a filter against
//! aliasing. Only what has one of these shapes is noise.

use super::shapes::{Shapes, passed};

/// What noise of low frequency must bring: few lines show it, and it hides what is slow [nats].
const SHOWN_NATS: f64 = 1.5;
/// Corners that are tried of the slope 2, and of the slope 1: that one must bring more, as it goes on rising where
/// nothing is measured [Hz], [nats].
const CORNERS_HZ: [f64; 10] = [0.3, 0.6, 1.2, 2.4, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0];
const FLICKER_CORNERS_HZ: [f64; 3] = [0.05, 1.0, 10.0];
const FLICKER_ENDS_HZ: [f64; 3] = [25.0, 60.0, 150.0];
const FLICKER_NATS: f64 = 3.5;
/// Corners of filters against aliasing, of second and of fourth order [Hz].
const FILTERS_HZ: [f64; 13] = [80.0, 90.0, 100.0, 112.0, 125.0, 140.0, 160.0, 180.0, 200.0, 225.0, 250.0, 280.0, 320.0];
const FILTER_ORDERS: [i32; 2] = [2, 4];
/// Corner of a walk, which rises as long as a log is [Hz].
pub(super) const WALK_HZ: f64 = 0.05;
/// Least white noise that slow noise is compared with, and steps of frequency in which its end is looked for.
const LEAST_WHITE: f64 = 1e-3;
const FINER: f64 = 1.1;
const MOST_STEPS: usize = 120;

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
    pub(super) fn all() -> impl Iterator<Item = (Self, f64)> {
        let steep = CORNERS_HZ.map(|corner_hz| (Self::Steep(corner_hz, 1), SHOWN_NATS));
        let flicker = FLICKER_CORNERS_HZ.map(|corner_hz| (Self::Flicker(corner_hz), FLICKER_NATS));
        let filtered = FLICKER_ENDS_HZ.map(|end_hz| (Self::Filtered(end_hz), FLICKER_NATS));
        let behind = FILTER_ORDERS
            .into_iter()
            .flat_map(|order| FILTERS_HZ.map(|end_hz| (Self::Steep(end_hz, order), SHOWN_NATS)));
        steep.into_iter().chain(flicker).chain(filtered).chain(behind)
    }

    pub(super) fn at(self, hz: f64) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Steep(corner_hz, order) => passed(hz, corner_hz, order),
            Self::Flicker(corner_hz) => 1.0 / (1.0 + hz / corner_hz),
            Self::Filtered(end_hz) => Self::Flicker(FLICKER_CORNERS_HZ[0]).at(hz) * passed(hz, end_hz, 1),
        }
    }
}

impl Noise {
    /// White noise alone.
    pub(super) fn white(white: f64, from_hz: f64) -> Self {
        Self { white, inputs: 0.0, in_loop: [0.0; 3], low: 0.0, slow: Slow::None, from_hz }
    }

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
