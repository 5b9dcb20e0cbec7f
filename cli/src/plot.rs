//! Pictures in one style, readable in grey: panels over time below each other, and charts of one quantity over another.
//!
//! Lines differ in lightness and in dashes, not in hue alone. Sizes are in pixels of the SVG.

mod bitmap;
mod chart;
mod envelope;
mod simplify;

pub(crate) use chart::{Axis, Chart, Field, Look, Series};
pub(crate) use envelope::Envelope;

use std::error::Error;
use std::sync::Once;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;

use simplify::simplified;

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

/// Letters of all pictures: their widths lay the SVG out, their shapes fill the bitmap.
static LETTERS: &[u8] = include_bytes!("plot/dejavu-sans-subset.ttf");

/// Something that can be drawn, as SVG or as PNG.
pub(crate) trait Picture {
    /// Width and height [px].
    fn size(&self) -> (u32, u32);

    /// Draws it.
    fn draw_on<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static;
}

/// A picture as SVG.
pub(crate) fn svg(picture: &impl Picture) -> Result<String, String> {
    register_letters();
    let mut svg = String::new();
    let root = SVGBackend::with_string(&mut svg, picture.size()).into_drawing_area();
    let drawn = picture.draw_on(&root).and_then(|()| Ok(root.present()?));
    drop(root);
    drawn.map_err(|error| format!("the picture cannot be drawn: {error}"))?;
    Ok(svg)
}

/// A picture as PNG, two pixels of it to one of the SVG.
pub(crate) fn png(picture: &impl Picture) -> Result<Vec<u8>, String> {
    register_letters();
    bitmap::png(picture).map_err(|error| format!("the picture cannot be drawn: {error}"))
}

fn register_letters() {
    static DONE: Once = Once::new();
    DONE.call_once(|| {
        // Letters that cannot be read show when the picture is drawn.
        let _ = register_font(FONT, FontStyle::Normal, LETTERS);
    });
}

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

    /// A line through points, which need no thinning out.
    pub(crate) fn through(name: &'a str, points: Vec<(f64, f64)>) -> Self {
        Self { name, points }
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
        svg(self)
    }
}

impl Picture for Figure<'_> {
    fn size(&self) -> (u32, u32) {
        let count = u32::try_from(self.panels.len()).unwrap_or(1);
        (WIDTH, TITLE_HEIGHT + count * PANEL_HEIGHT + TIME_LABEL_HEIGHT)
    }

    fn draw_on<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
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
        Ok(())
    }
}

impl Figure<'_> {
    fn draw_panel<B: DrawingBackend>(
        &self,
        panel: &Panel,
        area: &DrawingArea<B, Shift>,
        (from_s, to_s): (f64, f64),
        (first, last): (bool, bool),
    ) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        let values = || panel.lines.iter().flat_map(|line| line.points.iter().map(|(_, value)| *value));
        let least = values().fold(0.0, f64::min);
        let most = values().fold(0.0, f64::max);
        // The paper's degrees take no prefix.
        let (factor, prefix) = if panel.unit == "deg" { (1.0, "") } else { prefix(most.max(-least)) };
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
            let points = line.points.iter().map(|&(time_s, value)| (time_s, value * factor)).collect();
            let pixel = ((to_s - from_s) / f64::from(WIDTH), (most - least) / f64::from(PANEL_HEIGHT));
            let points: Vec<(f64, f64)> = simplified(points, pixel);
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
    fn caption<B: DrawingBackend>(
        &self,
        panel: &Panel,
        prefix: &str,
        first: bool,
        area: &DrawingArea<B, Shift>,
    ) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        let font = || (FONT, 15).into_font().color(&INK);
        let title = format!("{} [{prefix}{}]", panel.title, panel.unit);
        area.draw(&Text::new(title, (i32::try_from(LEFT)?, 6), font()))?;
        let mut x = i32::try_from(WIDTH - RIGHT)?;
        let y = 13;
        for (line, (color, width, dash)) in
            panel.lines.iter().zip(STYLES).rev().filter(|(line, _)| !line.name.is_empty())
        {
            x -= width_of(line.name);
            area.draw(&Text::new(line.name.to_owned(), (x, 6), font()))?;
            draw_sample(area, (x - 40, x - 8, y), (color, width, dash))?;
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

/// A piece of a line, for a legend: from and to in x, and y.
fn draw_sample<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    (from, to, y): (i32, i32, i32),
    (color, width, dash): Style,
) -> Result<(), Box<dyn Error>>
where
    B::ErrorType: 'static,
{
    let (on, off) = dash.unwrap_or((to - from, 1));
    let mut at = from;
    while at < to {
        let end = (at + on).min(to);
        area.draw(&PathElement::new(vec![(at, y), (end, y)], color.stroke_width(width)))?;
        at += on + off;
    }
    Ok(())
}

/// Length of a line on paper, up and down, in pixels.
fn path_px(points: &[(f64, f64)], range: f64) -> f64 {
    let ways = points.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs());
    ways.sum::<f64>() / range * f64::from(PANEL_HEIGHT)
}

/// Width of a text in the captions.
fn width_of(text: &str) -> i32 {
    let width = (FONT, 15).into_font().box_size(text).map(|(width, _)| width);
    width.map_or_else(
        |_| i32::try_from(text.chars().count()).map_or(0, |count| count * 8),
        |width| i32::try_from(width).unwrap_or(0),
    )
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
