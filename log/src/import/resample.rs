//! Rows at any times onto one constant rate, by straight lines; nothing in silence.

use crate::{Column, Log, TimeReport};

/// A span without a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Last sample before it [s].
    pub from_s: f64,
    /// First sample behind it [s].
    pub to_s: f64,
}

/// A log at a constant rate, and what was done to get there.
#[derive(Debug, Clone)]
pub struct Resampled {
    /// The log; extra columns of numbers are in it, others are left out, because text has no value between two rows.
    pub log: Log,
    /// Time stamps of the source.
    pub source: TimeReport,
    /// Rows that were averaged into others with the same time stamp.
    pub averaged_rows: usize,
    /// Spans of 1.5 source periods and more that straight lines cross.
    pub bridged: Vec<Span>,
    /// Missing samples that straight lines cross, by column.
    pub bridged_missing: Vec<(Column, usize)>,
    /// Extra columns that were left out.
    pub dropped: Vec<String>,
}

impl Resampled {
    /// A log that is at its rate already, with everything in it.
    #[must_use]
    pub fn untouched(source: &Log) -> Self {
        Self {
            log: source.clone(),
            source: source.time.clone(),
            averaged_rows: 0,
            bridged: Vec::new(),
            bridged_missing: Vec::new(),
            dropped: Vec::new(),
        }
    }

    /// Seconds that are crossed by lines of 1.5 source periods and more.
    #[must_use]
    pub fn bridged_s(&self) -> f64 {
        self.bridged.iter().fold(0.0, |sum, span| sum + span.to_s - span.from_s)
    }
}

/// Resamples the span `from_s..=to_s` of a log; times on whole multiples of the period.
///
/// Rows with the same time stamp are averaged. Between rows the values run along straight lines; a missing sample
/// is crossed by the line between its neighbours in the same column, and stays missing at the ends.
///
/// # Errors
/// One line: the rate is not positive, or no two rows lie in the span.
#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "row counts are far below 2^53")]
pub fn resample(source: &Log, rate_hz: f64, from_s: f64, to_s: f64) -> Result<Resampled, String> {
    if !(rate_hz > 0.0 && rate_hz <= 1e6) {
        return Err(format!("the rate is {rate_hz} Hz; it must lie between 0 and 1000000 Hz"));
    }
    let times_s = source.column(Column::Time).unwrap_or_default();
    let kept: Vec<usize> = (0..times_s.len()).filter(|&row| times_s[row] >= from_s && times_s[row] <= to_s).collect();
    let (groups, instants_s) = same_instants(times_s, &kept);
    let (Some(&first_s), Some(&last_s), true) = (instants_s.first(), instants_s.last(), instants_s.len() > 1) else {
        return Err(format!("there are {} time stamps in the span; two are needed", instants_s.len()));
    };
    // A time stamp that is a multiple but for rounding counts as one.
    let first_tick = (first_s * rate_hz - 1e-6).ceil() as i64;
    let last_tick = (last_s * rate_hz + 1e-6).floor() as i64;
    let ticks_s: Vec<f64> = (first_tick..=last_tick).map(|tick| tick as f64 / rate_hz).collect();
    let gap_s = 1.5 * source.time.period_s;
    let mut result = Resampled {
        log: Log::default(),
        source: source.time.clone(),
        averaged_rows: kept.len() - instants_s.len(),
        bridged: instants_s
            .windows(2)
            .filter(|pair| pair[1] - pair[0] >= gap_s)
            .map(|pair| Span { from_s: pair[0], to_s: pair[1] })
            .collect(),
        bridged_missing: Vec::new(),
        dropped: Vec::new(),
    };
    let means = |values: &[f64]| groups.iter().map(|&(from, to)| mean(&kept[from..to], values)).collect::<Vec<f64>>();
    let points = |means: Vec<f64>| -> Vec<(f64, f64)> {
        instants_s.iter().copied().zip(means).filter(|(_, value)| !value.is_nan()).collect()
    };
    for extra in source.extras() {
        match extra.all_numbers() {
            Some(values) => {
                result.log.push_extra(&extra.name, &along(&points(means(&values)), &ticks_s));
            }
            None => result.dropped.push(extra.name.clone()),
        }
    }
    for column in Column::ALL.into_iter().filter(|column| *column != Column::Time) {
        let Some(values) = source.column(column) else { continue };
        let points = points(means(values));
        let missing = instants_s.len() - points.len();
        if missing > 0 {
            result.bridged_missing.push((column, missing));
        }
        result.log.set(column, along(&points, &ticks_s));
    }
    result.log.set(Column::Time, ticks_s);
    Ok(result)
}

