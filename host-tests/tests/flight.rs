//! Inputs that move between samples: the recorded rocket flight and a noisy manoeuvre, against the plant.
//!
//! Both see point samples: the plant a straight line between rows, the law their mean.

use gimbal_servo::{Config, Faults};
use host_tests::Row;
use host_tests::axis::{Run, System, run, run_plant};
use host_tests::inputs::manoeuvre;
use host_tests::rocket::{Gimbal, flight, path};

/// A debug build flies less of it.
const FLIGHT_S: f64 = if cfg!(debug_assertions) { 12.0 } else { 1e9 };

/// Asked for: phi within 1e-3 of its peak.
const BOUND: f64 = 1e-3;

fn check(name: &str, config: &Config, rows: &[Row]) {
    let plant = run_plant(config, rows);
    for system in System::BOTH {
        let run = run(system, config, rows);
        let case = format!("{name} {}", system.name());
        println!("{case}: {}", told(&run, &plant));
        let off = run.difference(&plant, |sample| sample.gimbal_angle_rad);
        assert!(off <= BOUND, "{case}: phi off by {off:.2e} of its peak");
        // The gyro meets its stop exactly where the plant's does, and nothing else is at fault.
        assert_eq!(run.events.len(), plant.events.len(), "{case}");
        let saturated = Faults::GYRO_SATURATED | Faults::OFFSET_LEFT;
        let expected = if plant.events.is_empty() { Faults::NONE } else { saturated };
        assert_eq!(run.faults, expected, "{case}");
    }
}

fn told(run: &Run, plant: &Run) -> String {
    let phi = run.difference(plant, |sample| sample.gimbal_angle_rad);
    let theta = run.difference(plant, |sample| sample.gyro_angle_rad);
    let velocity = [0, 1].map(|axis| run.difference(plant, |sample| sample.velocity_error_mps[axis]));
    let peak = plant.peak_phi_rad();
    format!(
        "peak phi {peak:.3e} rad, off by {phi:.2e}; theta off by {theta:.2e}; velocity error off by {:.2e} {:.2e}",
        velocity[0], velocity[1]
    )
}

/// Roll gimbal, z = rocket x: axial load to 16 g, spin beyond 800 deg/s.
#[test]
fn cross_the_rocket_flight_on_its_roll_gimbal() {
    match flight(Gimbal::Roll, FLIGHT_S) {
        Some(rows) => check("rocket roll", &Config::consistent(), &rows),
        None => println!("skipped: no recording at {}", path().display()),
    }
}

/// Pitch gimbal, z = rocket y: radial load to 16 g, rate reversals.
#[test]
fn cross_the_rocket_flight_on_its_pitch_gimbal() {
    match flight(Gimbal::Pitch, FLIGHT_S) {
        Some(rows) => check("rocket pitch", &Config::consistent(), &rows),
        None => println!("skipped: no recording at {}", path().display()),
    }
}

#[test]
fn cross_a_noisy_manoeuvre() {
    for seed in 1..=3 {
        check(&format!("manoeuvre {seed}"), &Config::consistent(), &manoeuvre(FLIGHT_S.min(20.0), 1e-3, seed));
    }
}
