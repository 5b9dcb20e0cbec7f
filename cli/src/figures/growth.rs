//! Figures 8 and 10: velocity error against acceleration, with a fitted power law and the limit of the gyro.

use std::fmt::Write;

use gimbal_servo::Config;

use super::refused;
use super::sheet::{Difference, MARKED, Sheet};
use crate::exit::Failure;
use crate::interrupt;
use crate::plot::{Axis, Chart, Look, Series};
use crate::run::model::{Initial, Model};
use crate::run::profile::Profile;
use crate::run::reference::Reference;
use crate::sweep::trial::{self, Case};

/// Accelerations that are run [g].
const ACCELS_G: [f64; 14] = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 12.5, 15.0, 17.5, 20.0, 25.0, 35.0];
/// Where the axis ends [g].
const MOST_G: f64 = 50.0;

/// A power law `factor * A^exponent`, A in g.
#[derive(Debug, Clone, Copy)]
pub(super) struct Power {
    pub(super) factor: f64,
    pub(super) exponent: f64,
}

impl Power {
    /// Least squares of the logarithms.
    pub(super) fn fit(points: &[(f64, f64)]) -> Self {
        let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
        let count = logs.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(|log| log.0), mean(|log| log.1));
        let covariance: f64 = logs.iter().map(|log| (log.0 - x) * (log.1 - y)).sum();
        let variance: f64 = logs.iter().map(|log| (log.0 - x).powi(2)).sum();
        let exponent = covariance / variance;
        Self { factor: (y - exponent * x).exp(), exponent }
    }
}

/// Figures 8 and 10.
pub(super) fn sheets(config: &Config) -> Result<Vec<Sheet>, Failure> {
    Ok(vec![
        sheet(
            config,
            Case::Unbalance,
            ("8", 80, "Figure 8: velocity error after 5 s of acceleration, unbalance alone"),
        )?,
        sheet(
            config,
            Case::Friction,
            ("10", 100, "Figure 10: velocity error after 5 s of acceleration, friction alone, rate reversed every 2 s"),
        )?,
    ])
}

fn sheet(config: &Config, case: Case, (number, order, title): (&'static str, u32, &str)) -> Result<Sheet, Failure> {
    let limit_g = trial::saturation_g(config, case).map_err(refused)?;
    let mut csv = "accel_g,flight_velocity_error_mps,plant_velocity_error_mps,limited\n".to_owned();
    let (mut flight, mut excluded, mut plant, mut marked) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut most = (0.0, 0.0);
    for accel_g in ACCELS_G {
        interrupt::check()?;
        let outcome = trial::run(config, case, accel_g).map_err(refused)?;
        let reference = plant_velocity_error_mps(config, case, accel_g)?;
        let ours = outcome.velocity_error_mps;
        let _ = writeln!(csv, "{accel_g},{ours:.8e},{reference:.8e},{}", outcome.limited);
        plant.push((accel_g, reference));
        if outcome.limited { &mut excluded } else { &mut flight }.push((accel_g, ours));
        let difference = (ours - reference).abs() / reference;
        most = if difference > most.1 { (accel_g, difference) } else { most };
        if difference > MARKED {
            marked.push((accel_g, ours));
        }
    }
    let power = Power::fit(&flight);
    let line = |accel_g: f64| (accel_g, power.factor * accel_g.powf(power.exponent));
    let fit_name = format!("{:.2e} m/s * (A/g)^{:.3}", power.factor, power.exponent);
    let limit_name = limit_g.map(|limit_g| format!("gyro on its stop from {limit_g:.2} g: excluded"));
    // Runs on the stop lie decades above the power law.
    let least = flight.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
    let most_mps = excluded.iter().map(|point| point.1).fold(line(MOST_G).1, f64::max);
    let mut series = vec![
        Series { name: &fit_name, points: vec![line(1.0), line(MOST_G)], look: Look::Line(2) },
        Series { name: "plant", points: plant, look: Look::Crosses(1) },
        Series { name: "flight code", points: flight, look: Look::Points(0) },
    ];
    if !excluded.is_empty() {
        series.push(Series { name: "flight code, excluded", points: excluded, look: Look::Crosses(0) });
    }
    if !marked.is_empty() {
        series.push(Series { name: "differ by more than 0.1 %", points: marked, look: Look::Crosses(2) });
    }
    let chart = Chart {
        title,
        x: Axis { label: "acceleration [g]", from: 0.9, to: MOST_G, log: true },
        y: Axis { label: "velocity error [m/s]", from: 0.7 * least, to: 2.0 * most_mps, log: true },
        series,
        band: None,
        shaded: limit_g.zip(limit_name.as_deref()).map(|(limit_g, name)| (name, limit_g, MOST_G)),
        field: None,
    };
    let limit = limit_g.map_or_else(
        || format!("The gyro stays off its stop up to {MOST_G} g."),
        |limit_g| format!("The gyro meets its stop at {limit_g:.2} g; runs beyond are left out of the fit."),
    );
    let caption = format!("{title}; fitted: velocity error grows with A^{:.3}. {limit}", power.exponent);
    let difference = Difference { signal: "velocity error", of_peak: most.1, at: format!("{} g", most.0) };
    Sheet::new(number, order, caption, &chart, csv, vec![difference])
}

/// Exponents of the growth of phi, theta and the velocity error over the runs from `from_g` to `to_g`.
pub(super) fn exponents(
    config: &Config,
    case: Case,
    (from_g, to_g): (f64, f64),
) -> Result<[f64; 3], gimbal_servo::BuildError> {
    let (mut phi, mut theta, mut velocity) = (Vec::new(), Vec::new(), Vec::new());
    for accel_g in ACCELS_G.into_iter().filter(|accel_g| (from_g..=to_g).contains(accel_g)) {
        let outcome = trial::run(config, case, accel_g)?;
        if !outcome.limited {
            phi.push((accel_g, outcome.peak_gimbal_angle_rad));
            theta.push((accel_g, outcome.peak_gyro_angle_rad));
            velocity.push((accel_g, outcome.velocity_error_mps));
        }
    }
    Ok([&phi, &theta, &velocity].map(|points| Power::fit(points).exponent))
}

fn plant_velocity_error_mps(config: &Config, case: Case, accel_g: f64) -> Result<f64, Failure> {
    let config = case.config(config);
    let mut model = Reference::new(&config, Initial::Zero).map_err(refused)?;
    for k in 0..Profile::len(config.period_s) {
        model.step(&case.row(accel_g, k, config.period_s).into());
    }
    let [x, y] = model.sample().velocity_error_mps;
    Ok(x.hypot(y))
}
