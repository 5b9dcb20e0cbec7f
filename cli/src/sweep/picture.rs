//! A sweep as a picture: a heat map of two ranges, a line of one, percentiles of draws.

use std::io::Write;
use std::path::Path;

use gimbal_log::AtomicFile;

use super::answer::Answer;
use super::plan::{Design, Plan, Range};
use super::trial::Case;
use crate::exit::Failure;
use crate::plot::{Axis, Chart, Field, Look, Series, png, svg};

/// Draws the saturation limit into a file.
pub(super) fn draw(path: &Path, plan: &Plan, answer: &Answer) -> Result<(), Failure> {
    let limit = &answer.spreads[0];
    let disturbed = match plan.case {
        Case::Unbalance => "unbalance alone",
        Case::Friction => "friction alone",
        Case::Both => "unbalance and friction",
    };
    let title = format!("Acceleration for 5 s at which the gyro meets its stop ({disturbed})");
    let label =
        |range: &Range| format!("{} ({}) [{}]", range.parameter.name, range.parameter.symbol, range.parameter.unit);
    let axis = |range: &Range| (range.from.min(range.to), range.from.max(range.to));
    let (x_label, y_label);
    let chart = match &plan.design {
        Design::Grid(ranges) if ranges.len() == 2 && ranges.iter().all(|range| range.count > 1) => {
            (x_label, y_label) = (label(&ranges[0]), label(&ranges[1]));
            Chart {
                title: &title,
                x: half_cells(&ranges[0], &x_label),
                y: half_cells(&ranges[1], &y_label),
                series: Vec::new(),
                band: None,
                shaded: None,
                field: Some(Field {
                    label: "saturation [g]",
                    columns: usize::try_from(ranges[0].count).unwrap_or(1),
                    values: answer.grid.iter().map(|(_, limit_g)| *limit_g).collect(),
                    missing: "loop unstable, or no saturation within the range",
                }),
            }
        }
        Design::Grid(ranges) if ranges.len() == 1 => {
            x_label = label(&ranges[0]);
            let mut points: Vec<(f64, f64)> = answer
                .grid
                .iter()
                .filter(|(_, limit_g)| limit_g.is_finite())
                .map(|(x, limit_g)| (x[0], *limit_g))
                .collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (from, to) = axis(&ranges[0]);
            let top = 1.1 * points.iter().map(|point| point.1).fold(1.0, f64::max);
            Chart {
                title: &title,
                x: Axis { label: &x_label, from, to, log: false },
                y: Axis { label: "saturation [g]", from: 0.0, to: top, log: false },
                series: vec![Series { name: "flight code", points, look: Look::Line(0) }],
                band: None,
                shaded: None,
                field: None,
            }
        }
        _ => {
            let points: Vec<(f64, f64)> =
                (1..1000).map(|k| f64::from(k) / 10.0).map(|percent| (limit.percentile(percent), percent)).collect();
            let nominal_g = limit.nominal.unwrap_or(limit.percentile(50.0));
            let (from, to) = (limit.percentile(0.05), limit.percentile(99.95));
            let room = 0.04 * (to - from).max(1e-6);
            Chart {
                title: &title,
                x: Axis { label: "acceleration [g]", from: from - room, to: to + room, log: false },
                y: Axis { label: "platforms on a stop [%]", from: 0.0, to: 100.0, log: false },
                series: vec![
                    Series { name: "share of platforms", points, look: Look::Line(0) },
                    Series { name: "nominal", points: vec![(nominal_g, 0.0), (nominal_g, 100.0)], look: Look::Line(1) },
                ],
                band: None,
                shaded: None,
                field: None,
            }
        }
    };
    let drawn = |error| Failure::Environment(anyhow::Error::msg(error));
    let bytes = if path.extension().is_some_and(|extension| extension == "png") {
        png(&chart).map_err(drawn)?
    } else {
        svg(&chart).map_err(drawn)?.into_bytes()
    };
    let fail = || Failure::write(path);
    let mut file = AtomicFile::create(path).map_err(fail())?;
    file.write_all(&bytes).map_err(fail())?;
    file.commit().map_err(fail())
}

/// An axis whose cells have the range's points in their middles.
fn half_cells<'a>(range: &Range, label: &'a str) -> Axis<'a> {
    let half = 0.5 * (range.to - range.from) / (range.count - 1) as f64;
    Axis { label, from: range.from - half, to: range.to + half, log: false }
}
