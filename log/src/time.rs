//! What the time stamps of a log are like: rate, jitter, gaps, repeats, changes of rate.

use std::collections::BTreeMap;
use std::fmt;

use crate::Problem;

/// Intervals from which the period is taken: the first ones, by their median.
const FIRST_INTERVALS: usize = 1023;
/// Intervals within this share of the period are regular.
const REGULAR: f64 = 1e-3;
/// Intervals from this many periods on are gaps.
const GAP_PERIODS: f64 = 1.5;
/// Width of a class of intervals, as a ratio.
const CLASS_RATIO: f64 = 1.05;
/// Share of the period from which on an interval is of another rate.
const OTHER_RATE: f64 = 0.2;

/// Intervals of one length, roughly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate {
    /// Mean length [s].
    pub period_s: f64,
    /// Share of all intervals.
    pub share: f64,
}

/// The time stamps of a log.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TimeReport {
    /// Rows.
    pub rows: u64,
    /// First time stamp [s].
    pub first_s: f64,
    /// Last time stamp [s].
    pub last_s: f64,
    /// Median of the first intervals [s]; 0 with fewer than two rows.
    pub period_s: f64,
    /// Largest deviation from the period, gaps and repeats left out [s].
    pub jitter_s: f64,
    /// Time stamp at which it is.
    pub jitter_at_s: f64,
    /// Root mean square of the deviation, gaps and repeats left out [s].
    pub jitter_rms_s: f64,
    /// Intervals of 1.5 periods and more.
    pub gaps: u64,
    /// Samples that are missing in them, at the period.
    pub gap_samples: u64,
    /// The longest [s].
    pub longest_gap_s: f64,
    /// Time stamp behind which it is.
    pub longest_gap_at_s: f64,
    /// Rows with the time stamp of the row before.
    pub repeats: u64,
    /// Most rows that share one time stamp.
    pub most_alike: u64,
    /// That time stamp.
    pub most_alike_at_s: f64,
    /// Lengths that at least 5 % of all intervals have, when there is more than one, the most frequent first.
    pub rates: Vec<Rate>,
}

impl TimeReport {
    /// Rows a second.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        if self.period_s > 0.0 { 1.0 / self.period_s } else { 0.0 }
    }

    /// Whether there is one rate, without gaps and repeats, and jitter of less than a tenth of the period.
    #[must_use]
    pub fn is_regular(&self) -> bool {
        self.gaps == 0 && self.repeats == 0 && self.jitter_s < 0.1 * self.period_s
    }
}

/// The ending of what there are several of.
const fn plural(count: u64) -> &'static str {
    if count == 1 { "" } else { "s" }
}

impl fmt::Display for TimeReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} rows from {} s to {} s, {:.6} Hz", self.rows, self.first_s, self.last_s, self.rate_hz())?;
        if self.jitter_s > 1e-3 * self.period_s {
            let (rms, most) = (1e3 * self.jitter_rms_s, 1e3 * self.jitter_s);
            write!(f, "; jitter {rms:.3} ms rms, at most {most:.3} ms at {} s", self.jitter_at_s)?;
        }
        if self.gaps > 0 {
            write!(
                f,
                "; {} gap{} ({} sample{}), the longest {:.4} s after {} s",
                self.gaps,
                plural(self.gaps),
                self.gap_samples,
                plural(self.gap_samples),
                self.longest_gap_s,
                self.longest_gap_at_s
            )?;
        }
        if self.repeats > 0 {
            write!(
                f,
                "; {} repeated time stamp{}, at most {} rows alike at {} s",
                self.repeats,
                plural(self.repeats),
                self.most_alike,
                self.most_alike_at_s
            )?;
        }
        if let [first, others @ ..] = self.rates.as_slice()
            && !others.is_empty()
        {
            write!(f, "; no constant rate: {:.0} % of the intervals are {:.4} s", 100.0 * first.share, first.period_s)?;
            for rate in others {
                write!(f, ", {:.0} % {:.4} s", 100.0 * rate.share, rate.period_s)?;
            }
        }
        Ok(())
    }
}

