//! A field of values: cells whose lightness falls as the value grows, and the scale beside them.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::super::{INK, RIGHT, WIDTH};
use super::axis::{Axis, along, rounded};
use super::{Frame, LOWER, label};

/// The field's colours, from its least to its most; their lightness falls steadily.
const RAMP: [(f64, f64, f64); 3] = [(250.0, 246.0, 225.0), (120.0, 170.0, 150.0), (12.0, 44.0, 90.0)];

/// Values over a grid that covers the axes evenly, row by row from below; not a number where there is none.
pub(crate) struct Field<'a> {
    pub(crate) label: &'a str,
    pub(crate) columns: usize,
    pub(crate) values: Vec<f64>,
    /// What a cell without a value means.
    pub(crate) missing: &'a str,
}

impl Field<'_> {
    fn range(&self) -> (f64, f64) {
        let values = || self.values.iter().copied().filter(|value| value.is_finite());
        let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        if most > least { (least, most) } else { (least.min(0.0), least.max(0.0) + 1.0) }
    }

    /// Whether some cell has no value.
    pub(super) fn has_holes(&self) -> bool {
        self.values.iter().any(|value| !value.is_finite())
    }

    pub(super) fn draw_on<B: DrawingBackend>(
        &self,
        root: &DrawingArea<B, Shift>,
        frame: Frame,
    ) -> Result<(), Box<dyn Error>>
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
            root.draw(&Text::new(rounded(tick), (right + 6, y + LOWER), label(HPos::Left, VPos::Center)))?;
        }
        let style = label(HPos::Right, VPos::Bottom);
        let at = (i32::try_from(WIDTH - RIGHT)?, frame.top - 10);
        Ok(root.draw(&Text::new(self.label.to_owned(), at, style))?)
    }
}

fn ramp(share: f64) -> RGBColor {
    let share = share.clamp(0.0, 1.0) * 2.0;
    let (from, to, share) = if share < 1.0 { (RAMP[0], RAMP[1], share) } else { (RAMP[1], RAMP[2], share - 1.0) };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let mix = |from: f64, to: f64| (from + share * (to - from)).round() as u8;
    RGBColor(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

#[cfg(test)]
mod tests {
    use super::ramp;

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
