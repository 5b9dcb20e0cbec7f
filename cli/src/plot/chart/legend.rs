//! The legend above a chart.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::super::{BAND, INK, LEFT, RIGHT, SHADE, STYLES, WIDTH, draw_sample, width_of};
use super::{Chart, LOWER, Look, TOP, draw_mark, label};

/// Height of one row of the legend.
pub(super) const ROW: i32 = 24;
/// Width of a legend's sample, and the room around an entry.
const SAMPLE: i32 = 32;
const GAP: i32 = 26;

/// What stands before a name.
#[derive(Clone, Copy)]
enum Sample {
    Drawn(Look),
    Shade(RGBColor),
    /// A crossed-out cell.
    Hole,
}

impl Chart<'_> {
    /// Names in the legend, with what stands before each.
    fn entries(&self) -> Vec<(&str, Sample)> {
        let named = self.series.iter().filter(|series| !series.name.is_empty());
        let mut entries: Vec<_> = named.map(|series| (series.name, Sample::Drawn(series.look))).collect();
        entries.extend(self.band.as_ref().map(|(name, _)| (*name, Sample::Shade(BAND))));
        entries.extend(self.shaded.map(|(name, ..)| (name, Sample::Shade(SHADE))));
        let holes = self.field.as_ref().filter(|field| field.has_holes());
        entries.extend(holes.map(|field| (field.missing, Sample::Hole)));
        entries
    }

    /// Row and x of each entry.
    fn legend_places(&self) -> Vec<(i32, i32)> {
        let left = i32::try_from(LEFT).unwrap_or(0);
        let most = i32::try_from(WIDTH - RIGHT).unwrap_or(i32::MAX);
        let (mut row, mut x) = (0, left);
        self.entries()
            .iter()
            .map(|(name, _)| {
                let width = SAMPLE + 8 + width_of(name);
                if x > left && x + width > most {
                    (row, x) = (row + 1, left);
                }
                let place = (row, x);
                x += width + GAP;
                place
            })
            .collect()
    }

    pub(super) fn legend_rows(&self) -> i32 {
        self.legend_places().last().map_or(0, |(row, _)| row + 1)
    }

    pub(super) fn draw_legend<B: DrawingBackend>(&self, root: &DrawingArea<B, Shift>) -> Result<(), Box<dyn Error>>
    where
        B::ErrorType: 'static,
    {
        for ((name, sample), (row, x)) in self.entries().into_iter().zip(self.legend_places()) {
            let y = TOP + row * ROW + 8;
            let corners = [(x + 8, y - 6), (x + SAMPLE, y + 6)];
            match sample {
                Sample::Drawn(Look::Line(style)) => {
                    draw_sample(root, (x, x + SAMPLE, y), STYLES[style % STYLES.len()])?;
                }
                Sample::Drawn(look @ (Look::Points(style) | Look::Crosses(style))) => {
                    draw_mark(root, (x + SAMPLE - 8, y), look, STYLES[style % STYLES.len()].0)?;
                }
                Sample::Shade(shade) => root.draw(&Rectangle::new(corners, shade.filled()))?,
                Sample::Hole => root.draw(&PathElement::new(corners.to_vec(), INK.stroke_width(1)))?,
            }
            let at = (x + SAMPLE + 8, y + LOWER);
            root.draw(&Text::new(name.to_owned(), at, label(HPos::Left, VPos::Center)))?;
        }
        Ok(())
    }
}