/// Watches time stamps go by, in constant memory.
#[derive(Debug, Clone)]
pub(crate) struct TimeWatch {
    report: TimeReport,
    alike: u64,
    first: Vec<(f64, f64)>,
    regular: u64,
    square_sum: f64,
    jittered: u64,
    /// Number and sum of the intervals that are not regular, by class of length.
    classes: BTreeMap<i32, (u64, f64)>,
}

impl TimeWatch {
    pub(crate) fn new() -> Self {
        Self {
            report: TimeReport::default(),
            alike: 1,
            first: Vec::with_capacity(FIRST_INTERVALS),
            regular: 0,
            square_sum: 0.0,
            jittered: 0,
            classes: BTreeMap::new(),
        }
    }

    pub(crate) fn rows(&self) -> u64 {
        self.report.rows
    }

    /// Takes the next time stamp.
    #[inline]
    pub(crate) fn push(&mut self, time_s: f64) -> Result<(), Problem> {
        let report = &mut self.report;
        let from_s = report.last_s;
        report.last_s = time_s;
        report.rows += 1;
        if report.rows == 1 {
            report.first_s = time_s;
            return Ok(());
        }
        let interval_s = time_s - from_s;
        let period_s = report.period_s;
        if (interval_s - period_s).abs() <= REGULAR * period_s && period_s > 0.0 {
            self.regular += 1;
            self.alike = 1;
            return Ok(());
        }
        if interval_s < 0.0 {
            return Err(Problem::Backwards { from_s, to_s: time_s });
        }
        self.push_other(from_s, interval_s);
        Ok(())
    }

    fn push_other(&mut self, from_s: f64, interval_s: f64) {
        if interval_s == 0.0 {
            self.alike += 1;
            self.report.repeats += 1;
            if self.alike > self.report.most_alike {
                self.report.most_alike = self.alike;
                self.report.most_alike_at_s = from_s;
            }
            return;
        }
        self.alike = 1;
        if self.report.period_s > 0.0 {
            self.classify(from_s, interval_s);
            return;
        }
        self.first.push((from_s, interval_s));
        if self.first.len() == FIRST_INTERVALS {
            self.settle_period();
        }
    }

    /// Takes the median of the first intervals for the period, and classifies them by it.
    fn settle_period(&mut self) {
        let first = std::mem::take(&mut self.first);
        let mut lengths: Vec<f64> = first.iter().map(|(_, interval_s)| *interval_s).collect();
        lengths.sort_by(f64::total_cmp);
        self.report.period_s = lengths.get(lengths.len() / 2).copied().map_or(0.0, rounded);
        for (from_s, interval_s) in first {
            self.classify(from_s, interval_s);
        }
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts of periods within a gap")]
    fn classify(&mut self, from_s: f64, interval_s: f64) {
        let period_s = self.report.period_s;
        let deviation_s = (interval_s - period_s).abs();
        if deviation_s <= REGULAR * period_s {
            self.regular += 1;
            return;
        }
        let class = self.classes.entry((interval_s.ln() / CLASS_RATIO.ln()).round() as i32).or_default();
        *class = (class.0 + 1, class.1 + interval_s);
        if interval_s >= GAP_PERIODS * period_s {
            self.report.gaps += 1;
            self.report.gap_samples += (interval_s / period_s).round() as u64 - 1;
            if interval_s > self.report.longest_gap_s {
                (self.report.longest_gap_s, self.report.longest_gap_at_s) = (interval_s, from_s);
            }
            return;
        }
        self.jittered += 1;
        self.square_sum += deviation_s * deviation_s;
        if deviation_s > self.report.jitter_s {
            (self.report.jitter_s, self.report.jitter_at_s) = (deviation_s, from_s + interval_s);
        }
    }

    /// What was seen so far.
    #[allow(clippy::cast_precision_loss, reason = "counts of rows are far below 2^53")]
    pub(crate) fn report(&self) -> TimeReport {
        let mut watch = self.clone();
        if !watch.first.is_empty() {
            watch.settle_period();
        }
        let counted = watch.regular + watch.jittered;
        watch.report.jitter_rms_s = (watch.square_sum / (counted.max(1)) as f64).sqrt();
        // intervals that scatter about the period are jitter, and of its rate
        let period_s = watch.report.period_s;
        let near = |(count, sum_s): &(u64, f64)| (sum_s / *count as f64 - period_s).abs() < OTHER_RATE * period_s;
        let (own, mut lengths): (Vec<_>, Vec<_>) = watch.classes.values().copied().partition(near);
        let regular = (watch.regular, watch.regular as f64 * period_s);
        lengths.push(own.iter().fold(regular, |all, class| (all.0 + class.0, all.1 + class.1)));
        let all: u64 = lengths.iter().map(|(count, _)| count).sum();
        lengths.retain(|(count, _)| 20 * count >= all && *count > 0);
        lengths.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
        let share = |count: u64| count as f64 / all as f64;
        watch.report.rates = lengths
            .into_iter()
            .map(|(count, sum_s)| Rate { period_s: sum_s / count as f64, share: share(count) })
            .collect();
        watch.report
    }
}

/// The length without the rounding of the two time stamps that it came from, where a short decimal is that near.
fn rounded(interval_s: f64) -> f64 {
    let short: f64 = format!("{interval_s:.6e}").parse().unwrap_or(interval_s);
    if (short - interval_s).abs() <= 1e-7 * interval_s { short } else { interval_s }
}

#[cfg(test)]
mod tests {
    use super::TimeWatch;

