//! Error map of the step's friction tables against Palmgren's exact form.
//!
//! Prints CSV (radial and axial acceleration in g, worst relative error over rates and both signs, in both number
//! systems) and draws it:
//!
//! ```text
//! cargo run --release -p host-tests --example friction_map > friction-error.csv
//! ```

use std::error::Error;
use std::path::Path;

use gimbal_servo::paper::{DEGREE_RAD, STANDARD_GRAVITY_MPS2 as G};
use gimbal_servo::{Config, Fixed, Number};
use host_tests::axis::Axis;
use host_tests::figures::friction_error;
use plotters::prelude::*;

/// Cells of 1 g by 1 g.
const RADIAL: u32 = 50;
const AXIAL: u32 = 20;
const CELL_G: f64 = 1.0;
/// The colour scale ends at the bound: 0.1 %.
const BOUND: f64 = 1e-3;
const RATES_DEG: [f64; 8] = [0.2, 400.0, 870.0, 880.0, 1200.0, 1700.0, 2300.0, 2999.0];

type Map = Vec<(u32, u32, f64)>;

fn map<N: Number>() -> Result<Map, Box<dyn Error>> {
    let config = Config::consistent();
    let axis = Axis::<N>::new(&config)?;
    let mut cells = Vec::new();
    for radial in 0..RADIAL {
        for axial in 0..AXIAL {
            let mut worst = 0.0_f64;
            // Points in a cell, off its edges.
            for point in 0..16 {
                let (i, j) = ((0.5 + f64::from(point)) / 16.0, (0.5 + f64::from(5 * point % 16)) / 16.0);
                let (radial, axial) = ((f64::from(radial) + i) * CELL_G * G, (f64::from(axial) + j) * CELL_G * G);
                for rate_deg in RATES_DEG {
                    worst = worst.max(friction_error(&axis, &config, radial, axial, rate_deg * DEGREE_RAD));
                }
            }
            cells.push((radial, axial, worst));
        }
    }
    Ok(cells)
}

fn main() -> Result<(), Box<dyn Error>> {
    let maps = [("f32", map::<f32>()?), ("fixed point", map::<Fixed>()?)];
    println!("radial_g,axial_g,f32,fixed");
    for (single, fixed) in maps[0].1.iter().zip(&maps[1].1) {
        let (radial, axial) = (f64::from(single.0) * CELL_G, f64::from(single.1) * CELL_G);
        println!("{radial},{axial},{:.3e},{:.3e}", single.2, fixed.2);
    }
    draw(&maps, Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/img/friction-error.svg")))
}

/// White at zero, dark red at the bound.
fn colour(error: f64) -> RGBColor {
    let share = (error / BOUND).clamp(0.0, 1.0).sqrt();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let tone = |full: f64, none: f64| (none + share * (full - none)).round() as u8;
    RGBColor(tone(120.0, 255.0), tone(0.0, 255.0), tone(20.0, 250.0))
}

fn draw(maps: &[(&str, Map)], path: &Path) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, (880, 660)).into_drawing_area();
    root.fill(&WHITE)?;
    let (upper, legend) = root.split_vertically(570);
    for ((name, cells), area) in maps.iter().zip(upper.split_evenly((2, 1))) {
        let worst = cells.iter().fold(0.0, |most: f64, cell| most.max(cell.2));
        let title = format!("Friction tables in {name}: largest error {:.3} % of Palmgren's form", 100.0 * worst);
        let span = [f64::from(RADIAL) * CELL_G, f64::from(AXIAL) * CELL_G];
        let mut chart = ChartBuilder::on(&area)
            .caption(title, ("sans-serif", 18))
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(50)
            .build_cartesian_2d(0.0..span[0], 0.0..span[1])?;
        chart
            .configure_mesh()
            .disable_mesh()
            .label_style(("sans-serif", 12))
            .axis_desc_style(("sans-serif", 13))
            .x_desc("radial acceleration, g")
            .y_desc("axial acceleration, g")
            .x_label_formatter(&|value| format!("{value:.0}"))
            .y_label_formatter(&|value| format!("{value:.0}"))
            .draw()?;
        chart.draw_series(cells.iter().map(|&(radial, axial, error)| {
            let (x, y) = (f64::from(radial) * CELL_G, f64::from(axial) * CELL_G);
            Rectangle::new([(x, y), (x + CELL_G, y + CELL_G)], colour(error).filled())
        }))?;
    }
    let mut scale = ChartBuilder::on(&legend)
        .margin(10)
        .x_label_area_size(45)
        .y_label_area_size(50)
        .build_cartesian_2d(0.0..100.0 * BOUND, 0.0..1.0)?;
    scale
        .configure_mesh()
        .disable_mesh()
        .disable_y_axis()
        .label_style(("sans-serif", 12))
        .axis_desc_style(("sans-serif", 13))
        .x_desc("largest error over 0.2 to 2999 deg/s, % of the torque (0.1 % is the bound)")
        .x_label_formatter(&|value| format!("{value:.2}"))
        .draw()?;
    scale.draw_series((0..100).map(|step| {
        let left = BOUND * f64::from(step);
        Rectangle::new([(left, 0.0), (left + BOUND, 1.0)], colour(0.01 * left).filled())
    }))?;
    root.present()?;
    Ok(())
}
