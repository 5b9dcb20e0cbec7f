//! Panels over time below each other, each with a quantity and its unit.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::unit::shown;
use super::{
    BAND, Envelope, FONT, GRID, INK, LEFT, Picture, RIGHT, SHADE, STYLES, WIDTH, clipped, decimal, draw_sample,
    simplified, svg, width_of,
};

const TITLE_HEIGHT: u32 = 44;
const PANEL_HEIGHT: u32 = 190;
const TIME_LABEL_HEIGHT: u32 = 24;
/// Room for the name, the unit and the legend above a panel.
const CAPTION_HEIGHT: i32 = 26;
/// Lines longer than this are drawn without dashes, in pixels.
const MOST_DASHED_PX: f64 = 20_000.0;

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

/// The area between two signals.
struct Band<'a> {
    name: &'a str,
    /// Along the upper one and back along the lower one.
    edge: Vec<(f64, f64)>,
}

/// Lines that share a unit.
pub(crate) struct Panel<'a> {
    title: &'a str,
    unit: &'a str,
    lines: Vec<Line<'a>>,
    band: Option<Band<'a>>,
}

impl<'a> Panel<'a> {
    /// A panel.
    pub(crate) fn new(title: &'a str, unit: &'a str, lines: Vec<Line<'a>>) -> Self {
        Self { title, unit, lines, band: None }
    }

    /// With the area between two signals behind the lines.
    pub(crate) fn with_band(self, name: &'a str, [upper, lower]: &[Envelope; 2]) -> Self {
        let mut edge = upper.edge(true);
        edge.extend(lower.edge(false).into_iter().rev());
        Self { band: Some(Band { name, edge }), ..self }
    }

    /// Everything that must be on paper.
    fn values(&self) -> impl Iterator<Item = f64> {
        let lines = self.lines.iter().flat_map(|line| &line.points);
        lines.chain(self.band.iter().flat_map(|band| &band.edge)).map(|(_, value)| *value)
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
        let least = panel.values().fold(0.0, f64::min);
        let most = panel.values().fold(0.0, f64::max);
        let (factor, unit) = shown(panel.unit, most.max(-least));
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
        if let Some(band) = &panel.band {
            let edge = band.edge.iter().map(|&(time_s, value)| (time_s, value * factor)).collect::<Vec<_>>();
            chart.draw_series(std::iter::once(Polygon::new(edge, BAND.filled())))?;
        }
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
        self.caption(panel, &unit, first, area)
    }

    /// Name and unit on the left, legend on the right.
    fn caption<B: DrawingBackend>(
        &self,
        panel: &Panel,
        unit: &str,
        first: bool,
        area: &DrawingArea<B, Shift>,
    ) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        let font = || (FONT, 15).into_font().color(&INK);
        let title = format!("{} [{unit}]", panel.title);
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
        let shade = (self.shaded_name, SHADE);
        let shades = panel.band.iter().map(|band| (band.name, BAND));
        for (name, color) in shades.chain((first && !self.shaded.is_empty()).then_some(shade)) {
            x -= width_of(name) - 12;
            area.draw(&Rectangle::new([(x - 26, y - 6), (x - 8, y + 6)], color.filled()))?;
            area.draw(&Text::new(name.to_owned(), (x, 6), font()))?;
            x -= 66;
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
