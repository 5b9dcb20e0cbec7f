//! Pictures as PNG: drawn large, then averaged down, which smooths every edge.

use std::error::Error;

use plotters::prelude::*;
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind};

use super::{FONT, Picture};

/// Drawn pixels to one of the SVG.
const DRAWN: i32 = 4;
/// Drawn pixels to one of the PNG.
const AVERAGED: usize = 2;

/// The picture as PNG.
pub(super) fn png(picture: &impl Picture) -> Result<Vec<u8>, Box<dyn Error>> {
    let factor = DRAWN.unsigned_abs();
    let (width, height) = picture.size();
    let (width, height) = (width * factor, height * factor);
    let mut pixels = vec![255; 3 * width as usize * height as usize];
    {
        let inner = BitMapBackend::with_buffer(&mut pixels, (width, height));
        let root = Enlarged { inner }.into_drawing_area();
        picture.draw_on(&root)?;
        root.present()?;
    }
    let (small_width, small_height) = (width as usize / AVERAGED, height as usize / AVERAGED);
    let small = averaged(&pixels, width as usize, (small_width, small_height));
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, u32::try_from(small_width)?, u32::try_from(small_height)?);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&small)?;
    writer.finish()?;
    Ok(file)
}

fn averaged(pixels: &[u8], wide: usize, (width, height): (usize, usize)) -> Vec<u8> {
    let mut small = Vec::with_capacity(3 * width * height);
    for y in 0..height {
        for x in 0..width {
            for color in 0..3 {
                let at =
                    |i: usize, j: usize| u32::from(pixels[3 * ((AVERAGED * y + j) * wide + AVERAGED * x + i) + color]);
                let sum: u32 =
                    (0..AVERAGED).flat_map(|j| (0..AVERAGED).map(move |i| (i, j))).map(|(i, j)| at(i, j)).sum();
                let count = u32::try_from(AVERAGED * AVERAGED).unwrap_or(1);
                small.push(u8::try_from((sum + count / 2) / count).unwrap_or(255));
            }
        }
    }
    small
}

/// A bitmap that takes coordinates and sizes of the SVG.
struct Enlarged<'a> {
    inner: BitMapBackend<'a>,
}

struct Style {
    color: BackendColor,
    width: u32,
}

impl BackendStyle for Style {
    fn color(&self) -> BackendColor {
        self.color
    }

    fn stroke_width(&self) -> u32 {
        self.width
    }
}

fn enlarged((x, y): BackendCoord) -> BackendCoord {
    (DRAWN * x, DRAWN * y)
}

fn wide(style: &impl BackendStyle) -> Style {
    Style { color: style.color(), width: style.stroke_width() * DRAWN.unsigned_abs() }
}

type Drawn<'a> = Result<(), DrawingErrorKind<<BitMapBackend<'a> as DrawingBackend>::ErrorType>>;

impl<'a> DrawingBackend for Enlarged<'a> {
    type ErrorType = <BitMapBackend<'a> as DrawingBackend>::ErrorType;

    fn get_size(&self) -> (u32, u32) {
        let (width, height) = self.inner.get_size();
        (width / DRAWN.unsigned_abs(), height / DRAWN.unsigned_abs())
    }

    fn ensure_prepared(&mut self) -> Drawn<'a> {
        self.inner.ensure_prepared()
    }

    fn present(&mut self) -> Drawn<'a> {
        self.inner.present()
    }

    fn draw_pixel(&mut self, point: BackendCoord, color: BackendColor) -> Drawn<'a> {
        let (x, y) = enlarged(point);
        self.inner.draw_rect((x, y), (x + DRAWN - 1, y + DRAWN - 1), &Style { color, width: 1 }, true)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn<'a> {
        self.inner.draw_line(enlarged(from), enlarged(to), &wide(style))
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        upper_left: BackendCoord,
        bottom_right: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn<'a> {
        self.inner.draw_rect(enlarged(upper_left), enlarged(bottom_right), &wide(style), fill)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn<'a> {
        // Piece by piece with round joints: mitred ones shoot far beyond a sharp turn.
        let style = wide(style);
        let mut last = None;
        for place in path.into_iter().map(enlarged) {
            if let Some(last) = last {
                self.inner.draw_path([last, place], &style)?;
                if style.width > 2 {
                    self.inner.draw_circle(place, style.width / 2, &style, true)?;
                }
            }
            last = Some(place);
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(&mut self, center: BackendCoord, radius: u32, style: &S, fill: bool) -> Drawn<'a> {
        self.inner.draw_circle(enlarged(center), radius * DRAWN.unsigned_abs(), &wide(style), fill)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn<'a> {
        self.inner.fill_polygon(path.into_iter().map(enlarged), &wide(style))
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Drawn<'a> {
        let BackendColor { rgb: (r, g, b), .. } = style.color();
        let color = RGBColor(r, g, b);
        let large = TextStyle::from((FONT, style.size() * f64::from(DRAWN)).into_font())
            .color(&color)
            .transform(style.transform())
            .pos(style.anchor());
        self.inner.draw_text(text, &large, enlarged(at))
    }
}
