//! Charts in SVG, complete without a script; `chart.js` lets them be zoomed.

use std::fmt::Write;

/// Width and height of a chart, and what its axes take of them; `chart.js` has the same.
const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 240.0;
const LEFT: f64 = 78.0;
const RIGHT: f64 = 8.0;
const TOP: f64 = 8.0;
const BOTTOM: f64 = 26.0;
/// Intervals of an axis, about.
const INTERVALS: f64 = 6.0;

/// The script of all charts of a page.
pub(crate) const SCRIPT: &str = include_str!("chart.js");

/// One line.
pub(crate) struct Line<'a> {
    pub(crate) name: &'a str,
    pub(crate) colour: &'a str,
    pub(crate) points: Vec<(f64, f64)>,
}

/// A band about a line: x, low, high.
pub(crate) struct Tube<'a> {
    pub(crate) name: &'a str,
    pub(crate) colour: &'a str,
    pub(crate) points: Vec<(f64, f64, f64)>,
}

/// Lines over a common x; `logarithmic` on both axes.
pub(crate) fn plot(title: &str, x_name: &str, lines: &[Line], marks: &[(f64, f64)], logarithmic: bool) -> String {
    chart(title, x_name, lines, marks, logarithmic, None)
}

/// The same with a band.
pub(crate) fn chart(
    title: &str,
    x_name: &str,
    lines: &[Line],
    marks: &[(f64, f64)],
    logarithmic: bool,
    tube: Option<&Tube>,
) -> String {
    let map = |value: f64| if logarithmic { value.max(1e-300).log10() } else { value };
    let of_tube = tube.iter().flat_map(|tube| &tube.points).flat_map(|(x, low, high)| [(*x, *low), (*x, *high)]);
    let all = lines.iter().flat_map(|line| line.points.iter().copied()).chain(of_tube);
    let all: Vec<(f64, f64)> = all.filter(|point| point.0.is_finite() && point.1.is_finite()).collect();
    let range = |of: &dyn Fn(&(f64, f64)) -> f64| {
        let (low, high) =
            all.iter().fold((f64::MAX, f64::MIN), |(low, high), point| (low.min(of(point)), high.max(of(point))));
        if high > low { (low, high) } else { (low - 1.0, low + 1.0) }
    };
    let ((x0, x1), (low, high)) = (range(&|point| map(point.0)), range(&|point| map(point.1)));
    // a peak does not end at the frame
    let margin = 0.04 * (high - low);
    let (y0, y1) = (low - margin, high + margin);
    let (wide, tall) = (WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
    let x = |value: f64| LEFT + (map(value) - x0) / (x1 - x0) * wide;
    let y = |value: f64| TOP + (y1 - map(value)) / (y1 - y0) * tall;
    let mut out = format!(
        "<figure class=\"chart\" data-name=\"{x_name}\" data-view=\"{x0} {x1} {y0} {y1}\" data-log=\"{}\">\
         <figcaption>{title}</figcaption><svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\"><g class=\"axes\">",
        u8::from(logarithmic)
    );
    for tick in ticks(x0, x1, logarithmic) {
        let at = LEFT + (tick - x0) / (x1 - x0) * wide;
        let _ = write!(
            out,
            "<path d=\"M{at:.1} {TOP}V{}\" class=\"grid\"/><text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            HEIGHT - BOTTOM,
            HEIGHT - 10.0,
            label(tick, logarithmic)
        );
    }
    for tick in ticks(y0, y1, logarithmic) {
        let at = TOP + (y1 - tick) / (y1 - y0) * tall;
        let _ = write!(
            out,
            "<path d=\"M{LEFT} {at:.1}H{}\" class=\"grid\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            WIDTH - RIGHT,
            LEFT - 4.0,
            at + 4.0,
            label(tick, logarithmic)
        );
    }
    let _ = write!(
        out,
        "</g><svg x=\"{LEFT}\" y=\"{TOP}\" width=\"{wide}\" height=\"{tall}\" viewBox=\"{LEFT} {TOP} {wide} {tall}\">\
         <g class=\"data\">"
    );
    for (from, to) in marks {
        let (from, to) = (x(*from), x(*to));
        let _ = write!(
            out,
            "<rect x=\"{from:.2}\" y=\"{TOP}\" width=\"{:.2}\" height=\"{tall}\" class=\"span\"/>",
            (to - from).max(1.0)
        );
    }
    if let Some(tube) = tube {
        let there = tube.points.iter().map(|(at, low, _)| format!("{:.2} {:.2}", x(*at), y(*low)));
        let back = tube.points.iter().rev().map(|(at, _, high)| format!("{:.2} {:.2}", x(*at), y(*high)));
        let corners: Vec<String> = there.chain(back).collect();
        let _ = write!(out, "<path d=\"M{}Z\" fill=\"{}\" class=\"tube\"/>", corners.join("L"), tube.colour);
    }
    for line in lines {
        let mut path = String::new();
        for (index, point) in line.points.iter().enumerate() {
            let _ = write!(path, "{}{:.2} {:.2}", if index == 0 { "M" } else { "L" }, x(point.0), y(point.1));
        }
        let _ = write!(
            out,
            "<path d=\"{path}\" stroke=\"{}\" class=\"line\"><title>{}</title></path>",
            line.colour, line.name
        );
    }
    out.push_str("</g></svg></svg><p class=\"legend\">");
    let told =
        lines.iter().map(|line| (line.name, line.colour)).chain(tube.iter().map(|tube| (tube.name, tube.colour)));
    for (name, colour) in told {
        let _ = write!(out, "<span style=\"color:{colour}\">&#9632;</span> {name} &nbsp; ");
    }
    let _ = write!(out, "x: {x_name}</p></figure>");
    out
}

/// Places of ticks: 1, 2 and 5 times a power of ten, or powers of ten themselves.
pub(super) fn ticks(low: f64, high: f64, logarithmic: bool) -> Vec<f64> {
    let raw = (high - low) / INTERVALS;
    let ten = 10_f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|one| one * ten).find(|step| *step >= raw).unwrap_or(raw);
    let step = if logarithmic { step.max(1.0) } else { step };
    let mut ticks = Vec::new();
    let mut tick = (low / step).ceil() * step;
    while tick <= high + 1e-9 * step && ticks.len() < 20 {
        // no negative zero, no 0.30000000000000004
        ticks.push((tick / step).round() * step + 0.0);
        tick += step;
    }
    ticks
}

