//! Figure 4: Palmgren's load torque of one bearing against its radial load.

use std::fmt::Write;

use gimbal_plant::{Plant, Row};
use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
use gimbal_servo::{Config, Input, Law};

use super::refused;
use super::sheet::{Difference, MARKED, Sheet};
use crate::exit::Failure;
use crate::plot::{Axis, Chart, Look, Series};

/// The paper's measured points lie within this of the curve.
const SCATTER: f64 = 0.15;
/// Largest radial acceleration drawn [g].
const MOST_G: f64 = 50.0;
const POINTS: u32 = 500;
const MILLI: f64 = 1e3;

/// Figure 4.
pub(super) fn sheets(config: &Config) -> Result<Vec<Sheet>, Failure> {
    // Load torque alone: no lubricant.
    let mut config = config.without_unbalance();
    config.bearing.lubrication_factor = 0.0;
    let bearing = &config.bearing;
    let each = 1.0 / f64::from(bearing.count);
    let law: Law<f32> = config.build().map_err(refused)?;
    let plant = Plant::new(&config).map_err(refused)?;
    let mut csv = "radial_accel_g,radial_load_n,palmgren_torque_nm,flight_torque_nm,plant_torque_nm\n".to_owned();
    let (mut flight, mut reference, mut band, mut marked) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut most = (0.0, 0.0);
    let mut peak = 0.0_f64;
    for k in 0..=POINTS {
        let accel_g = MOST_G * f64::from(k) / f64::from(POINTS);
        let accel_mps2 = accel_g * STANDARD_GRAVITY_MPS2;
        let (axial_n, load_n) = bearing.loads_n(accel_mps2, 0.0);
        let formula = bearing.load_torque_nm(axial_n, load_n);
        let row = Input { accel_y_mps2: accel_mps2, vehicle_rate_radps: 1.0, ..Input::default() };
        let output = law.step(&mut law.start(), law.units().input(&row));
        let stepped = each * law.units().output(&output).friction_torque_nm;
        let row = Row { accel_y_mps2: accel_mps2, vehicle_rate_radps: 1.0, ..Row::default() };
        let integrated = each * plant.sample(&plant.start(), &row).friction_torque_nm;
        let _ = writeln!(csv, "{accel_g},{load_n:.6},{formula:.8e},{stepped:.8e},{integrated:.8e}");
        peak = peak.max(integrated);
        let difference = (stepped - integrated).abs();
        most = if difference > most.1 { (load_n, difference) } else { most };
        flight.push((load_n, MILLI * stepped));
        band.push((load_n, MILLI * formula * (1.0 - SCATTER), MILLI * formula * (1.0 + SCATTER)));
        // Every tenth as a mark.
        if k % 10 == 0 {
            reference.push((load_n, MILLI * integrated));
        }
        marked.push((load_n, difference));
    }
    let largest_n = flight.last().map_or(1.0, |point| point.0);
    let top = band.last().map_or(1.0, |point| point.2);
    marked.retain(|(_, difference)| *difference > MARKED * peak);
    let title = "Figure 4: load torque of one bearing, preload 22.2 N (5 lbf), after Palmgren";
    let chart = Chart {
        title,
        x: Axis { label: "radial load of one bearing [N]", from: 0.0, to: largest_n, log: false },
        y: Axis { label: "load torque [mN m]", from: 0.0, to: 1.04 * top, log: false },
        series: vec![
            Series { name: "flight code (tables)", points: flight, look: Look::Line(0) },
            Series { name: "plant (formula)", points: reference, look: Look::Points(1) },
        ],
        band: Some(("+-15 %: the paper's measurements", band)),
        shaded: marked
            .first()
            .zip(marked.last())
            .map(|(from, to)| ("differ by more than 0.1 % of the peak", from.0, to.0)),
        field: None,
    };
    let boundary_n = bearing.load_boundary() * bearing.loads_n(0.0, 0.0).0;
    let caption = format!(
        "{title}; (6.1) gives way to (6.2) at {boundary_n:.1} N. 20 g are {:.1} N.",
        bearing.loads_n(20.0 * STANDARD_GRAVITY_MPS2, 0.0).1
    );
    let difference = Difference { signal: "load torque", of_peak: most.1 / peak, at: format!("{:.1} N", most.0) };
    Ok(vec![Sheet::new("4", 40, caption, &chart, csv, vec![difference])?])
}
