//! Hum of a sensor: lines of the supply, 50 Hz or 60 Hz on the ground, 400 Hz on board, and their first multiples, no larger
//! than its noise. It is that sensor's own; a torque that beats so would be a line of every output, and a larger one.
//!
//! ```text
//! x(t) - A cos(2 pi f t) - B sin(2 pi f t)        A, B by least squares under Hann's window, f where they take most
//! ```
//!
//! A line of an input may be the vehicle's vibration. The outputs tell: what drives the platform is in them, hum of an
//! input is in what the prediction leaves of them. Where they tell nothing, what is larger than the sensor's noise is
//! vibration.

use gimbal_log::Column;

use super::series::{Line, STANDS_OUT, Series, power};
use super::{RateNoise, Record, filled};
use crate::simulate::{Inputs, Physics, Prediction};
use crate::window::hann;

/// Frequencies of supplies, and how far one may be off [Hz], [1].
const SUPPLIES: [(f64, f64); 3] = [(50.0, 0.004), (60.0, 0.004), (400.0, 0.02)];
/// Multiples that are looked at.
const MULTIPLES: [f64; 3] = [1.0, 2.0, 3.0];
/// Highest frequency that is looked at, over the rate of rows.
const HIGHEST: f64 = 0.49;
/// Fewest rows in which a line can be told.
const LEAST_ROWS: usize = 2048;
/// Power over that of the strongest line beside it; and of a line that is predicted at its place, over its own, at most.
const ALONE: f64 = 2.5;
const PREDICTED: f64 = 0.1;
/// The same of all that is predicted there, of which parameters a little off leave a share.
const MISJUDGED: f64 = 100.0;
/// Amplitude at most, over the noise about it, in a row; a line of an input that is larger over the noise of the upper half of
/// the band is vibration, unless the outputs tell otherwise.
const LARGEST: f64 = 3.0;

/// Parts of the log that must have the line of the whole, and how far each may be off: of its amplitude, and of the deviations
/// that noise makes.
const PARTS: usize = 4;
const UNSTEADY: f64 = 0.3;
const LEAST_OFF: f64 = 4.0;

/// A line that was taken out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hum {
    pub(super) hz: f64,
    pub(super) amplitude: f64,
    /// Over the noise of the upper half of the band, in a row.
    over_noise: f64,
}

impl Hum {
    /// For the report.
    pub(super) fn told(&self, column: Column) -> String {
        format!("{} hums at {:.2} Hz with an amplitude of {:.1e}: taken out", column.name(), self.hz, self.amplitude)
    }
}

/// Inputs that may hum.
const DRIVEN: [Column; 5] = [Column::AccelX, Column::AccelY, Column::AccelZ, Column::VehicleRate, Column::CrossRate];

impl Record {
    /// Takes hum out of each input, as far as the outputs let it be hum; what is predicted then.
    pub(super) fn hush_inputs(&mut self, physics: &Physics, as_logged: Prediction) -> Prediction {
        let mut nominal = as_logged;
        for column in DRIVEN {
            let mut inputs = self.inputs.clone();
            let own = driven(&mut inputs, column);
            let all = vec![true; own.len()];
            let found = without_hum(own, &all, None, &[], self.inputs.period_s);
            if found.is_empty() {
                continue;
            }
            inputs.complete(&physics.config.bearing, self.inputs.turned_rad[0]);
            let without = self.predicted(physics, &inputs);
            let vibrates = found.iter().any(|hum| hum.over_noise > LARGEST);
            let needed = if vibrates { STANDS_OUT } else { -STANDS_OUT };
            if self.lines_left(&nominal, &found) - self.lines_left(&without, &found) > needed {
                self.notes.extend(found.iter().map(|hum| hum.told(column)));
                self.rate_noise = RateNoise::logged(&inputs.rate_radps);
                (self.inputs, nominal) = (inputs, without);
            }
        }
        nominal
    }

    /// Power of lines in what a prediction leaves of the outputs, over the noise about them, summed [nats].
    fn lines_left(&self, prediction: &Prediction, lines: &[Hum]) -> f64 {
        let of = |channel: &super::Channel| {
            let predicted = crate::fit::predicted(channel.signal, prediction);
            let left = channel.values.iter().zip(predicted).map(|(value, own)| value - own);
            let left: Vec<f64> =
                left.zip(&channel.valid).map(|(left, valid)| if *valid { left } else { 0.0 }).collect();
            let series = Series { window: hann(left.len()), values: left, period_s: self.inputs.period_s };
            let powers = series.powers(&series.values).unwrap_or_default();
            let over = |hum: &Hum| {
                series.strongest(&powers, series.near_hz(hum.hz)).map_or(0.0, |line| line.power / line.noise)
            };
            lines.iter().map(over).sum::<f64>()
        };
        self.channels.iter().map(of).sum()
    }

