//! Differences from a reference.

use gimbal_servo::paper::{DEGREE_RAD, STANDARD_GRAVITY_MPS2 as G};
use gimbal_servo::{Config, Fixed, Number};

use super::Error;
use crate::Row;
use crate::axis::{Axis, Run, Sample, System, run, run_plant};
use crate::exact::Exact;
use crate::hour::{Totals, plant_hour, steady, turning};
use crate::inputs::{
    at_period, bare, friction_profile, held, manoeuvre, torque_chirp, torque_jumps, torque_step, torques,
    unbalance_profile,
};
use crate::rocket::{Gimbal, flight};

pub(super) fn all() -> Vec<Error> {
    let mut errors = exact();
    errors.extend(stops());
    errors.extend(flights());
    errors.push(tables());
    errors.extend(hour());
    errors
}

fn phi(sample: &Sample) -> f64 {
    sample.gimbal_angle_rad
}

fn theta(sample: &Sample) -> f64 {
    sample.gyro_angle_rad
}

/// The worst of both presets and both signals.
fn exact() -> Vec<Error> {
    let jumps = |seed| torque_jumps(1.0, 10_001, 1e-3, seed);
    let inputs = [
        ("step", vec![vec![1.0; 10_001]]),
        ("random jumps, six runs", (1..=6).map(jumps).collect()),
        ("chirp 0.1 to 200 Hz", vec![torque_chirp(1.0, 10_001, 1e-3)]),
    ];
    let worst = |system: System, runs: &[Vec<f64>]| {
        let mut worst = 0.0_f64;
        for torques_nm in runs {
            for config in [Config::consistent(), Config::as_printed()] {
                for peak_rad in [1e-3, 1.9e-3] {
                    let [phi, theta] = exact_errors(system, &held(bare(config)), torques_nm, peak_rad);
                    worst = worst.max(phi).max(theta);
                }
            }
        }
        worst
    };
    let error = |(name, runs): &(&str, Vec<Vec<f64>>)| Error {
        quantity: format!("phi and theta over 10 s, {name}"),
        reference: "exact",
        f32: worst(System::F32, runs),
        fixed: worst(System::Fixed, runs),
        bounds: [2e-6, 1e-6],
    };
    inputs.iter().map(error).collect()
}

/// Largest errors of phi and theta over their peaks, the torques scaled to a peak of phi.
///
/// # Panics
/// If theta meets a stop.
#[must_use]
pub fn exact_errors(system: System, config: &Config, torques_nm: &[f64], peak_rad: f64) -> [f64; 2] {
    let peaks = |angles: &[(f64, f64)]| {
        angles
            .iter()
            .fold([0.0, 0.0], |[phi, theta]: [f64; 2], angle| [phi.max(angle.0.abs()), theta.max(angle.1.abs())])
    };
    let scale = peak_rad / peaks(&Exact::run(config, torques_nm.iter().copied()))[0];
    // Torques that both number systems take without rounding them: what is compared is the loop.
    #[allow(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
    let torques_nm: Vec<f64> = torques_nm.iter().map(|&torque| f64::from((scale * torque) as f32)).collect();
    let exact = Exact::run(config, torques_nm.iter().copied());
    let run = run(system, config, &torques(&torques_nm));
    assert!(run.events.is_empty(), "the stops are out of reach");
    let off = |(sample, exact): (&Sample, &(f64, f64))| (phi(sample) - exact.0, theta(sample) - exact.1);
    let errors = peaks(&run.samples.iter().zip(&exact).map(off).collect::<Vec<_>>());
    let peaks = peaks(&exact);
    [errors[0] / peaks[0], errors[1] / peaks[1]]
}

/// Both number systems against the plant.
fn against_plant(quantity: &str, config: &Config, rows: &[Row], bound: f64, of: impl Fn(&Run, &Run) -> f64) -> Error {
    let plant = run_plant(config, rows);
    let [f32, fixed] = System::BOTH.map(|system| of(&run(system, config, rows), &plant));
    Error { quantity: quantity.to_owned(), reference: "plant", f32, fixed, bounds: [bound; 2] }
}

