//! Pictures over time in one style: panels below each other, one time axis, readable in grey.
//!
//! Lines differ in lightness and in dashes, not in hue alone. Sizes are in pixels of the SVG.

mod envelope;

pub(crate) use envelope::Envelope;

use plotters::coord::Shift;
use plotters::prelude::*;

const WIDTH: u32 = 1000;
const TITLE_HEIGHT: u32 = 44;
const PANEL_HEIGHT: u32 = 190;
const TIME_LABEL_HEIGHT: u32 = 24;
/// Room for numbers left of a panel.
const LEFT: u32 = 84;
const RIGHT: u32 = 24;
/// Room for the name, the unit and the legend above a panel.
const CAPTION_HEIGHT: i32 = 26;
/// Lines longer than this are drawn without dashes, in pixels.
const MOST_DASHED_PX: f64 = 20_000.0;
const FONT: &str = "sans-serif";
const INK: RGBColor = RGBColor(34, 34, 34);
const GRID: RGBColor = RGBColor(214, 214, 214);
const SHADE: RGBColor = RGBColor(222, 204, 160);

/// Colour, width, and dash and gap of a line.
type Style = (RGBColor, u32, Option<(i32, i32)>);

/// The first, second and third line of a panel.
const STYLES: [Style; 3] = [
    (RGBColor(0, 82, 136), 2, None),
    (RGBColor(222, 128, 0), 2, Some((8, 4))),
    (RGBColor(120, 190, 150), 2, Some((2, 4))),
];

/// One line.
pub(crate) struct Line<'a> {
    name: &'a str,
    points: Vec<(f64, f64)>,
}

impl<'a> Line<'a> {
    /// A line through an envelope.
    pub(crate) fn new(name: &'a str, envelope: &Envelope) -> Self {
        Self { name, points: envelope.points() }
    }
}

/// Lines that share a unit.
pub(crate) struct Panel<'a> {
    title: &'a str,
    unit: &'a str,
    lines: Vec<Line<'a>>,
}

impl<'a> Panel<'a> {
    /// A panel.
    pub(crate) fn new(title: &'a str, unit: &'a str, lines: Vec<Line<'a>>) -> Self {
        Self { title, unit, lines }
    }
}

/// A picture.
pub(crate) struct Figure<'a> {
    pub(crate) title: &'a str,
    pub(crate) panels: Vec<Panel<'a>>,
    /// Spans of time behind all panels [s].
    pub(crate) shaded: &'a [(f64, f64)],
    pub(crate) shaded_name: &'a str,
}

