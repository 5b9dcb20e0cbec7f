//! One quantity over another: lines, points, bands, limits, fields; linear or logarithmic axes.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{
    FONT, GRID, INK, Picture, RIGHT, SHADE, STYLES, WIDTH, clipped, decimal, draw_sample, simplified, width_of,
};

const HEIGHT: i32 = 520;
const LEFT: i32 = 84;
const TOP: i32 = 44;
/// Height of one row of the legend.
const ROW: i32 = 24;
const BOTTOM: i32 = 64;
/// Width of a legend's sample, and the room around an entry.
const SAMPLE: i32 = 32;
const GAP: i32 = 26;
/// Room for a field's scale right of it.
const SCALE_ROOM: i32 = 120;
const BAND: RGBColor = RGBColor(216, 226, 236);
/// The field's colours, from its least to its most; their lightness falls steadily.
const RAMP: [(f64, f64, f64); 3] = [(250.0, 246.0, 225.0), (120.0, 170.0, 150.0), (12.0, 44.0, 90.0)];

/// An axis and what it shows.
pub(crate) struct Axis<'a> {
    /// Quantity and unit, as written.
    pub(crate) label: &'a str,
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) log: bool,
}

impl Axis<'_> {
    /// Share of the axis below a value.
    fn share(&self, value: f64) -> f64 {
        let scale = |value: f64| if self.log { value.max(1e-300).log10() } else { value };
        (scale(value) - scale(self.from)) / (scale(self.to) - scale(self.from))
    }

    /// Values with a line of the grid; those of a logarithmic axis are 1, 2 and 5 times powers of ten.
    fn ticks(&self) -> Vec<f64> {
        let inside = |value: &f64| (-1e-9..=1.0 + 1e-9).contains(&self.share(*value));
        if self.log {
            // Many decades have room for one line each.
            let digits: &[f64] = if self.to > 2e3 * self.from { &[1.0] } else { &[1.0, 2.0, 5.0] };
            return (-12..=12)
                .flat_map(|decade| digits.iter().map(move |digit| digit * 10_f64.powi(decade)))
                .filter(inside)
                .collect();
        }
        let rough = (self.to - self.from) / 9.0;
        let power = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(|step| *step >= rough);
        let step = step.unwrap_or(10.0 * power);
        let first = (self.from / step).ceil();
        (0..24).map(|k| (first + f64::from(k)) * step).filter(inside).collect()
    }
}

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

/// Values over a grid that covers the axes evenly, row by row from below; not a number where there is none.
pub(crate) struct Field<'a> {
    pub(crate) label: &'a str,
    pub(crate) columns: usize,
    pub(crate) values: Vec<f64>,
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
        root.draw(&Text::new(clipped(self.title), (LEFT, 14), (FONT, 17).into_font().color(&INK)))?;
        let top = TOP + self.legend_rows() * ROW + 26;
        let margin = i32::try_from(RIGHT)? + if self.field.is_some() { SCALE_ROOM } else { 0 };
        let frame = Frame { left: LEFT, right: i32::try_from(WIDTH)? - margin, top, bottom: self.height() - BOTTOM };
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
            root.draw(&Text::new(rounded(tick), (left - 8, y), label(HPos::Right, VPos::Center)))?;
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

    /// Names in the legend, with what stands before each: a series, or a shade.
    fn entries(&self) -> Vec<(&str, Result<Look, RGBColor>)> {
        let mut entries: Vec<_> =
            self.series.iter().filter(|s| !s.name.is_empty()).map(|s| (s.name, Ok(s.look))).collect();
        entries.extend(self.band.as_ref().map(|(name, _)| (*name, Err(BAND))));
        entries.extend(self.shaded.map(|(name, ..)| (name, Err(SHADE))));
        entries
    }

    /// Row and x of each entry.
    fn legend_places(&self) -> Vec<(i32, i32)> {
        let most = i32::try_from(WIDTH - RIGHT).unwrap_or(i32::MAX);
        let (mut row, mut x) = (0, LEFT);
        self.entries()
            .iter()
            .map(|(name, _)| {
                let width = SAMPLE + 8 + width_of(name);
                if x > LEFT && x + width > most {
                    (row, x) = (row + 1, LEFT);
                }
                let place = (row, x);
                x += width + GAP;
                place
            })
            .collect()
    }

    fn legend_rows(&self) -> i32 {
        self.legend_places().last().map_or(0, |(row, _)| row + 1)
    }

    fn draw_legend<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        for ((name, look), (row, x)) in self.entries().into_iter().zip(self.legend_places()) {
            let y = TOP + row * ROW + 8;
            match look {
                Ok(Look::Line(style)) => draw_sample(root, (x, x + SAMPLE, y), STYLES[style % STYLES.len()])?,
                Ok(look @ (Look::Points(style) | Look::Crosses(style))) => {
                    draw_mark(root, (x + SAMPLE - 8, y), look, STYLES[style % STYLES.len()].0)?;
                }
                Err(shade) => root.draw(&Rectangle::new([(x + 8, y - 6), (x + SAMPLE, y + 6)], shade.filled()))?,
            }
            root.draw(&Text::new(name.to_owned(), (x + SAMPLE + 8, y), label(HPos::Left, VPos::Center)))?;
        }
        Ok(())
    }
}

