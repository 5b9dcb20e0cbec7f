//! Lines in SVG: what a page needs and no more.

use std::fmt::Write;

/// Width and height of a plot.
const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 220.0;
const LEFT: f64 = 78.0;
const BOTTOM: f64 = 26.0;

/// One line.
pub(crate) struct Line<'a> {
    pub(crate) name: &'a str,
    pub(crate) colour: &'a str,
    pub(crate) points: Vec<(f64, f64)>,
}

/// Lines over a common x; `logarithmic` on both axes.
pub(crate) fn plot(title: &str, x_name: &str, lines: &[Line], marks: &[(f64, f64)], logarithmic: bool) -> String {
    let map = |value: f64| if logarithmic { value.max(1e-300).log10() } else { value };
    let all = || lines.iter().flat_map(|line| &line.points).filter(|point| point.0.is_finite() && point.1.is_finite());
    let range = |of: &dyn Fn(&(f64, f64)) -> f64| {
        let (low, high) =
            all().fold((f64::MAX, f64::MIN), |(low, high), point| (low.min(of(point)), high.max(of(point))));
        if high > low { (low, high) } else { (low - 1.0, low + 1.0) }
    };
    let (x0, x1) = range(&|point| map(point.0));
    let (y0, y1) = range(&|point| map(point.1));
    let x = |value: f64| LEFT + (map(value) - x0) / (x1 - x0) * (WIDTH - LEFT - 8.0);
    let y = |value: f64| 8.0 + (y1 - map(value)) / (y1 - y0) * (HEIGHT - BOTTOM - 8.0);
    let mut out =
        format!("<figure><figcaption>{title}</figcaption><svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\">");
    for (from, to) in marks {
        let (from, to) = (x(*from), x(*to));
        let _ = write!(
            out,
            "<rect x=\"{from:.1}\" y=\"8\" width=\"{:.1}\" height=\"{}\" class=\"span\"/>",
            (to - from).max(1.0),
            HEIGHT - BOTTOM - 8.0
        );
    }
    for step in 0..=4 {
        let share = f64::from(step) / 4.0;
        let back = |low: f64, high: f64| {
            let value = low + share * (high - low);
            if logarithmic { 10_f64.powf(value) } else { value }
        };
        let (at_x, at_y) = (LEFT + share * (WIDTH - LEFT - 8.0), HEIGHT - BOTTOM - share * (HEIGHT - BOTTOM - 8.0));
        let _ = write!(
            out,
            "<text x=\"{at_x:.0}\" y=\"{}\" text-anchor=\"middle\">{:.3}</text>",
            HEIGHT - 10.0,
            short(back(x0, x1))
        );
        let _ = write!(
            out,
            "<text x=\"{}\" y=\"{:.0}\" text-anchor=\"end\">{}</text>",
            LEFT - 4.0,
            at_y + 4.0,
            short(back(y0, y1))
        );
        let _ = write!(out, "<path d=\"M{LEFT} {at_y:.1}H{WIDTH}\" class=\"grid\"/>");
    }
    for line in lines {
        let mut path = String::new();
        for (index, point) in line.points.iter().enumerate() {
            let _ = write!(path, "{}{:.1} {:.1}", if index == 0 { "M" } else { "L" }, x(point.0), y(point.1));
        }
        let _ = write!(
            out,
            "<path d=\"{path}\" stroke=\"{}\" class=\"line\"><title>{}</title></path>",
            line.colour, line.name
        );
    }
    out.push_str("</svg><p class=\"legend\">");
    for line in lines {
        let _ = write!(out, "<span style=\"color:{}\">&#9632;</span> {} &nbsp; ", line.colour, line.name);
    }
    let _ = write!(out, "x: {x_name}</p></figure>");
    out
}

fn short(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-2..1e4).contains(&size) { format!("{value:.1e}") } else { format!("{value:.2}") }
}

/// The largest and the smallest of each stretch, so that nothing between two points is lost.
pub(super) fn thinned(values: &[f64], period_s: f64, first_s: f64, stretches: usize) -> Vec<(f64, f64)> {
    let length = (values.len() / stretches).max(1);
    values
        .chunks(length)
        .enumerate()
        .flat_map(|(index, chunk)| {
            let time_s = first_s + (index * length) as f64 * period_s;
            let (low, high) = chunk.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
            [(time_s, low), (time_s, high)]
        })
        .collect()
}
