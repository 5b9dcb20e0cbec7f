//! The paper's own runs: 10 s, acceleration for the first 5 s, unbalance or friction alone.

use gimbal_servo::paper::{DYNE_CM_NM, STANDARD_GRAVITY_MPS2};
use gimbal_servo::{Config, Faults};
use host_tests::axis::{Run, System, run, run_plant};
use host_tests::compare::{relative, slope};
use host_tests::inputs::{bare, friction_profile, unbalance_profile};

/// Accelerations of figures 8 and 10 at which theta keeps off its stops [g].
const UNSATURATED_G: [f64; 7] = [1.0, 2.0, 4.0, 8.0, 12.0, 16.0, 20.0];

fn unbalance(system: System, accel_g: f64) -> Run {
    run(system, &Config::consistent().without_friction(), &unbalance_profile(accel_g, 1e-3))
}

fn friction(system: System, accel_g: f64) -> Run {
    run(system, &Config::consistent().without_unbalance(), &friction_profile(accel_g, 1e-3))
}

/// 0.1072 m/s, computed beforehand by an independent f64 program, to 0.2 %. The published figure is 0.13: an open
/// difference of 18 %, which no coefficient of the loop explains. The closed form `A T_d Bo / (K H)` is what it would
/// settle at; after 5 s the pair T1 = 2.16, T6 = 2.24 s is not done: 4e-3 of it.
#[test]
fn closed_form_velocity_error_after_20_g_on_the_unbalance() {
    let config = Config::consistent();
    let accel = 20.0 * STANDARD_GRAVITY_MPS2;
    let steady_phi_s =
        config.unbalance.torque_nm(0.0, accel) / (config.servo.gain_nm_per_rad_s * config.gyro.low_frequency_gain());
    assert!(relative(accel * steady_phi_s, 0.1072) < 5e-3, "{}", accel * steady_phi_s);
    for system in System::BOTH {
        let run = unbalance(system, 20.0);
        assert!(relative(run.velocity_error_mps(), 0.1072) <= 0.002, "{}", run.velocity_error_mps());
        assert!(run.faults.is_empty(), "{:?}", run.faults);
        // It stays constant once the acceleration ends, and the position error goes on along that slope.
        let (then, now) = (&run.samples[5001], run.last());
        assert!(relative(then.velocity_error_mps[0], now.velocity_error_mps[0]) < 1e-12);
        let run_on_m = now.position_error_m[0] - then.position_error_m[0];
        let time_s = (run.samples.len() - 1 - 5001) as f64 * 1e-3;
        // A position's sums leave out what the velocity carries, less than a count of 2^-16 m/s2 times 1 ms: 1.5e-8 m/s.
        assert!((run_on_m - now.velocity_error_mps[0] * time_s).abs() < 1.6e-8 * time_s);
        assert!(now.velocity_error_mps[1].abs() < 1e-12, "a_x is zero");
    }
}

