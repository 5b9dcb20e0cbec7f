//! One figure: drawn, as data, and how far the flight code lies from the plant.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::exit::Failure;
use crate::plot::{Picture, png, svg};

/// Differences above this share of the peak are marked.
pub(super) const MARKED: f64 = 1e-3;

/// A figure.
pub(super) struct Sheet {
    /// Its number in the paper.
    pub(super) number: &'static str,
    /// Its place on the page.
    pub(super) order: u32,
    pub(super) caption: String,
    pub(super) svg: String,
    pub(super) png: Vec<u8>,
    pub(super) csv: String,
    pub(super) differences: Vec<Difference>,
}

/// Flight code against plant, in one signal.
pub(super) struct Difference {
    pub(super) signal: &'static str,
    /// Largest difference over the plant's peak.
    pub(super) of_peak: f64,
    /// Where it is.
    pub(super) at: String,
}

impl Sheet {
    /// Draws a figure.
    pub(super) fn new(
        number: &'static str,
        order: u32,
        caption: String,
        picture: &impl Picture,
        csv: String,
        differences: Vec<Difference>,
    ) -> Result<Self, Failure> {
        let drawn = |error| Failure::Environment(anyhow::Error::msg(error));
        let (svg, png) = (svg(picture).map_err(drawn)?, png(picture).map_err(drawn)?);
        Ok(Self { number, order, caption, svg, png, csv, differences })
    }

    /// For programs.
    pub(super) fn json(&self) -> Value {
        let differences: Vec<Value> = self
            .differences
            .iter()
            .map(
                |difference| json!({ "signal": difference.signal, "of_peak": difference.of_peak, "at": difference.at }),
            )
            .collect();
        json!({ "figure": self.number, "caption": self.caption, "flight_against_plant": differences })
    }
}

impl Difference {
    /// In words.
    pub(super) fn text(&self) -> String {
        let mark = if self.of_peak > MARKED { ", above 0.1 %: marked" } else { "" };
        format!("{}: {:.4} % of the peak at {}{mark}", self.signal, 100.0 * self.of_peak, self.at)
    }
}

/// Flight code against plant, all figures.
pub(super) fn differences(sheets: &[Sheet]) -> String {
    let mut text = "flight code (f32) against plant, largest difference:\n".to_owned();
    for sheet in sheets {
        for difference in &sheet.differences {
            let _ = writeln!(text, "  figure {:<4} {}", sheet.number, difference.text());
        }
    }
    text
}