/// Runs of rows that share a time stamp, and those time stamps.
#[allow(clippy::float_cmp, reason = "a repeated time stamp repeats to the bit")]
fn same_instants(times_s: &[f64], kept: &[usize]) -> (Vec<(usize, usize)>, Vec<f64>) {
    let mut groups: Vec<(usize, usize)> = Vec::new();
    let mut instants_s: Vec<f64> = Vec::new();
    for (place, &row) in kept.iter().enumerate() {
        if instants_s.last() == Some(&times_s[row]) {
            if let Some(group) = groups.last_mut() {
                group.1 = place + 1;
            }
        } else {
            groups.push((place, place + 1));
            instants_s.push(times_s[row]);
        }
    }
    (groups, instants_s)
}

/// Mean of the samples that are there.
#[allow(clippy::cast_precision_loss, reason = "a handful of rows")]
fn mean(rows: &[usize], values: &[f64]) -> f64 {
    let there = rows.iter().map(|&row| values[row]).filter(|value| !value.is_nan());
    let (count, sum) = there.fold((0_usize, 0.0), |(count, sum), value| (count + 1, sum + value));
    if count == 0 { f64::NAN } else { sum / count as f64 }
}

/// Values at the ticks on the lines through the points; NaN outside of them.
fn along(points: &[(f64, f64)], ticks_s: &[f64]) -> Vec<f64> {
    let mut right = 0;
    ticks_s
        .iter()
        .map(|&tick_s| {
            while right < points.len() && points[right].0 < tick_s {
                right += 1;
            }
            let near = |index: usize| points.get(index).filter(|point| (point.0 - tick_s).abs() < 1e-9);
            if let Some(point) = near(right).or_else(|| right.checked_sub(1).and_then(near)) {
                return point.1;
            }
            match (right.checked_sub(1).and_then(|left| points.get(left)), points.get(right)) {
                (Some(left), Some(right)) => left.1 + (right.1 - left.1) * (tick_s - left.0) / (right.0 - left.0),
                _ => f64::NAN,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use super::resample;
    use crate::{Column, Log, Needs};

    #[test]
    fn closed_form_a_straight_line_stays_one_through_gaps_and_repeats() {
        let mut text = "time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_radps,note,height\n".to_owned();
        for time_s in [-0.02, -0.01, 0.0, 0.01, 0.01, 0.02, 0.06, 0.07] {
            let missing = if time_s > 0.015 && time_s < 0.03 { String::new() } else { format!("{}", 3.0 * time_s) };
            let _ = writeln!(text, "{time_s},{missing},0,9.8,{},x,{}", 1.0 - time_s, 100.0 + time_s);
        }
        let source = Log::from_source(text.as_bytes(), "x.csv", Needs::Run).expect("reads");
        let result = resample(&source, 1000.0, f64::NEG_INFINITY, f64::INFINITY).expect("two rows");
        let time_s = result.log.column(Column::Time).expect("time");
        assert_eq!(time_s.len(), 91);
        assert!((time_s[0] + 0.02).abs() < 1e-15 && (time_s[90] - 0.07).abs() < 1e-15);
        for (time_s, x) in time_s.iter().zip(result.log.column(Column::AccelX).expect("x")) {
            assert!((x - 3.0 * time_s).abs() < 1e-12);
        }
        assert_eq!((result.averaged_rows, result.bridged.len()), (1, 1));
        assert_eq!(result.bridged_missing, [(Column::AccelX, 1)]);
        assert_eq!(result.dropped, ["note"]);
        let height = &result.log.extras()[0];
        assert!(height.name == "height" && result.log.extras().len() == 1);
        assert!(height.numbers().iter().zip(time_s).all(|(height, time_s)| (height - 100.0 - time_s).abs() < 1e-12));
    }

    #[test]
    fn contract_a_span_needs_two_rows() {
        let text = "time_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,vehicle_rate_radps\n0,0,0,0,0\n";
        let source = Log::from_source(text.as_bytes(), "x.csv", Needs::Run).expect("reads");
        assert!(resample(&source, 1000.0, 0.0, 1.0).expect_err("one row").contains("two are needed"));
        assert!(resample(&source, 0.0, 0.0, 1.0).is_err());
    }
}
