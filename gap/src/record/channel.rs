//! A measured output.

use gimbal_log::Column;

use super::converter::Converter;
use super::rough::rough;
use super::spikes::spikes;

/// What an output is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    /// Pick-off.
    GyroAngle,
    /// Motor torque.
    MotorTorque,
    /// Stable member against an outside reference.
    GimbalAngle,
}

impl Signal {
    /// All of them, in the order of channels.
    pub const ALL: [Self; 3] = [Self::GyroAngle, Self::MotorTorque, Self::GimbalAngle];

    /// Column of the log.
    #[must_use]
    pub fn column(self) -> Column {
        match self {
            Self::GyroAngle => Column::GyroAngle,
            Self::MotorTorque => Column::MotorTorque,
            Self::GimbalAngle => Column::GimbalAngle,
        }
    }
}

/// Rows for which a value is held.
const HELD: usize = 5;
/// Longest time from whose samples the beginning is taken, and how many there must be [s].
const BEGINNING_S: f64 = 0.02;
const FEWEST: usize = 4;

/// Rows that show noise, and share of a channel's samples that must end such a run.
const SIDE_BY_SIDE: usize = 4;
const SPARSE: f64 = 0.1;

/// What a line through the beginning may leave, over the noise.
const BENT: f64 = 2.0;

/// A line through the first samples.
struct Line {
    /// Its first value.
    begins: f64,
    /// Rms of what it leaves.
    leaves: f64,
}

/// One measured output on the grid.
#[derive(Debug, Clone)]
pub struct Channel {
    /// What it is.
    pub signal: Signal,
    /// Samples; 0 where there is none.
    pub values: Vec<f64>,
    /// Whether a sample counts.
    pub valid: Vec<bool>,
    /// Lines of hum that were taken out [Hz].
    pub(super) hums_hz: Vec<f64>,
    /// What writes it, where that has coarse steps.
    pub(super) converter: Option<Converter>,
}

impl Channel {
    pub(super) fn new(signal: Signal, mut values: Vec<f64>) -> Self {
        let valid: Vec<bool> = values.iter().map(|value| value.is_finite()).collect();
        for value in &mut values {
            if !value.is_finite() {
                *value = 0.0;
            }
        }
        let converter = Converter::of(&values, &valid);
        Self { signal, values, valid, hums_hz: Vec::new(), converter }
    }

    /// What it reads on the average.
    pub(crate) fn reads(&self, value: f64) -> f64 {
        self.converter.map_or(value, |converter| converter.reads(value))
    }

    /// Whether the log has no sample there.
    pub(crate) fn is_missing(&self, row: usize) -> bool {
        !self.valid[row] && self.values[row] == 0.0
    }

    /// What of it, if too few of its samples stand side by side to show their noise.
    pub(super) fn told_sparse(&self) -> Option<String> {
        let side_by_side = self.valid.windows(SIDE_BY_SIDE).filter(|few| few.iter().all(|valid| *valid)).count();
        let samples = self.valid.iter().filter(|valid| **valid).count();
        (side_by_side as f64 <= SPARSE * samples as f64).then(|| {
            let (name, rows) = (self.signal.column().name(), self.valid.len());
            format!("{name} has {samples} samples in {rows} rows, hardly any {SIDE_BY_SIDE} of them in a row")
        })
    }

    /// Largest size of a value that is held for a few rows.
    pub(crate) fn held_peak(&self) -> f64 {
        let sizes: Vec<f64> =
            self.values.iter().zip(&self.valid).map(|(value, valid)| if *valid { value.abs() } else { 0.0 }).collect();
        sizes.windows(HELD).map(|few| few.iter().copied().fold(f64::MAX, f64::min)).fold(0.0, f64::max)
    }

    /// Value with which it begins, of the longest line through its first samples that leaves no more than its noise; none
    /// where most of them are missing.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of rows")]
    pub(super) fn beginning(&self, period_s: f64) -> Option<f64> {
        let longest = ((BEGINNING_S / period_s) as usize).max(FEWEST).min(self.values.len());
        let noise = rough(&self.values, &self.valid);
        let halved = std::iter::successors(Some(longest), |rows| Some(rows / 2).filter(|rows| *rows >= FEWEST));
        let lines: Vec<Line> = halved.map_while(|rows| self.line(rows)).collect();
        let straight = lines.iter().find(|line| line.leaves < BENT * noise);
        straight.or(lines.last()).map(|line| line.begins)
    }

    /// The line through its first rows; none where most of them are missing.
    fn line(&self, rows: usize) -> Option<Line> {
        let known: Vec<(f64, f64)> =
            (0..rows).filter(|&row| self.valid[row]).map(|row| (row as f64, self.values[row])).collect();
        if known.len() < FEWEST || 2 * known.len() < rows {
            return None;
        }
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| known.iter().map(of).sum::<f64>() / known.len() as f64;
        let (row, value) = (mean(&|known| known.0), mean(&|known| known.1));
        let slope = mean(&|known| (known.0 - row) * (known.1 - value)) / mean(&|known| (known.0 - row).powi(2));
        let leaves = mean(&|known| (known.1 - value - slope * (known.0 - row)).powi(2)).sqrt();
        Some(Line { begins: value - slope * row, leaves })
    }

    /// Takes samples that stand alone for missing, and says so.
    pub(super) fn without_spikes(&mut self) -> Option<String> {
        let found = spikes(&self.values, &self.valid);
        for &(row, value) in &found {
            (self.values[row], self.valid[row]) = (value, false);
        }
        let name = self.signal.column().name();
        let told =
            || format!("{} of {} samples of {name} stand alone: they do not count", found.len(), self.values.len());
        (!found.is_empty()).then(told)
    }
}

#[cfg(test)]
mod tests {
    use super::{Channel, Signal};

    #[test]
    fn closed_form_every_other_row_is_sparse_and_a_few_gaps_are_not() {
        let of = |every: usize| -> Channel {
            let value = |k: usize| if k.is_multiple_of(every) { f64::NAN } else { 1.0 };
            Channel::new(Signal::GimbalAngle, (0..1000).map(value).collect())
        };
        assert!(of(2).told_sparse().is_some_and(|told| told.contains("500 samples in 1000 rows")));
        assert!(of(4).told_sparse().is_some());
        assert!(of(20).told_sparse().is_none());
    }

    #[test]
    fn closed_form_a_peak_is_held_for_some_rows_that_count() {
        let channel = |values: &[f64]| Channel::new(Signal::GyroAngle, values.to_vec());
        let held = [0.0, 9.0, 1.0, -3.0, -4.0, -3.5, -4.0, -3.0, 1.0];
        assert!((channel(&held).held_peak() - 3.0).abs() < 1e-15);
        let mut missing = held;
        missing[5] = f64::NAN;
        assert!((channel(&missing).held_peak() - 0.0).abs() < 1e-15);
    }

    #[test]
    fn closed_form_a_beginning_is_that_of_the_longest_line() {
        let begins = |value: fn(usize) -> f64| {
            let values = (0..1000).map(|row| value(row) + 1e-3 * [1.0, -1.0, -0.5, 0.5][row % 4]).collect();
            Channel::new(Signal::MotorTorque, values).beginning(1e-3).expect("samples")
        };
        let straight = begins(|row| 3.0 + 0.1 * row as f64);
        assert!((straight - 3.0).abs() < 1e-3, "{straight}");
        // it jumps after 12 ms
        let jumps = begins(|row| if row < 12 { 3.0 } else { 9.0 });
        assert!((jumps - 3.0).abs() < 2e-3, "{jumps}");
    }
}
