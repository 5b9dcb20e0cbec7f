//! The accuracy table: every figure that the model is asked to show, measured afresh.

mod errors;
mod growth;
mod values;

pub use errors::{exact_errors, friction_error};

use std::fmt::Write;

/// What a figure may be off by.
#[derive(Debug, Clone, Copy)]
enum Bound {
    /// Relative to what is expected.
    Share(f64),
    /// In the figure's own unit.
    Within(f64),
    /// A published figure that the equations do not give.
    Open,
}

/// A quantity with an expected value.
struct Value {
    quantity: String,
    unit: &'static str,
    expected: f64,
    source: &'static str,
    f32: f64,
    fixed: f64,
    plant: Option<f64>,
    bound: Bound,
}

/// A difference from a reference, both relative to the reference's peak.
struct Error {
    quantity: String,
    reference: &'static str,
    f32: f64,
    fixed: f64,
    bounds: [f64; 2],
}

const HEAD: &str = "\
# Accuracy

Every figure that this model is asked to show, measured. Made by

    cargo run --release -p host-tests --example accuracy > docs/accuracy.md

and compared with this page by a test (`cargo test --release -p host-tests --test accuracy`). *f32* and *fixed* are the
flight law in its two number systems, 1 ms unless another period is named; *plant* is the f64 reference (`docs/plant.md`).
Parameters: preset *consistent* unless named.

## Values

Friction and unbalance are off under torques in dyne cm. Expected values: *f64* were computed by an independent f64 program
before this model was written; *paper* is printed in it; *closed form* follows from the equations.

";

const ERRORS: &str = "
## Differences

Largest difference over the whole run, relative to the reference's peak unless a unit is named. *exact*: the matrix
exponential of the physical state in f64 (`host-tests/src/exact.rs`), inputs held from row to row.

";

/// The whole page.
#[must_use]
pub fn page() -> String {
    let mut text = HEAD.to_owned();
    text += "| quantity | expected | source | f32 | fixed | plant | difference | bound | verdict |\n";
    text += "|---|---|---|---|---|---|---|---|---|\n";
    for value in values::all() {
        value.write(&mut text);
    }
    text += values::NOTE;
    text += ERRORS;
    text +=
        "| difference | reference | f32 | fixed | bound f32 | bound fixed | verdict |\n|---|---|---|---|---|---|---|\n";
    for error in errors::all() {
        error.write(&mut text);
    }
    text += &growth::table();
    text
}

/// Lines that need the recorded flight.
#[must_use]
pub fn needs_recording(line: &str) -> bool {
    line.contains("rocket")
}

impl Value {
    fn write(&self, text: &mut String) {
        let Self { quantity, unit, expected, source, f32, fixed, plant, bound } = self;
        let off = (f32 - expected).abs().max((fixed - expected).abs());
        let (off, bound_text, verdict) = match bound {
            Bound::Share(bound) => {
                let share = off / expected.abs();
                (format!("{:.3} %", 100.0 * share), format!("{} %", short(100.0 * bound)), verdict(share <= *bound))
            }
            Bound::Within(bound) => (short(off), short(*bound), verdict(off <= *bound)),
            Bound::Open => (format!("{:.1} %", 100.0 * off / expected.abs()), "-".to_owned(), "open"),
        };
        let plant = plant.map_or_else(|| "-".to_owned(), digits);
        let (f32, fixed) = (digits(*f32), digits(*fixed));
        let expected = short_value(*expected);
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        writeln!(
            text,
            "| {quantity} | {expected}{unit} | {source} | {f32} | {fixed} | {plant} | {off} | {bound_text} | {verdict} |"
        )
        .expect("a string takes all");
    }
}

impl Error {
    fn write(&self, text: &mut String) {
        let Self { quantity, reference, f32, fixed, bounds } = self;
        let met = *f32 <= bounds[0] && *fixed <= bounds[1];
        writeln!(
            text,
            "| {quantity} | {reference} | {} | {} | {} | {} | {} |",
            short(*f32),
            short(*fixed),
            short(bounds[0]),
            short(bounds[1]),
            verdict(met)
        )
        .expect("a string takes all");
    }
}

fn verdict(met: bool) -> &'static str {
    if met { "met" } else { "**missed**" }
}

/// Five significant digits, whole numbers whole.
fn digits(value: f64) -> String {
    let size = value.abs();
    let places = if size >= 1e4 {
        0
    } else if size >= 10.0 {
        3
    } else if size >= 0.1 {
        4
    } else {
        5
    };
    format!("{value:.places$}")
}

/// As short as it was written.
fn short_value(value: f64) -> String {
    format!("{value}")
}

/// Two digits.
fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if value.abs() >= 0.01 {
        let text = format!("{value:.3}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.1e}")
    }
}