fn stops() -> Vec<Error> {
    let mut errors = Vec::new();
    for period_s in [0.25e-3, 1e-3, 4e-3] {
        let config = at_period(bare(Config::consistent()), period_s);
        let (mut offset, mut time_s) = ([0.0_f64; 2], [0.0_f64; 2]);
        for dyne_cm in [2.2e5, 2.5e5, 3e5, 3.5e5, 4e5] {
            let rows = torque_step(dyne_cm, 3.0, period_s);
            let plant = run_plant(&config, &rows);
            for (i, system) in System::BOTH.into_iter().enumerate() {
                let run = run(system, &config, &rows);
                offset[i] = offset[i].max((phi(run.last()) / phi(plant.last()) - 1.0).abs());
                for (event, expected) in run.events.iter().zip(&plant.events) {
                    time_s[i] = time_s[i].max((event.time_s - expected.time_s).abs());
                }
            }
        }
        let period_ms = 1e3 * period_s;
        errors.push(Error {
            quantity: format!("phi left, 2.2e5 to 4e5 dyne cm, {period_ms} ms"),
            reference: "plant",
            f32: offset[0],
            fixed: offset[1],
            bounds: [2e-3; 2],
        });
        errors.push(Error {
            quantity: format!("contact and release, the same, {period_ms} ms [s]"),
            reference: "plant",
            f32: time_s[0],
            fixed: time_s[1],
            bounds: [1e-4; 2],
        });
    }
    errors
}

fn flights() -> Vec<Error> {
    let config = Config::consistent();
    let off = |run: &Run, plant: &Run| run.difference(plant, phi);
    let both = |run: &Run, plant: &Run| run.difference(plant, phi).max(run.difference(plant, theta));
    let unbalance = config.without_friction();
    let friction = config.without_unbalance();
    let mut errors = vec![
        against_plant("angles, 20 g on the unbalance", &unbalance, &unbalance_profile(20.0, 1e-3), 1e-3, both),
        against_plant("angles, 20 g friction run", &friction, &friction_profile(20.0, 1e-3), 1e-3, both),
        against_plant("phi, noisy manoeuvre", &config, &manoeuvre(20.0, 1e-3, 1), 1e-3, off),
    ];
    for (name, gimbal) in [("roll gimbal, z = rocket x", Gimbal::Roll), ("pitch gimbal, z = rocket y", Gimbal::Pitch)] {
        if let Some(rows) = flight(gimbal, f64::INFINITY) {
            errors.push(against_plant(&format!("phi, recorded rocket flight, {name}"), &config, &rows, 1e-3, off));
        }
    }
    errors
}

/// Friction of the step against Palmgren's exact form over the whole range.
fn tables() -> Error {
    fn worst<N: Number>() -> f64 {
        let config = Config::consistent();
        let axis = Axis::<N>::new(&config).expect("a preset builds");
        let mut worst = 0.0_f64;
        for radial in 0..250 {
            for axial in 0..100 {
                for rate_deg in [0.2, 500.0, 875.0, 880.0, 1700.0, 2999.0] {
                    worst = worst.max(friction_error(
                        &axis,
                        &config,
                        f64::from(radial) * 0.2 * G,
                        f64::from(axial) * 0.2 * G,
                        rate_deg * DEGREE_RAD,
                    ));
                }
            }
        }
        worst
    }
    Error {
        quantity: "friction tables, 0-50 g radial, 0-20 g axial, 0-3000 deg/s".into(),
        reference: "Palmgren",
        f32: worst::<f32>(),
        fixed: worst::<Fixed>(),
        bounds: [1e-3; 2],
    }
}

/// Relative error of the friction that the first row of a run finds.
#[must_use]
pub fn friction_error<N: Number>(axis: &Axis<N>, config: &Config, radial: f64, axial: f64, rate: f64) -> f64 {
    let row = Row { accel_y_mps2: radial, accel_z_mps2: axial, vehicle_rate_radps: rate, ..Row::default() };
    let friction = axis.clone().step(&row).friction_torque_nm;
    (friction / config.bearing.friction_level_nm(radial, axial, rate) - 1.0).abs()
}

fn hour() -> Vec<Error> {
    let config = Config::consistent().without_friction();
    let rows = 3_600_000;
    let mut errors = Vec::new();
    for (name, row) in [("turning", turning as fn(u32) -> Row), ("steady", steady)] {
        let (single, fixed) = (Totals::of::<f32>(&config, rows, row), Totals::of::<Fixed>(&config, rows, row));
        let plant = plant_hour(&config, rows, row);
        let mut error = |quantity: &str, reference, bound, of: &dyn Fn(&Totals) -> f64| {
            errors.push(Error {
                quantity: format!("{quantity}, 1 h at {name} 20 g"),
                reference,
                f32: of(&single),
                fixed: of(&fixed),
                bounds: [bound; 2],
            });
        };
        error("position", "exact sum of the same phi", 1e-6, &Totals::position_error);
        error("velocity", "exact sum of the same phi", 1e-6, &Totals::velocity_error);
        error("position", "plant", 1e-3, &|totals| totals.position_off(plant.1));
        error("velocity", "plant", 1e-3, &|totals| totals.velocity_off(plant.0));
    }
    errors
}
