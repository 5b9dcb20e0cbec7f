//! A run summed up: for people, and as JSON.

use std::f64::consts::PI;
use std::fmt::Write;

use gimbal_servo::Faults;
use serde_json::{Value, json};

use super::model::{Kind, Sample, Totals};
use crate::report::counted;

const RADIAN_DEG: f64 = 180.0 / PI;

/// A run that is over.
#[derive(Debug, Clone)]
pub(crate) struct Summary {
    pub(crate) title: String,
    pub(crate) kind: Kind,
    pub(crate) totals: Totals,
    pub(crate) last: Sample,
    /// What the log gave cause to remark.
    pub(crate) notes: Vec<String>,
    /// What the paper says about this case.
    pub(crate) published: Vec<Published>,
}

/// A figure of the paper beside ours.
#[derive(Debug, Clone)]
pub(crate) struct Published {
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) paper: f64,
    pub(crate) ours: f64,
    pub(crate) remark: &'static str,
}

impl Published {
    fn difference_percent(&self) -> f64 {
        100.0 * (self.ours / self.paper - 1.0)
    }
}

impl Summary {
    /// theta's peak over phi's.
    fn gyro_gain(&self) -> f64 {
        let Totals { peak_gimbal_angle_rad, peak_gyro_angle_rad, .. } = self.totals;
        if peak_gimbal_angle_rad > 0.0 { peak_gyro_angle_rad / peak_gimbal_angle_rad } else { 0.0 }
    }

    /// The paper's figure 7 beside this run.
    pub(crate) fn figure_7(&self) -> Vec<Published> {
        vec![
            Published {
                name: "peak phi",
                unit: "deg",
                paper: 0.11,
                ours: self.totals.peak_gimbal_angle_rad * RADIAN_DEG,
                remark: "",
            },
            Published {
                name: "velocity error",
                unit: "m/s",
                paper: 0.13,
                ours: norm(self.last.velocity_error_mps),
                remark: if self.totals.time_on_stop_s > 0.0 {
                    "not comparable: the gyro was on its stop, and the paper leaves such runs out"
                } else {
                    "open: off the stops it does not depend on T5, and no coefficient is tuned to close it"
                },
            },
        ]
    }

    /// For people.
    pub(crate) fn text(&self) -> String {
        let totals = &self.totals;
        let mut text = format!("{}\n{}, {}\n", self.title, counted(totals.samples, "sample"), self.kind.name());
        let mut line = |name: &str, value: String| {
            let _ = writeln!(text, "  {name:<22}{value}");
        };
        let angle = |rad: f64| format!("{:>12.4e} rad  {:>11.5} deg", rad, rad * RADIAN_DEG);
        line("peak phi", angle(totals.peak_gimbal_angle_rad));
        line("peak theta", angle(totals.peak_gyro_angle_rad));
        line("peak theta / peak phi", format!("{:>12.4}", self.gyro_gain()));
        line("time on the stops", format!("{:>12.4} s", totals.time_on_stop_s));
        line("residual offset", angle(totals.residual_offset_rad));
        line("velocity error", vector(self.last.velocity_error_mps, "m/s"));
        line("position error", vector(self.last.position_error_m, "m"));
        let names = fault_names(totals.faults);
        line(
            "faults",
            if names.is_empty() { "        none".to_owned() } else { format!("        {}", names.join(", ")) },
        );
        line("digest", format!("        {:016x}", totals.digest));
        for published in &self.published {
            let Published { name, unit, paper, ours, remark } = published;
            let difference = published.difference_percent();
            let _ = write!(text, "  paper, {name:<15}{paper:>12} {unit:<4} ours {ours:.4}, {difference:+.1} %");
            let _ = writeln!(text, "{}{remark}", if remark.is_empty() { "" } else { "; " });
        }
        if !self.published.is_empty() {
            let ours = if totals.time_on_stop_s > 0.0 { "limited" } else { "not limited" };
            let _ = writeln!(text, "  paper, gyro           not limited       ours {ours}");
        }
        for note in &self.notes {
            let _ = writeln!(text, "  note: {note}");
        }
        text.truncate(text.trim_end().len());
        text
    }

    /// For programs; the keys are those of `docs/log.md`.
    pub(crate) fn json(&self) -> Value {
        let totals = &self.totals;
        let mut object = json!({
            "number": self.kind.name(),
            "samples": totals.samples,
            "peak_gimbal_angle_rad": totals.peak_gimbal_angle_rad,
            "peak_gyro_angle_rad": totals.peak_gyro_angle_rad,
            "gyro_gain": self.gyro_gain(),
            "time_on_stop_s": totals.time_on_stop_s,
            "residual_offset_rad": totals.residual_offset_rad,
            "velocity_error_mps": norm(self.last.velocity_error_mps),
            "velocity_error_x_mps": self.last.velocity_error_mps[0],
            "velocity_error_y_mps": self.last.velocity_error_mps[1],
            "position_error_m": norm(self.last.position_error_m),
            "position_error_x_m": self.last.position_error_m[0],
            "position_error_y_m": self.last.position_error_m[1],
            "faults": fault_names(totals.faults),
            "digest": format!("{:016x}", totals.digest),
            "notes": self.notes,
        });
        if !self.published.is_empty() {
            object["published"] = self.published.iter().map(published_json).collect();
        }
        object
    }
}

fn published_json(published: &Published) -> Value {
    json!({
        "name": published.name,
        "unit": published.unit,
        "paper": published.paper,
        "ours": published.ours,
        "difference_percent": published.difference_percent(),
    })
}

fn fault_names(faults: Faults) -> Vec<&'static str> {
    Faults::NAMES.into_iter().filter(|(bit, _)| faults.contains(*bit)).map(|(_, name)| name).collect()
}

/// Size of a vector.
pub(crate) fn norm([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

fn vector(value: [f64; 2], unit: &str) -> String {
    format!("{:>12.6} {unit:<4} (x {:+.6}, y {:+.6})", norm(value), value[0], value[1])
}