    /// The record without hum in its outputs, where what a prediction leaves of them shows any.
    pub(crate) fn hushed(&self, prediction: &Prediction) -> Option<Self> {
        let mut hushed: Option<Self> = None;
        for (place, channel) in self.channels.iter().enumerate() {
            let predicted = crate::fit::predicted(channel.signal, prediction);
            let mut left: Vec<f64> = channel.values.iter().zip(predicted).map(|(value, own)| value - own).collect();
            let (moves, known_hz) = (Some(predicted), &channel.hums_hz[..]);
            let found = without_hum(&mut left, &channel.valid, moves, known_hz, self.inputs.period_s);
            if found.is_empty() {
                continue;
            }
            let hushed = hushed.get_or_insert_with(|| self.clone());
            hushed.channels[place].values = left.iter().zip(predicted).map(|(left, own)| left + own).collect();
            hushed.channels[place].hums_hz.extend(found.iter().map(|hum| hum.hz));
            // what is left is on no steps
            hushed.channels[place].converter = None;
            hushed.notes.extend(found.iter().map(|hum| hum.told(channel.signal.column())));
        }
        hushed
    }
}

/// An input by its column.
fn driven(inputs: &mut Inputs, column: Column) -> &mut Vec<f64> {
    match column {
        Column::AccelX => &mut inputs.accel_mps2[0],
        Column::AccelY => &mut inputs.accel_mps2[1],
        Column::AccelZ => &mut inputs.accel_mps2[2],
        Column::CrossRate => &mut inputs.cross_radps,
        _ => &mut inputs.rate_radps,
    }
}

/// Takes hum out of a series, and tells its lines. Rows that do not count stay as they are. A line that what is predicted of
/// the series has too is the platform's; what is left of one that was known to be hum need not be as it is all along.
pub(super) fn without_hum(
    values: &mut [f64],
    valid: &[bool],
    predicted: Option<&[f64]>,
    known_hz: &[f64],
    period_s: f64,
) -> Vec<Hum> {
    if values.len() < LEAST_ROWS {
        return Vec::new();
    }
    let known = values.iter().zip(valid).map(|(value, valid)| if *valid { *value } else { f64::NAN });
    let series = filled(&known.collect::<Vec<f64>>());
    let mut series = Series { values: series, window: hann(values.len()), period_s };
    let mut found = Vec::new();
    let Some(mut powers) = series.powers(&series.values) else { return found };
    let moves = predicted.and_then(|predicted| series.powers(predicted));
    for (supply_hz, off) in SUPPLIES {
        for hz in MULTIPLES.map(|multiple| multiple * supply_hz) {
            let between_hz = [hz * (1.0 - off), hz * (1.0 + off)];
            if between_hz[1] * period_s > HIGHEST {
                continue;
            }
            let known = known_hz.iter().any(|own| (between_hz[0]..=between_hz[1]).contains(own));
            let Some(line) = series.hum(&powers, moves.as_deref(), between_hz, known) else { continue };
            found.push(series.take_out(line.hz, series.floor(&powers)));
            let Some(without) = series.powers(&series.values) else { break };
            powers = without;
        }
    }
    for (value, (own, _)) in values.iter_mut().zip(series.values.iter().zip(valid)).filter(|(_, (_, valid))| **valid) {
        *value = *own;
    }
    found
}

impl Series {
    /// Whether a line is as it is in each part of the log: the supply hums on, a vehicle shakes as it drives.
    fn steady(&self, line: &Line) -> bool {
        let all = self.amplitudes(line.hz, &self.window, 0);
        let part = hann(self.values.len() / PARTS);
        let deviation = 2.0 * (line.noise / power(&self.window) * power(&part)).sqrt() / part.iter().sum::<f64>();
        let within = UNSTEADY * all[0].hypot(all[1]) + LEAST_OFF * deviation;
        (0..PARTS).all(|place| {
            let own = self.amplitudes(line.hz, &part, place * part.len());
            (own[0] - all[0]).hypot(own[1] - all[1]) < within
        })
    }

