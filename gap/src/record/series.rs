//! Lines of a series over frequency, and the noise about them.

use std::f64::consts::{LN_2, TAU};

use crate::window::spectrum;

/// Lines of the transform over one of the log's length.
const FINER: usize = 4;
/// Lines of the log's length that a line takes under the window, and about it those that show the noise there [Hz].
const WIDE: f64 = 4.0;
const AROUND_HZ: f64 = 4.0;
/// What a line must stand out by, beyond chance [nats].
pub(super) const STANDS_OUT: f64 = 12.0;

/// A series without gaps under a window.
pub(super) struct Series {
    pub(super) values: Vec<f64>,
    pub(super) window: Vec<f64>,
    pub(super) period_s: f64,
}

impl Series {
    /// Amplitudes of sine and cosine of a frequency, under a window that begins at a row.
    pub(super) fn amplitudes(&self, hz: f64, window: &[f64], from: usize) -> [f64; 2] {
        let weight = 0.5 * window.iter().sum::<f64>();
        let rows = self.values[from..].iter().zip(window).zip(from..);
        rows.fold([0.0; 2], |[sine, cosine], ((value, window), row)| {
            let (sin, cos) = self.wave(hz, row);
            [sine + window * value * sin / weight, cosine + window * value * cos / weight]
        })
    }

    pub(super) fn wave(&self, hz: f64, row: usize) -> (f64, f64) {
        (TAU * hz * row as f64 * self.period_s).sin_cos()
    }

    /// Power of values over frequency, under the window.
    pub(super) fn powers(&self, values: &[f64]) -> Option<Vec<f64>> {
        let sum: f64 = self.window.iter().sum();
        let mean = values.iter().zip(&self.window).map(|(value, window)| value * window).sum::<f64>() / sum;
        let tapered: Vec<f64> =
            values.iter().zip(&self.window).map(|(value, window)| window * (value - mean)).collect();
        spectrum(&tapered, self.length())
    }

    /// Rms of a row, were all noise as that of the upper half of the band.
    pub(super) fn floor(&self, powers: &[f64]) -> f64 {
        (noise(&mut powers[powers.len() / 2..].to_vec()) / power(&self.window)).sqrt()
    }

    /// Rows of a transform.
    fn length(&self) -> usize {
        FINER * self.values.len().next_power_of_two()
    }

    /// The strongest line between two frequencies, if it stands out of the noise about it.
    pub(super) fn line(&self, powers: &[f64], between_hz: [f64; 2]) -> Option<Line> {
        let line = self.strongest(powers, between_hz)?;
        let independent = ((between_hz[1] - between_hz[0]) * self.values.len() as f64 * self.period_s).max(1.0);
        (line.power / line.noise - independent.ln() > STANDS_OUT).then_some(line)
    }

    /// The strongest line between two frequencies.
    pub(super) fn strongest(&self, powers: &[f64], [from_hz, to_hz]: [f64; 2]) -> Option<Line> {
        let step_hz = 1.0 / (self.length() as f64 * self.period_s);
        let at = |place: usize| place as f64 * step_hz;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a line")]
        let places = |from_hz: f64, to_hz: f64| {
            (from_hz / step_hz).max(1.0) as usize..((to_hz / step_hz) as usize + 2).min(powers.len())
        };
        let inside = |place: &usize| (from_hz..=to_hz).contains(&at(*place)) && place + 1 < powers.len();
        let within = places(from_hz, to_hz).filter(inside);
        let best = within.max_by(|&a, &b| powers[a].total_cmp(&powers[b]))?;
        let power = powers[best];
        // the top of the parabola through the logarithms about it
        let [before, own, after] = [best - 1, best, best + 1].map(|place| powers[place].max(1e-300).ln());
        let off = 0.5 * (before - after) / (before - 2.0 * own + after).min(-1e-12);
        let hz = at(best) + off.clamp(-0.5, 0.5) * step_hz;
        let aside = |place: &usize| (self.wide_hz()..AROUND_HZ).contains(&(at(*place) - hz).abs());
        let mut others: Vec<f64> =
            places(hz - AROUND_HZ, hz + AROUND_HZ).filter(aside).map(|place| powers[place]).collect();
        if others.is_empty() {
            return None;
        }
        let beside = others.iter().copied().fold(0.0, f64::max);
        let noise = noise(&mut others);
        Some(Line { hz, power, noise, beside })
    }

    /// What a line takes of the transform, and no other may.
    fn wide_hz(&self) -> f64 {
        WIDE / (self.values.len() as f64 * self.period_s)
    }

    /// Where a line is looked for again.
    pub(super) fn near_hz(&self, hz: f64) -> [f64; 2] {
        [hz - 0.5 * self.wide_hz(), hz + 0.5 * self.wide_hz()]
    }
}

/// Sum of a window's squares.
pub(super) fn power(window: &[f64]) -> f64 {
    window.iter().map(|w| w * w).sum()
}

/// Mean power of noise by its median: that of a chi square of two degrees.
fn noise(powers: &mut [f64]) -> f64 {
    let middle = powers.len() / 2;
    (*powers.select_nth_unstable_by(middle, f64::total_cmp).1 / LN_2).max(1e-300)
}

/// A line of a transform.
pub(super) struct Line {
    pub(super) hz: f64,
    pub(super) power: f64,
    /// Power of noise about it, and of the strongest line there.
    pub(super) noise: f64,
    pub(super) beside: f64,
}
