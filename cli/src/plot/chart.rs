//! One quantity over another: lines, points, bands, limits, fields; linear or logarithmic axes.

mod axis;
mod dashes;
mod field;
mod legend;

pub(crate) use axis::Axis;
pub(crate) use field::Field;

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{BAND, FONT, GRID, INK, LEFT, Picture, RIGHT, SHADE, STYLES, WIDTH, clipped, simplified};
use axis::{along, rounded};
use dashes::dashes;
use legend::ROW;

const HEIGHT: i32 = 520;
const TOP: i32 = 44;
const BOTTOM: i32 = 64;
/// The middle of small letters lies so far above that of their box.
const LOWER: i32 = 2;
/// Room for a field's scale right of it.
const SCALE_ROOM: i32 = 120;

/// How a series is drawn: a line of one of the three styles, or marks in its colour.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Look {
    Line(usize),
    Points(usize),
    Crosses(usize),
}

/// Points that belong together.
pub(crate) struct Series<'a> {
    pub(crate) name: &'a str,
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) look: Look,
}

/// A band's name and its points.
pub(crate) type Band<'a> = (&'a str, Vec<(f64, f64, f64)>);

/// A chart.
pub(crate) struct Chart<'a> {
    pub(crate) title: &'a str,
    pub(crate) x: Axis<'a>,
    pub(crate) y: Axis<'a>,
    pub(crate) series: Vec<Series<'a>>,
    /// Between two lines: name, and x, lower, upper.
    pub(crate) band: Option<Band<'a>>,
    /// A span of x behind everything, and its name.
    pub(crate) shaded: Option<(&'a str, f64, f64)>,
    pub(crate) field: Option<Field<'a>>,
}

/// Where the axes lie on paper.
#[derive(Clone, Copy)]
struct Frame {
    left: i32,
    right: i32,
    top: i32,
    bottom: i32,
}

impl Picture for Chart<'_> {
    fn size(&self) -> (u32, u32) {
        (WIDTH, (HEIGHT + self.legend_rows() * ROW).unsigned_abs())
    }

    fn draw_on<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        root.fill(&WHITE)?;
        root.draw(&Text::new(clipped(self.title), (i32::try_from(LEFT)?, 14), (FONT, 17).into_font().color(&INK)))?;
        let top = TOP + self.legend_rows() * ROW + 26;
        let margin = i32::try_from(RIGHT)? + if self.field.is_some() { SCALE_ROOM } else { 0 };
        let frame = Frame {
            left: i32::try_from(LEFT)?,
            right: i32::try_from(WIDTH)? - margin,
            top,
            bottom: self.height() - BOTTOM,
        };
        self.draw_background(root, frame)?;
        self.draw_axes(root, frame)?;
        for series in &self.series {
            self.draw_series(root, frame, series)?;
        }
        self.draw_legend(root)
    }
}

