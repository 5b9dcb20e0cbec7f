//! What a conversion did, told.

use std::fmt::Write;

use gimbal_log::Column;
use gimbal_log::import::Resampled;
use serde_json::{Value, json};

use super::Args;
use crate::report::counted;

/// Everything that the report is made of.
pub(super) struct Told<'a> {
    pub(super) args: &'a Args,
    pub(super) resampled: &'a Resampled,
    pub(super) altos: bool,
    pub(super) despun: bool,
    pub(super) turned: bool,
}

impl Told<'_> {
    /// For people.
    pub(super) fn text(&self) -> String {
        let Self { args, resampled, .. } = self;
        let mut text = format!("{}: {}", args.file.display(), resampled.source);
        if self.altos {
            let _ = write!(text, "\nAltOS export; gimbal axis z along the vehicle's {} axis", self.axis());
        }
        if self.despun {
            text += "\nroll taken out, as a roll gimbal outside of the gimbal axis does";
        }
        if resampled.averaged_rows > 0 {
            let _ = write!(
                text,
                "\n{} with the time stamp of the row before: averaged",
                counted(resampled.averaged_rows as u64, "row")
            );
        }
        if let Some(longest) = self.longest() {
            let _ = write!(
                text,
                "\n{} of 1.5 periods and more, {:.2} s together: crossed by straight lines; the longest from {} s \
                 to {} s",
                counted(resampled.bridged.len() as u64, "gap"),
                resampled.bridged_s(),
                longest.from_s,
                longest.to_s
            );
        }
        for (column, count) in &resampled.bridged_missing {
            let _ = write!(
                text,
                "\n{} of {}: crossed by straight lines",
                counted(*count as u64, "missing sample"),
                column.name()
            );
        }
        if self.turned {
            text += "\naccelerations turned from the vehicle's axes into the stable member's";
        }
        if !resampled.dropped.is_empty() {
            let _ = write!(
                text,
                "\nleft out, because text has no value between two rows: {}",
                resampled.dropped.join(", ")
            );
        }
        let _ = write!(
            text,
            "\n{}: {} at {} Hz",
            args.out.display(),
            counted(resampled.log.len() as u64, "row"),
            self.rate_hz()
        );
        text
    }

    /// For programs; the keys are those of `docs/log.md`.
    pub(super) fn json(&self) -> Value {
        let Self { args, resampled, .. } = self;
        let source = &resampled.source;
        let rates: Vec<Value> =
            source.rates.iter().map(|rate| json!({"period_s": rate.period_s, "share": rate.share})).collect();
        let missing: serde_json::Map<String, Value> =
            resampled.bridged_missing.iter().map(|(column, count)| (column.name().to_owned(), json!(count))).collect();
        json!({
            "out": args.out.display().to_string(),
            "rows": resampled.log.len(),
            "rate_hz": self.rate_hz(),
            "format": if self.altos { "altos" } else { "csv" },
            "gimbal_axis": self.altos.then(|| self.axis()),
            "roll_taken_out": self.despun,
            "turned_into_stable_member": self.turned,
            "source": {
                "rows": source.rows,
                "from_s": source.first_s,
                "to_s": source.last_s,
                "period_s": source.period_s,
                "rates": rates,
                "jitter_rms_s": source.jitter_rms_s,
                "jitter_s": source.jitter_s,
                "jitter_at_s": source.jitter_at_s,
                "repeats": source.repeats,
                "most_alike": source.most_alike,
                "most_alike_at_s": source.most_alike_at_s,
                "gaps": source.gaps,
                "gap_samples": source.gap_samples,
                "longest_gap_s": source.longest_gap_s,
                "longest_gap_at_s": source.longest_gap_at_s,
            },
            "averaged_rows": resampled.averaged_rows,
            "bridged_gaps": resampled.bridged.len(),
            "bridged_s": resampled.bridged_s(),
            "bridged_missing": missing,
            "dropped_columns": resampled.dropped,
        })
    }

    fn longest(&self) -> Option<gimbal_log::import::Span> {
        let length = |span: &gimbal_log::import::Span| span.to_s - span.from_s;
        self.resampled.bridged.iter().copied().max_by(|a, b| length(a).total_cmp(&length(b)))
    }

    fn axis(&self) -> String {
        format!("{:?}", self.args.gimbal_axis).to_lowercase()
    }

    fn rate_hz(&self) -> f64 {
        let times_s = self.resampled.log.column(Column::Time).unwrap_or_default();
        if times_s.len() > 1 { self.args.rate_hz } else { 0.0 }
    }
}