pub(super) fn label(tick: f64, logarithmic: bool) -> String {
    let value = if logarithmic { 10_f64.powf(tick) } else { tick };
    let size = value.abs();
    if size != 0.0 && !(1e-2..1e4).contains(&size) {
        let text = format!("{value:.2e}");
        text.replace(".00e", "e").replace("0e", "e")
    } else {
        format!("{value:.3}").trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

/// The largest and the smallest of each stretch, so that nothing between two points is lost.
pub(super) fn thinned(
    values: &[f64],
    period_s: f64,
    first_s: f64,
    stretches: usize,
    there: impl Fn(usize) -> bool,
) -> Vec<(f64, f64)> {
    let length = values.len().div_ceil(stretches).max(1);
    let mut points = Vec::new();
    for start in (0..values.len()).step_by(length) {
        let rows = (start..(start + length).min(values.len())).filter(|&row| there(row));
        let ends = rows.fold(None, |ends: Option<[usize; 2]>, row| {
            let [low, high] = ends.unwrap_or([row, row]);
            let lower = if values[row] < values[low] { row } else { low };
            Some([lower, if values[row] > values[high] { row } else { high }])
        });
        if let Some([low, high]) = ends {
            let mut rows = vec![low.min(high), low.max(high)];
            rows.dedup();
            points.extend(rows.into_iter().map(|row| (first_s + row as f64 * period_s, values[row])));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::{label, thinned, ticks};

    #[test]
    fn closed_form_the_ends_of_stretches_are_drawn_and_missing_rows_are_not() {
        let values = [1.0, 3.0, 2.0, 0.0, 5.0, 4.0];
        let drawn = thinned(&values, 0.5, 10.0, 2, |row| row != 3);
        assert_eq!(drawn, [(10.0, 1.0), (10.5, 3.0), (12.0, 5.0), (12.5, 4.0)]);
        assert_eq!(thinned(&values, 1.0, 0.0, 6, |row| row != 3).len(), 5);
    }

    #[test]
    fn closed_form_ticks_stand_at_round_values() {
        let labels = |low, high, log| -> Vec<String> { ticks(low, high, log).iter().map(|t| label(*t, log)).collect() };
        assert_eq!(labels(0.0, 20.0, false), ["0", "5", "10", "15", "20"]);
        assert_eq!(labels(-3.1e-4, 2.9e-4, false), ["-3e-4", "-2e-4", "-1e-4", "0", "1e-4", "2e-4"]);
        assert_eq!(labels(-0.3, 2.7, true), ["1", "10", "100"]);
    }
}
