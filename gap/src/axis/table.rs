//! A foreign CSV file as the signals of an axis, in the units of its model, on one constant rate.

use std::path::{Path, PathBuf};

use gimbal_model_file::AxisModel;
use gimbal_model_file::axis::{Quantity, Source};
use thiserror::Error;

use super::library::rms;

/// Why a log cannot be read.
#[derive(Debug, Error)]
pub enum AxisLogError {
    /// The file itself.
    #[error("{}: cannot be read: {error}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What went wrong.
        error: std::io::Error,
    },
    /// A place in it.
    #[error("{}: line {line}{}: {message}", file.display(), column.as_ref().map(|c| format!(", column `{c}`")).unwrap_or_default())]
    Row {
        /// The file.
        file: PathBuf,
        /// Line, counted from 1.
        line: u64,
        /// Name of the column.
        column: Option<String>,
        /// What is wrong, and what would be right.
        message: String,
    },
    /// All of it.
    #[error("{}: {message}", file.display())]
    Content {
        /// The file.
        file: PathBuf,
        /// What is wrong, and what would be right.
        message: String,
    },
}

/// The signals of an axis.
#[derive(Debug, Clone, Default)]
pub struct AxisLog {
    /// Rows in the file.
    pub rows: usize,
    /// Time of the first row [s].
    pub first_s: f64,
    /// Period of the rows [s].
    pub period_s: f64,
    /// Position [m or rad].
    pub position: Option<Vec<f64>>,
    /// Rate as logged.
    pub velocity: Option<Vec<f64>>,
    /// What the position shall be.
    pub position_reference: Option<Vec<f64>>,
    /// What the rate shall be.
    pub velocity_reference: Option<Vec<f64>>,
    /// Effort.
    pub effort: Vec<f64>,
    /// Output of the controller.
    pub command: Option<Vec<f64>>,
    /// Other channels that vary.
    pub auxiliary: Vec<(String, Vec<f64>)>,
    /// Rows that are measured, not in a gap.
    pub valid: Vec<bool>,
    /// What was done to the rows.
    pub notes: Vec<String>,
}

/// Intervals may differ from the period by this share of it before rows are interpolated.
const JITTER: f64 = 0.02;
/// A gap is longer than this many periods.
const GAP: f64 = 3.5;
/// Fewer rows say nothing.
const LEAST_ROWS: usize = 400;

/// What hangs on a channel that changes by less of its mean is what hangs on nothing.
const LEAST_CHANGE: f64 = 0.01;

/// Standard deviation of what is finite, over the size of its mean.
fn changes(values: &[f64]) -> f64 {
    let finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let mean = finite.iter().sum::<f64>() / finite.len().max(1) as f64;
    let spread = rms(&finite.iter().map(|value| value - mean).collect::<Vec<_>>());
    if finite.iter().all(|value| value.to_bits() == finite[0].to_bits()) {
        0.0
    } else {
        spread / mean.abs().max(1e-300)
    }
}

struct Wanted<'a> {
    source: &'a Source,
    quantity: Quantity,
    place: Option<usize>,
    values: Vec<f64>,
}

impl AxisLog {
    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong, where, and what would be right.
    pub fn open(path: &Path, model: &AxisModel) -> Result<Self, AxisLogError> {
        let file = std::fs::File::open(path).map_err(|error| AxisLogError::Io { file: path.to_owned(), error })?;
        Self::read(std::io::BufReader::new(file), path, model)
    }

