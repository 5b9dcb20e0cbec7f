//! Pictures in one style, readable in grey: panels over time below each other, and charts of one quantity over another.
//!
//! Lines differ in lightness and in dashes, not in hue alone. Sizes are in pixels of the SVG.

mod bitmap;
mod chart;
mod envelope;
mod panels;
mod simplify;
mod unit;

pub(crate) use chart::{Axis, Chart, Field, Look, Series};
pub(crate) use envelope::Envelope;
pub(crate) use panels::{Figure, Line, Panel};

use std::error::Error;
use std::sync::Once;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;

use simplify::simplified;

const WIDTH: u32 = 1000;
/// Room for numbers left of a panel.
const LEFT: u32 = 84;
const RIGHT: u32 = 24;
const FONT: &str = "sans-serif";
const INK: RGBColor = RGBColor(34, 34, 34);
const GRID: RGBColor = RGBColor(214, 214, 214);
const SHADE: RGBColor = RGBColor(222, 204, 160);
const BAND: RGBColor = RGBColor(196, 212, 228);

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

/// Width of a text in the captions.
fn width_of(text: &str) -> i32 {
    let width = (FONT, 15).into_font().box_size(text).map(|(width, _)| width);
    width.map_or_else(
        |_| i32::try_from(text.chars().count()).map_or(0, |count| count * 8),
        |width| i32::try_from(width).unwrap_or(0),
    )
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
    use super::decimal;

    #[test]
    fn closed_form_labels_have_no_tail() {
        assert_eq!(decimal(0.1 + 0.2), "0.3");
        assert_eq!(decimal(-1e-10), "0");
    }
}