    fn watch(times_s: &[f64]) -> super::TimeReport {
        let mut watch = TimeWatch::new();
        for &time_s in times_s {
            watch.push(time_s).expect("rising");
        }
        watch.report()
    }

    #[test]
    #[allow(clippy::float_cmp, reason = "a short decimal is meant to come out as itself")]
    fn contract_a_regular_log_has_one_rate() {
        let times_s: Vec<f64> = (0..5000).map(|k| 100.0 + f64::from(k) / 1000.0).collect();
        let report = watch(&times_s);
        assert!(report.is_regular());
        assert_eq!(report.period_s, 0.001);
        assert_eq!(report.rates.len(), 1);
    }

    #[test]
    fn contract_gaps_repeats_and_jitter_are_counted_and_placed() {
        let report = watch(&[0.0, 0.01, 0.02, 0.02, 0.02, 0.03, 0.041, 0.05, 0.09, 0.10]);
        assert_eq!((report.repeats, report.most_alike), (2, 3));
        assert!((report.most_alike_at_s - 0.02).abs() < 1e-12);
        assert_eq!((report.gaps, report.gap_samples), (1, 3));
        assert!((report.longest_gap_at_s - 0.05).abs() < 1e-12);
        assert!((report.jitter_s - 0.001).abs() < 1e-9 && (report.jitter_at_s - 0.041).abs() < 1e-12);
        assert!(!report.is_regular());
    }

    #[test]
    fn contract_jitter_is_no_other_rate() {
        let times_s: Vec<f64> = (0..3000).map(|k| f64::from(k) / 100.0 + if k % 3 == 0 { 2e-4 } else { 0.0 }).collect();
        let report = watch(&times_s);
        assert_eq!(report.rates.len(), 1);
        assert!(report.jitter_rms_s > 5e-5 && !report.to_string().contains("no constant rate"));
    }

    #[test]
    fn contract_a_change_of_rate_is_told() {
        let times_s: Vec<f64> =
            (0..3000).map(|k| f64::from(k) / 100.0).chain((0..1000).map(|k| 30.1 + f64::from(k) / 10.0)).collect();
        let report = watch(&times_s);
        assert_eq!(report.rates.len(), 2);
        assert!((report.rates[1].period_s - 0.1).abs() < 1e-9 && (report.rates[1].share - 0.25).abs() < 0.01);
        assert!(report.to_string().contains("no constant rate"));
    }

    #[test]
    fn contract_time_runs_forwards() {
        let mut watch = TimeWatch::new();
        watch.push(1.0).expect("first");
        assert!(watch.push(0.5).is_err());
    }
}