impl Field<'_> {
    fn range(&self) -> (f64, f64) {
        let values = || self.values.iter().copied().filter(|value| value.is_finite());
        let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        if most > least { (least, most) } else { (least.min(0.0), least.max(0.0) + 1.0) }
    }

    fn draw_on<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>, frame: Frame) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        let (least, most) = self.range();
        let columns = self.columns.max(1);
        let rows = self.values.len().div_ceil(columns).max(1);
        for (index, value) in self.values.iter().enumerate() {
            let (column, row) = (index % columns, index / columns);
            let x = |column: usize| along(column as f64 / columns as f64, frame.left, frame.right);
            let y = |row: usize| along(row as f64 / rows as f64, frame.bottom, frame.top);
            let corners = [(x(column), y(row + 1)), (x(column + 1), y(row))];
            // A cell without a value is crossed out.
            if value.is_finite() {
                root.draw(&Rectangle::new(corners, ramp((value - least) / (most - least)).filled()))?;
            } else {
                root.draw(&PathElement::new(corners.to_vec(), INK.stroke_width(1)))?;
            }
        }
        let (left, right) = (frame.right + 24, frame.right + 44);
        for step in 0..64 {
            let y = |step: i32| along(f64::from(step) / 64.0, frame.bottom, frame.top);
            let corners = [(left, y(step + 1)), (right, y(step))];
            root.draw(&Rectangle::new(corners, ramp(f64::from(step) / 63.0).filled()))?;
        }
        let scale = Axis { label: "", from: least, to: most, log: false };
        for tick in scale.ticks() {
            let y = along(scale.share(tick), frame.bottom, frame.top);
            root.draw(&Text::new(rounded(tick), (right + 6, y), label(HPos::Left, VPos::Center)))?;
        }
        let style = label(HPos::Right, VPos::Bottom);
        let at = (i32::try_from(WIDTH - RIGHT)?, frame.top - 10);
        Ok(root.draw(&Text::new(self.label.to_owned(), at, style))?)
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

#[allow(clippy::cast_possible_truncation, reason = "a place on paper")]
fn along(share: f64, from: i32, to: i32) -> i32 {
    (f64::from(from) + share * f64::from(to - from)).round() as i32
}

fn ramp(share: f64) -> RGBColor {
    let share = share.clamp(0.0, 1.0) * 2.0;
    let (from, to, share) = if share < 1.0 { (RAMP[0], RAMP[1], share) } else { (RAMP[1], RAMP[2], share - 1.0) };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let mix = |from: f64, to: f64| (from + share * (to - from)).round() as u8;
    RGBColor(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

/// A line cut into dashes along its length.
fn dashes(places: &[(i32, i32)], dash: Option<(i32, i32)>) -> Vec<Vec<(i32, i32)>> {
    let Some((on, off)) = dash else { return vec![places.to_vec()] };
    let (on, off) = (f64::from(on), f64::from(off));
    let mut pieces = Vec::new();
    let mut piece: Vec<(i32, i32)> = Vec::new();
    // Length that is left of the dash or the gap under way.
    let (mut drawing, mut left) = (true, on);
    for pair in places.windows(2) {
        let length = f64::from(pair[1].0 - pair[0].0).hypot(f64::from(pair[1].1 - pair[0].1));
        let at = |done: f64| (along(done / length, pair[0].0, pair[1].0), along(done / length, pair[0].1, pair[1].1));
        let mut done = 0.0;
        if drawing && piece.is_empty() {
            piece.push(pair[0]);
        }
        while length - done > left {
            done += left;
            if drawing {
                piece.push(at(done));
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece.push(at(done));
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        left -= length - done;
        if drawing {
            piece.push(pair[1]);
        }
    }
    pieces.push(piece);
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

/// A tick's value, short.
fn rounded(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-4 { format!("{value:.0e}") } else { decimal(value) }
}

#[cfg(test)]
mod tests {
    use super::{Axis, dashes, ramp};

    #[test]
    fn closed_form_ticks_are_round_and_inside() {
        let linear = Axis { label: "", from: 0.0, to: 10.0, log: false };
        assert_eq!(linear.ticks(), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        let log = Axis { label: "", from: 0.9, to: 25.0, log: true };
        assert_eq!(log.ticks(), [1.0, 2.0, 5.0, 10.0, 20.0]);
    }

    #[test]
    fn closed_form_dashes_share_a_line() {
        let pieces = dashes(&[(0, 0), (15, 0), (30, 0)], Some((8, 4)));
        assert_eq!(pieces, [vec![(0, 0), (8, 0)], vec![(12, 0), (15, 0), (20, 0)], vec![(24, 0), (30, 0)]]);
    }

    /// Lightness falls along the ramp, so that it reads in grey.
    #[test]
    fn closed_form_ramp_reads_in_grey() {
        let light = |share| {
            let color = ramp(share);
            3 * u32::from(color.0) + 6 * u32::from(color.1) + u32::from(color.2)
        };
        assert!((0..20).all(|k| light(f64::from(k) / 20.0) > light(f64::from(k + 1) / 20.0)));
    }
}