/// Both cases of the main job against the plant: 1e-3 of each peak. Inputs jump only where both see straight lines.
#[test]
fn cross_the_20_g_runs_agree_with_the_plant() {
    type Case = (&'static str, Config, Vec<host_tests::Row>);
    let cases: [Case; 2] = [
        ("unbalance", Config::consistent().without_friction(), unbalance_profile(20.0, 1e-3)),
        ("friction", Config::consistent().without_unbalance(), friction_profile(20.0, 1e-3)),
    ];
    for (name, config, rows) in cases {
        let plant = run_plant(&config, &rows);
        for system in System::BOTH {
            let run = run(system, &config, &rows);
            let off = run.angles_off(&plant, 1e-3);
            assert!(off.is_empty(), "{name} {}:{off}", system.name());
            let velocity = relative(run.velocity_error_mps(), plant.velocity_error_mps());
            assert!(velocity < 1e-3, "{name} {} velocity error off by {velocity:e}", system.name());
        }
    }
}

/// H / Bo = 4.315. Under a torque that grows steadily theta settles at `rate / K` and phi at `theta Bo / H`, (2) with
/// theta'' = 0. The slowest mode, of 2.16 s, is 1e-2 of it after 10 s and common to both.
#[test]
fn closed_form_low_frequency_gyro_gain() {
    let config = bare(Config::consistent());
    let rows: Vec<_> =
        (0..=10_000).map(|k| host_tests::Row { torque_nm: 4e-6 * f64::from(k), ..Default::default() }).collect();
    for system in System::BOTH {
        let last = *run(system, &config, &rows).last();
        let gain = last.gyro_angle_rad / last.gimbal_angle_rad;
        assert!(relative(gain, 4.315) <= 1e-3, "{} {gain}", system.name());
        let expected = 4e-3 / config.servo.gain_nm_per_rad_s;
        assert!(relative(last.gyro_angle_rad, expected) < 0.05, "{}", last.gyro_angle_rad);
    }
}

/// The loop is linear: angles grow as A, the velocity error as A times an angle.
#[test]
fn closed_form_growth_with_acceleration_on_the_unbalance() {
    for system in System::BOTH {
        let runs = UNSATURATED_G.map(|accel_g| (accel_g.ln(), unbalance(system, accel_g)));
        let exponent = |of: &dyn Fn(&Run) -> f64| {
            slope(&runs.iter().map(|(ln_accel, run)| (*ln_accel, of(run).ln())).collect::<Vec<_>>())
        };
        let phi = exponent(&Run::peak_phi_rad);
        let theta = exponent(&Run::peak_theta_rad);
        let velocity = exponent(&Run::velocity_error_mps);
        assert!((phi - 1.0).abs() <= 5e-4 && (theta - 1.0).abs() <= 5e-4, "{phi} {theta}");
        assert!((velocity - 2.0).abs() <= 0.005, "{velocity}");
    }
}

/// Friction grows with A to the 1.33 at most and has a part that does not grow: exponents between those, as they are.
#[test]
fn cross_growth_with_acceleration_under_friction_is_the_plants() {
    let config = Config::consistent().without_unbalance();
    let plants = UNSATURATED_G.map(|accel_g| run_plant(&config, &friction_profile(accel_g, 1e-3)));
    for system in System::BOTH {
        let runs = UNSATURATED_G.map(|accel_g| friction(system, accel_g));
        for i in 1..runs.len() {
            let step = (UNSATURATED_G[i] / UNSATURATED_G[i - 1]).ln();
            let exponent = |runs: &[Run], of: &dyn Fn(&Run) -> f64| (of(&runs[i]) / of(&runs[i - 1])).ln() / step;
            for of in [&Run::peak_phi_rad as &dyn Fn(&Run) -> f64, &Run::velocity_error_mps] {
                let (here, there) = (exponent(&runs, of), exponent(&plants, of));
                // Each end of a chord of 1.3 octaves or more is within 1e-3 of the plant: 2e-3 / ln(1.25).
                assert!((here - there).abs() <= 0.01, "{} {}: {here} {there}", system.name(), UNSATURATED_G[i]);
            }
        }
    }
}

/// The unbalance alone brings theta to its stop from 20.9 g (2.047e5 dyne cm), printed to 0.1 g.
#[test]
fn paper_the_unbalance_saturates_the_gyro_from_20_9_g() {
    let config = Config::consistent().without_friction();
    for system in System::BOTH {
        let saturates = |accel_g: f64| {
            let rows = &unbalance_profile(accel_g, 1e-3)[..1000];
            run(system, &config, rows).faults.contains(Faults::GYRO_SATURATED)
        };
        let (mut free, mut limited) = (20.0, 22.0);
        assert!(!saturates(free) && saturates(limited));
        while limited - free > 1e-3 {
            let middle = 0.5 * (free + limited);
            if saturates(middle) { limited = middle } else { free = middle }
        }
        assert!((limited - 20.9).abs() <= 0.05, "{} {limited}", system.name());
        let dyne_cm = config.unbalance.torque_nm(0.0, limited * STANDARD_GRAVITY_MPS2) / DYNE_CM_NM;
        assert!(relative(dyne_cm, 2.047e5) <= 0.002, "{dyne_cm}");
    }
}