    /// Takes a line of one frequency out of a series of such noise.
    fn take_out(&mut self, hz: f64, noise: f64) -> Hum {
        let [sine, cosine] = self.amplitudes(hz, &self.window, 0);
        for row in 0..self.values.len() {
            let (sin, cos) = self.wave(hz, row);
            self.values[row] -= sine * sin + cosine * cos;
        }
        let amplitude = sine.hypot(cosine);
        Hum { hz, amplitude, over_noise: amplitude / noise }
    }

    /// The strongest line between two frequencies, if it may be hum: no larger than that, none of many side by side, as a motion
    /// has that comes again and again, none that what moves has, too, or may have left, and the same all along.
    fn hum(&self, powers: &[f64], moves: Option<&[f64]>, between_hz: [f64; 2], known: bool) -> Option<Line> {
        // (A sum w / 2)^2 over sigma^2 sum w^2
        let sum: f64 = self.window.iter().sum();
        let largest = (0.5 * LARGEST * sum).powi(2) / power(&self.window);
        let line = self.line(powers, between_hz)?;
        let near_hz = self.near_hz(line.hz);
        let moved = moves.and_then(|moves| self.line(moves, near_hz)).map_or(0.0, |moved| moved.power);
        let moved_in_all = moves.and_then(|moves| self.strongest(moves, near_hz)).map_or(0.0, |moved| moved.power);
        let small = line.power < largest * line.noise;
        let moves = moved > PREDICTED * line.power || !known && moved_in_all > MISJUDGED * line.power;
        let alone = line.power > ALONE * line.beside && !moves;
        (small && alone && (known || self.steady(&line))).then_some(line)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::without_hum;

    fn series(amplitude: f64, hz: f64) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let slow = |t: f64| 3e3 * (TAU * 0.3 * t).sin();
        let of = |k: u32| {
            let t = 1e-3 * f64::from(k);
            slow(t) + rng.sample::<f64, _>(StandardNormal) + amplitude * (TAU * hz * t + 0.4).sin()
        };
        (0..15_000).map(of).collect()
    }

    #[test]
    fn closed_form_a_line_of_a_supply_is_taken_out_and_no_other() {
        let valid: Vec<bool> = (0..15_000).map(|k| !(4000..4020).contains(&k)).collect();
        for (amplitude, hz, lines) in
            [(0.3, 50.02, 1), (0.5, 401.1, 1), (0.3, 149.95, 1), (0.0, 50.0, 0), (0.5, 55.0, 0), (8.0, 50.0, 0)]
        {
            let mut values = series(amplitude, hz);
            let found = without_hum(&mut values, &valid, None, &[], 1e-3);
            assert_eq!(found.len(), lines, "{amplitude} at {hz}: {found:?}");
            for hum in found {
                assert!((hum.hz - hz).abs() < 0.02 && (hum.amplitude - amplitude).abs() < 0.04, "{hum:?}");
                let left: f64 = series(0.0, hz)
                    .iter()
                    .zip(&values)
                    .zip(&valid)
                    .filter(|row| *row.1)
                    .map(|((a, b), _)| (a - b).powi(2))
                    .sum();
                assert!((left / 14_980.0).sqrt() < 0.04, "{left}");
            }
        }
    }

    #[test]
    fn closed_form_a_line_that_comes_and_goes_or_is_predicted_is_left() {
        let valid = vec![true; 15_000];
        let of = |k: u32| (TAU * 50.02e-3 * f64::from(k)).sin();
        let louder = |rows: u32| -> Vec<f64> {
            series(0.3, 50.02).iter().zip(0..).map(|(x, k)| x + if k < rows { 0.7 * of(k) } else { 0.0 }).collect()
        };
        assert_eq!(without_hum(&mut louder(0), &valid, None, &[], 1e-3).len(), 1);
        assert_eq!(without_hum(&mut louder(4000), &valid, None, &[], 1e-3).len(), 0);
        // twelve lines a hertz apart, none of which stands out of the others
        let shakes =
            |k: u32| (0..12).map(|line| 3.0 * (TAU * (44.0 + f64::from(line)) * 1e-3 * f64::from(k)).sin()).sum();
        let predicted: Vec<f64> = (0..15_000).map(shakes).collect();
        assert_eq!(without_hum(&mut louder(0), &valid, Some(&predicted), &[], 1e-3).len(), 0);
    }
}