impl Figure<'_> {
    /// The picture as SVG.
    pub(crate) fn draw(&self) -> Result<String, String> {
        let mut svg = String::new();
        self.draw_into(&mut svg).map_err(|error| format!("the picture cannot be drawn: {error}"))?;
        Ok(svg)
    }

    fn draw_into(&self, svg: &mut String) -> Result<(), Box<dyn std::error::Error>> {
        let count = u32::try_from(self.panels.len())?;
        let height = TITLE_HEIGHT + count * PANEL_HEIGHT + TIME_LABEL_HEIGHT;
        let root = SVGBackend::with_string(svg, (WIDTH, height)).into_drawing_area();
        root.fill(&WHITE)?;
        root.draw(&Text::new(clipped(self.title), (i32::try_from(LEFT)?, 14), (FONT, 17).into_font().color(&INK)))?;
        let (_, below) = root.split_vertically(TITLE_HEIGHT);
        let span = self.time_span();
        let mut rest = below;
        for (index, panel) in self.panels.iter().enumerate() {
            let last = index + 1 == self.panels.len();
            let room = PANEL_HEIGHT + if last { TIME_LABEL_HEIGHT } else { 0 };
            let (area, next) = rest.split_vertically(room);
            self.draw_panel(panel, &area, span, (index == 0, last))?;
            rest = next;
        }
        root.present()?;
        Ok(())
    }

    fn draw_panel(
        &self,
        panel: &Panel,
        area: &DrawingArea<SVGBackend, Shift>,
        (from_s, to_s): (f64, f64),
        (first, last): (bool, bool),
    ) -> Result<(), Box<dyn std::error::Error>> {
        let values = || panel.lines.iter().flat_map(|line| line.points.iter().map(|(_, value)| *value));
        let least = values().fold(0.0, f64::min);
        let most = values().fold(0.0, f64::max);
        let (factor, prefix) = prefix(most.max(-least));
        let (least, most) = if most > least { (least * factor, most * factor) } else { (-1.0, 1.0) };
        let margin = 0.06 * (most - least);
        let mut chart = ChartBuilder::on(area)
            .margin_top(CAPTION_HEIGHT)
            .margin_right(RIGHT)
            .margin_bottom(8)
            .set_label_area_size(LabelAreaPosition::Left, LEFT)
            .set_label_area_size(LabelAreaPosition::Bottom, if last { 40 } else { 8 })
            .build_cartesian_2d(from_s..to_s, (least - margin)..(most + margin))?;
        let corners = [least - margin, most + margin];
        // No span is too short to be seen.
        let least_s = 4.0 * (to_s - from_s) / f64::from(WIDTH - LEFT - RIGHT);
        let spans =
            self.shaded.iter().map(|&(from_s, to_s)| [(from_s, corners[0]), (to_s.max(from_s + least_s), corners[1])]);
        chart.draw_series(spans.map(|corners| Rectangle::new(corners, SHADE.filled())))?;
        let mut mesh = chart.configure_mesh();
        mesh.light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .axis_style(INK)
            .x_labels(11)
            .y_labels(6)
            .x_label_formatter(&|value| decimal(*value))
            .y_label_formatter(&|value| decimal(*value))
            .label_style((FONT, 14).into_font().color(&INK));
        if last {
            mesh.x_desc("time [s]").axis_desc_style((FONT, 14).into_font().color(&INK));
        } else {
            mesh.x_labels(11).x_label_formatter(&|_| String::new());
        }
        mesh.draw()?;
        for (line, (color, width, dash)) in panel.lines.iter().zip(STYLES) {
            let style = color.stroke_width(width);
            let points: Vec<(f64, f64)> = line.points.iter().map(|&(time_s, value)| (time_s, value * factor)).collect();
            // Dashes on a band of noise show nothing, and there would be a hundred thousand of them.
            match dash.filter(|_| path_px(&points, most - least) < MOST_DASHED_PX) {
                None => chart.draw_series(LineSeries::new(points, style)).map(|_| ())?,
                Some((on, off)) => {
                    chart.draw_series(DashedLineSeries::new(points, on, off, style)).map(|_| ())?;
                }
            }
        }
        self.caption(panel, prefix, first, area)
    }

    /// Name and unit on the left, legend on the right.
    fn caption(
        &self,
        panel: &Panel,
        prefix: &str,
        first: bool,
        area: &DrawingArea<SVGBackend, Shift>,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let font = || (FONT, 15).into_font().color(&INK);
        let title = format!("{} [{prefix}{}]", panel.title, panel.unit);
        area.draw(&Text::new(title, (i32::try_from(LEFT)?, 6), font()))?;
        let mut x = i32::try_from(WIDTH - RIGHT)?;
        let y = 13;
        for (line, (color, width, dash)) in panel.lines.iter().zip(STYLES).rev() {
            x -= width_of(line.name);
            area.draw(&Text::new(line.name.to_owned(), (x, 6), font()))?;
            let sample = vec![(x - 40, y), (x - 8, y)];
            match dash {
                None => area.draw(&PathElement::new(sample, color.stroke_width(width)))?,
                Some((on, off)) => {
                    let mut at = x - 40;
                    while at < x - 8 {
                        let end = (at + on).min(x - 8);
                        area.draw(&PathElement::new(vec![(at, y), (end, y)], color.stroke_width(width)))?;
                        at += on + off;
                    }
                }
            }
            x -= 64;
        }
        if first && !self.shaded.is_empty() {
            x -= width_of(self.shaded_name) - 24;
            area.draw(&Rectangle::new([(x - 26, y - 6), (x - 8, y + 6)], SHADE.filled()))?;
            area.draw(&Text::new(self.shaded_name.to_owned(), (x, 6), font()))?;
        }
        Ok(())
    }

    fn time_span(&self) -> (f64, f64) {
        let times = || self.panels.iter().flat_map(|panel| &panel.lines).flat_map(|line| &line.points).map(|p| p.0);
        let (from_s, to_s) = (times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max));
        if to_s > from_s { (from_s, to_s) } else { (0.0, 1.0) }
    }
}

/// Length of a line on paper, up and down, in pixels.
fn path_px(points: &[(f64, f64)], range: f64) -> f64 {
    let ways = points.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs());
    ways.sum::<f64>() / range * f64::from(PANEL_HEIGHT)
}

/// Width of a text in the captions, roughly.
fn width_of(text: &str) -> i32 {
    i32::try_from(text.chars().count()).map_or(0, |count| count * 8)
}

/// Factor and prefix that bring a size into 1..1000.
fn prefix(size: f64) -> (f64, &'static str) {
    [(1.0, ""), (1e3, "m"), (1e6, "u")].into_iter().find(|(factor, _)| size * factor >= 1.0).unwrap_or(if size > 0.0 {
        (1e9, "n")
    } else {
        (1.0, "")
    })
}

/// A label without the tail of rounding.
fn decimal(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A title that fits.
fn clipped(title: &str) -> String {
    const MOST: usize = 110;
    if title.chars().count() <= MOST {
        return title.to_owned();
    }
    let tail: String = title.chars().skip(title.chars().count() - MOST + 3).collect();
    format!("...{tail}")
}

#[cfg(test)]
mod tests {
    use super::{decimal, prefix};

    #[test]
    fn closed_form_prefixes_and_labels() {
        assert_eq!(prefix(0.002).1, "m");
        assert_eq!(prefix(196.0).1, "");
        assert_eq!(prefix(0.0).1, "");
        assert_eq!(decimal(0.1 + 0.2), "0.3");
        assert_eq!(decimal(-1e-10), "0");
    }
}