impl Chart<'_> {
    fn height(&self) -> i32 {
        HEIGHT + self.legend_rows() * ROW
    }

    fn place(&self, frame: Frame, (x, y): (f64, f64)) -> (i32, i32) {
        (along(self.x.share(x), frame.left, frame.right), along(self.y.share(y), frame.bottom, frame.top))
    }

    /// A line on paper, without the points that nobody could see, whose rounding would show as waves.
    fn path(&self, frame: Frame, points: impl Iterator<Item = (f64, f64)>) -> Vec<(i32, i32)> {
        let shares = points.map(|(x, y)| (self.x.share(x), self.y.share(y))).collect();
        let pixel = (1.0 / f64::from(frame.right - frame.left), 1.0 / f64::from(frame.bottom - frame.top));
        let kept = simplified(shares, pixel).into_iter();
        kept.map(|(x, y)| (along(x, frame.left, frame.right), along(y, frame.bottom, frame.top))).collect()
    }

    fn draw_background<B: DrawingBackend>(
        &self,
        root: &DrawingArea<B, Shift>,
        frame: Frame,
    ) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        if let Some((_, from, to)) = self.shaded {
            let (from, to) = (self.x.share(from).clamp(0.0, 1.0), self.x.share(to).clamp(0.0, 1.0));
            let corners =
                [(along(from, frame.left, frame.right), frame.top), (along(to, frame.left, frame.right), frame.bottom)];
            root.draw(&Rectangle::new(corners, SHADE.filled()))?;
        }
        if let Some((_, points)) = &self.band {
            let mut edge = self.path(frame, points.iter().map(|&(x, lower, _)| (x, lower)));
            edge.extend(self.path(frame, points.iter().rev().map(|&(x, _, upper)| (x, upper))));
            root.draw(&Polygon::new(edge, BAND.filled()))?;
        }
        if let Some(field) = &self.field {
            field.draw_on(root, frame)?;
        }
        Ok(())
    }

    fn draw_axes<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>, frame: Frame) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        let Frame { left, right, top, bottom } = frame;
        let covered = self.field.is_some();
        for tick in self.x.ticks() {
            let x = along(self.x.share(tick), left, right);
            let from = if covered { bottom } else { top };
            root.draw(&PathElement::new(vec![(x, from), (x, bottom + 4)], GRID.stroke_width(1)))?;
            root.draw(&Text::new(rounded(tick), (x, bottom + 8), label(HPos::Center, VPos::Top)))?;
        }
        for tick in self.y.ticks() {
            let y = along(self.y.share(tick), bottom, top);
            let to = if covered { left } else { right };
            root.draw(&PathElement::new(vec![(left - 4, y), (to, y)], GRID.stroke_width(1)))?;
            root.draw(&Text::new(rounded(tick), (left - 8, y + LOWER), label(HPos::Right, VPos::Center)))?;
        }
        root.draw(&PathElement::new(vec![(left, top), (left, bottom), (right, bottom)], INK.stroke_width(1)))?;
        let middle = i32::midpoint(left, right);
        root.draw(&Text::new(self.x.label.to_owned(), (middle, bottom + 32), label(HPos::Center, VPos::Top)))?;
        Ok(root.draw(&Text::new(self.y.label.to_owned(), (left, top - 10), label(HPos::Left, VPos::Bottom)))?)
    }

    fn draw_series<B: DrawingBackend>(
        &self,
        root: &DrawingArea<B, Shift>,
        frame: Frame,
        series: &Series,
    ) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        let on_paper = |&(x, y): &(f64, f64)| {
            let shown = |share: f64| (-1e-6..=1.0 + 1e-6).contains(&share);
            shown(self.x.share(x)) && shown(self.y.share(y))
        };
        let shown = || series.points.iter().filter(|point| on_paper(point)).copied();
        match series.look {
            Look::Line(style) => {
                let (color, width, dash) = STYLES[style % STYLES.len()];
                for piece in dashes(&self.path(frame, shown()), dash) {
                    root.draw(&PathElement::new(piece, color.stroke_width(width)))?;
                }
            }
            Look::Points(style) | Look::Crosses(style) => {
                for place in shown().map(|point| self.place(frame, point)) {
                    draw_mark(root, place, series.look, STYLES[style % STYLES.len()].0)?;
                }
            }
        }
        Ok(())
    }
}

fn label(horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    (FONT, 15).into_font().color(&INK).pos(Pos::new(horizontal, vertical))
}

fn draw_mark<B: DrawingBackend>(
    root: &DrawingArea<B, Shift>,
    (x, y): (i32, i32),
    look: Look,
    color: RGBColor,
) -> Result<(), Box<dyn Error>>
where
    B::ErrorType: 'static,
{
    if matches!(look, Look::Crosses(_)) {
        root.draw(&PathElement::new(vec![(x - 4, y - 4), (x + 4, y + 4)], color.stroke_width(2)))?;
        Ok(root.draw(&PathElement::new(vec![(x - 4, y + 4), (x + 4, y - 4)], color.stroke_width(2)))?)
    } else {
        Ok(root.draw(&Circle::new((x, y), 4, color.filled()))?)
    }
}
