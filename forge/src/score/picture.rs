//! Pictures as inline SVG.

use std::fmt::Write;

use super::calibration::Calibration;

const SIDE: f64 = 320.0;
const MARGIN: f64 = 44.0;

/// Share that was right over the probability that was given; the area of a dot is its count.
pub(super) fn reliability(title: &str, calibration: &Calibration) -> String {
    let full = SIDE + 2.0 * MARGIN;
    let x = |value: f64| MARGIN + SIDE * value;
    let y = |value: f64| MARGIN + SIDE * (1.0 - value);
    let mut svg = format!(
        "<svg role=\"img\" viewBox=\"0 0 {full} {full}\" width=\"{full}\" aria-label=\"{title}\">\
         <rect x=\"{MARGIN}\" y=\"{MARGIN}\" width=\"{SIDE}\" height=\"{SIDE}\" class=\"frame\"/>\
         <line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" class=\"ideal\"/>",
        x(0.0),
        y(0.0),
        x(1.0),
        y(1.0)
    );
    for tick in [0.0, 0.5, 1.0] {
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{tick}</text>\
             <text x=\"{}\" y=\"{}\" text-anchor=\"end\">{tick}</text>",
            x(tick),
            y(0.0) + 16.0,
            x(0.0) - 6.0,
            y(tick) + 4.0
        );
    }
    let largest = calibration.bins.iter().map(|bin| bin.count).max().unwrap_or(1) as f64;
    for bin in &calibration.bins {
        let radius = 3.0 + 6.0 * (bin.count as f64 / largest).sqrt();
        let _ = write!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius:.1}\" class=\"dot\"><title>said {:.3}, right {:.3}, {} \
             cases</title></circle>",
            x(bin.probability),
            y(bin.share),
            bin.probability,
            bin.share,
            bin.count
        );
    }
    let _ = write!(
        svg,
        "<text x=\"{}\" y=\"20\" text-anchor=\"middle\">{title}</text>\
         <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">probability given</text>\
         <text transform=\"translate(12 {}) rotate(-90)\" text-anchor=\"middle\">share right</text></svg>",
        full / 2.0,
        full / 2.0,
        full - 8.0,
        full / 2.0
    );
    svg
}

/// Who was taken for whom: rows are the truth, columns the likeliest name, shade the share of the row.
pub(super) fn confusion(counts: &[(String, String, usize)]) -> String {
    let list = |place: fn(&(String, String, usize)) -> &String| {
        let mut names: Vec<&String> = counts.iter().map(place).collect();
        names.sort();
        names.dedup();
        names
    };
    let (rows, columns) = (list(|count| &count.0), list(|count| &count.1));
    let (cell, left, top) = (18.0, 190.0, 190.0);
    let (width, height) = (left + cell * columns.len() as f64 + 10.0, top + cell * rows.len() as f64 + 10.0);
    let mut svg = format!(
        "<svg role=\"img\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" aria-label=\"confusion between effects\">"
    );
    for (place, name) in rows.iter().enumerate() {
        let y = top + cell * (place as f64 + 0.72);
        let _ = write!(svg, "<text x=\"{}\" y=\"{y:.1}\" text-anchor=\"end\">{name}</text>", left - 6.0);
    }
    for (place, name) in columns.iter().enumerate() {
        let x = left + cell * (place as f64 + 0.7);
        let _ = write!(svg, "<text transform=\"translate({x:.1} {}) rotate(-60)\">{name}</text>", top - 6.0);
    }
    for (truth, named, count) in counts {
        let total: usize = counts.iter().filter(|other| other.0 == *truth).map(|other| other.2).sum();
        let share = *count as f64 / total.max(1) as f64;
        let place =
            |names: &[&String], name: &String| names.iter().position(|other| *other == name).unwrap_or(0) as f64;
        let (x, y) = (left + cell * place(&columns, named), top + cell * place(&rows, truth));
        let class = if truth == named { "hit" } else { "miss" };
        let _ = write!(
            svg,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{cell}\" height=\"{cell}\" class=\"{class}\" \
             fill-opacity=\"{:.2}\"><title>{truth} named {named}: {count} of {total}</title></rect>",
            0.15 + 0.85 * share
        );
    }
    svg.push_str("</svg>");
    svg
}