    /// Reads a file's text; `path` is its name in messages.
    ///
    /// # Errors
    /// What is wrong, where, and what would be right.
    pub fn read(text: impl std::io::Read, path: &Path, model: &AxisModel) -> Result<Self, AxisLogError> {
        let content = |message: String| AxisLogError::Content { file: path.to_owned(), message };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text);
        let header = reader.headers().map_err(|error| content(format!("has no header: {error}")))?.clone();
        let columns = &model.columns;
        let needed = [Some((&columns.time, Quantity::Time)), Some((&columns.effort, Quantity::Effort))];
        let motion = [(&columns.position, Quantity::Position), (&columns.velocity, Quantity::Rate)];
        let others = [
            (&columns.position_reference, Quantity::Position),
            (&columns.velocity_reference, Quantity::Rate),
            (&columns.command, Quantity::Any),
        ];
        let optional = motion.into_iter().chain(others).map(|(s, quantity)| s.as_ref().map(|s| (s, quantity)));
        let auxiliary = columns.auxiliary.values().map(|source| Some((source, Quantity::Any)));
        let place = |source: &Source| header.iter().position(|name| name.trim_start_matches('\u{feff}') == source.name);
        let mut wanted: Vec<Option<Wanted>> = needed
            .into_iter()
            .chain(optional)
            .chain(auxiliary)
            .map(|entry| {
                entry.map(|(source, quantity)| Wanted { source, quantity, place: place(source), values: Vec::new() })
            })
            .collect();
        let listed = header.iter().collect::<Vec<_>>().join(", ");
        let mut notes = Vec::new();
        for (index, entry) in wanted.iter().enumerate() {
            let Some(entry) = entry else { continue };
            if entry.place.is_none() {
                let name = &entry.source.name;
                if index < 2 {
                    return Err(content(format!(
                        "has no column `{name}`, which [axis.columns] names; it has {listed}"
                    )));
                }
                notes.push(format!("no column `{name}` in this file"));
            }
        }
        if wanted[2..4].iter().all(|entry| entry.as_ref().is_none_or(|entry| entry.place.is_none())) {
            return Err(content(format!(
                "has neither position nor velocity as [axis.columns] names them; it has {listed}"
            )));
        }
        let mut record = csv::StringRecord::new();
        loop {
            let line = reader.position().line();
            let row = |column: Option<&str>, message: String| AxisLogError::Row {
                file: path.to_owned(),
                line,
                column: column.map(str::to_owned),
                message,
            };
            match reader.read_record(&mut record) {
                Ok(false) => break,
                Ok(true) => {}
                Err(error) => return Err(row(None, format!("{error}"))),
            }
            for entry in wanted.iter_mut().flatten() {
                let Some(place) = entry.place else { continue };
                let cell = record.get(place).unwrap_or_default();
                let value = if cell.is_empty() || cell.eq_ignore_ascii_case("nan") {
                    f64::NAN
                } else {
                    let size = model.size(entry.source, entry.quantity);
                    let number: Option<f64> = cell.parse().ok().filter(|number: &f64| number.is_finite());
                    size * number.ok_or_else(|| {
                        row(
                            Some(&entry.source.name),
                            format!("\"{cell}\" is not a finite number; leave a missing sample empty"),
                        )
                    })?
                };
                entry.values.push(value);
            }
        }
        let mut values = wanted.into_iter().map(|entry| entry.filter(|e| e.place.is_some()).map(|e| e.values));
        let mut next = || values.next().flatten();
        let (time, effort) = (next().unwrap_or_default(), next().unwrap_or_default());
        let mut log = Self {
            rows: time.len(),
            position: next(),
            velocity: next(),
            position_reference: next(),
            velocity_reference: next(),
            command: next(),
            effort,
            notes,
            ..Self::default()
        };
        for (name, values) in columns.auxiliary.keys().zip(values) {
            if let Some(values) = values {
                log.auxiliary.push((name.clone(), values));
            }
        }
        log.even(&time).map_err(content)?;
        log.auxiliary.retain(|(name, values)| {
            let changes = changes(values);
            if changes < LEAST_CHANGE {
                let much = if changes == 0.0 { "never changes" } else { "changes by less than a hundredth of itself" };
                log.notes.push(format!("{name} {much} in this file: nothing is told to hang on it"));
            }
            changes >= LEAST_CHANGE
        });
        Ok(log)
    }

    /// Every channel, in one order.
    fn channels(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        std::iter::once(&mut self.effort)
            .chain(self.position.as_mut())
            .chain(self.velocity.as_mut())
            .chain(self.position_reference.as_mut())
            .chain(self.velocity_reference.as_mut())
            .chain(self.command.as_mut())
            .chain(self.auxiliary.iter_mut().map(|(_, values)| values))
    }

    /// Brings the rows to a constant rate, where they are not, and marks what is missing.
    fn even(&mut self, time: &[f64]) -> Result<(), String> {
        if time.len() < LEAST_ROWS {
            return Err(format!("has {} rows; {LEAST_ROWS} are the least that a balance needs", time.len()));
        }
        if let Some(place) = time.iter().position(|t| !t.is_finite()) {
            return Err(format!("line {}: the time is missing", place + 2));
        }
        if let Some(place) = time.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(format!(
                "line {}: time goes from {} to {} s; it must rise",
                place + 3,
                time[place],
                time[place + 1]
            ));
        }
        let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let (count, whole) = (steps.len(), time[time.len() - 1] - time[0]);
        steps.sort_by(f64::total_cmp);
        let median = steps[count / 2];
        let (shortest, longest) = (steps[0], steps[count - 1]);
        let off = steps.iter().filter(|step| (*step - median).abs() > JITTER * median).count();
        self.first_s = time[0];
        if off == 0 {
            self.period_s = whole / count as f64;
            self.valid = vec![true; time.len()];
        } else {
            self.period_s = median;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of rows")]
            let rows = (whole / median).round() as usize + 1;
            let mut at = 0;
            let picks: Vec<(usize, f64, bool)> = (0..rows)
                .map(|k| {
                    let t = time[0] + k as f64 * median;
                    while at + 2 < time.len() && time[at + 1] < t {
                        at += 1;
                    }
                    let step = time[at + 1] - time[at];
                    (at, ((t - time[at]) / step).clamp(0.0, 1.0), step < GAP * median)
                })
                .collect();
            self.valid = picks.iter().map(|pick| pick.2).collect();
            for channel in self.channels() {
                let even = |&(at, share, _): &(usize, f64, bool)| channel[at] + share * (channel[at + 1] - channel[at]);
                *channel = picks.iter().map(even).collect();
            }
            self.notes.push(format!(
                "{:.1} % of the intervals differ from {median:.6} s (from {shortest:.6} to {longest:.6} s): rows interpolated",
                100.0 * off as f64 / count as f64
            ));
        }
        let mut valid = std::mem::take(&mut self.valid);
        let mut missing = 0;
        for channel in self.channels() {
            let mut last = channel.iter().copied().find(|value| value.is_finite()).unwrap_or(0.0);
            for (value, valid) in channel.iter_mut().zip(&mut valid) {
                if value.is_finite() {
                    last = *value;
                } else {
                    (*value, *valid) = (last, false);
                    missing += 1;
                }
            }
        }
        if missing > 0 {
            self.notes.push(format!("{missing} missing samples are left out"));
        }
        self.valid = valid;
        Ok(())
    }
}
