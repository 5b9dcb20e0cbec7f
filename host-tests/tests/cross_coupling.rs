//! `gyro.cross_coupling`: theta turns the gyro's input axis, and a rate about the spin axis becomes drift.

use std::f64::consts::TAU;

use gimbal_servo::Config;
use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
use host_tests::Row;
use host_tests::axis::{System, run, run_plant};
use host_tests::compare::relative;
use host_tests::inputs::bare;

fn coupled(mut config: Config) -> Config {
    config.gyro.cross_coupling = true;
    config
}

/// Drift of phi that the coupling makes: phi with it less phi without.
fn drift(with: &[f64], without: &[f64]) -> Vec<f64> {
    with.iter().zip(without).map(|(a, b)| a - b).collect()
}

fn angles(run: &host_tests::axis::Run) -> Vec<f64> {
    run.samples.iter().map(|sample| sample.gimbal_angle_rad).collect()
}

/// Under a torque that grows steadily theta is steady, `rate / K`, and phi drifts at `-theta w_x`: the mean of theta
/// over the run times the time, to what theta's own samples give.
#[test]
fn closed_form_a_steady_theta_drifts_at_its_rate() {
    let config = coupled(bare(Config::consistent()));
    let spin = 0.05;
    let rows: Vec<Row> = (0..=20_000)
        .map(|k| Row { torque_nm: 1.5e-6 * f64::from(k), spin_rate_radps: spin, ..Row::default() })
        .collect();
    let still: Vec<Row> = rows.iter().map(|row| Row { spin_rate_radps: 0.0, ..*row }).collect();
    for system in System::BOTH {
        let with = run(system, &config, &rows);
        let without = run(system, &config, &still);
        let drift = with.last().gimbal_angle_rad - without.last().gimbal_angle_rad;
        let expected: f64 = -with.samples.iter().map(|sample| sample.gyro_angle_rad * spin * 1e-3).sum::<f64>();
        // The servo holds theta, which the coupling changes by w_x over the loop's bandwidth: 1e-3.
        let bound = 5e-3;
        assert!(relative(drift, expected) < bound, "{} {drift} {expected}", system.name());
    }
}

/// Off by default, and then the rate about the spin axis does nothing.
#[test]
fn closed_form_without_the_option_nothing_couples() {
    let rows = |spin: f64| -> Vec<Row> {
        (0..500).map(|_| Row { torque_nm: 0.01, spin_rate_radps: spin, ..Row::default() }).collect()
    };
    for system in System::BOTH {
        let config = bare(Config::consistent());
        let (still, spun) = (run(system, &config, &rows(0.0)), run(system, &config, &rows(1.0)));
        assert_eq!(angles(&still), angles(&spun));
    }
}

/// The law multiplies each row's spin rate by theta of the row before: a drift that swings f times a second comes out
/// `2 pi f T` too late, 3e-3 of it at 0.5 Hz and 2e-2 at 3 Hz. The drift of a transient is off by a period times its
/// bandwidth, 4e-3 here, and by what the stop adds while theta falls from it. A run through a saturation has an offset
/// met to 2e-4, with the coupling and without: a difference of the two is off by as much of phi's peak.
#[test]
fn cross_drift_agrees_with_the_plant() {
    type Inputs = fn(f64) -> Row;
    let cases: [(&str, f64, Config, Inputs); 5] = [
        ("step, steady spin", 5e-3, bare(Config::consistent()), |_| Row {
            torque_nm: 0.015,
            spin_rate_radps: 0.1,
            ..Row::default()
        }),
        ("swinging torque and spin", 5e-3, bare(Config::consistent()), |t| Row {
            torque_nm: 0.012 * (TAU * 0.5 * t).sin(),
            spin_rate_radps: 0.5 * (TAU * 0.5 * t).cos(),
            ..Row::default()
        }),
        ("fast spin", 2e-2, bare(Config::consistent()), |t| Row {
            torque_nm: 0.01 * (TAU * 1.3 * t).sin(),
            spin_rate_radps: 10.0 * (TAU * 3.0 * t).sin(),
            ..Row::default()
        }),
        ("unbalance and friction", 5e-3, Config::consistent(), |t| Row {
            accel_y_mps2: 10.0 * STANDARD_GRAVITY_MPS2,
            vehicle_rate_radps: 0.3 * (TAU * 0.3 * t).cos(),
            spin_rate_radps: 0.2,
            ..Row::default()
        }),
        ("through a saturation", 2e-2, bare(Config::consistent()), |_| Row {
            torque_nm: 0.025,
            spin_rate_radps: 0.1,
            ..Row::default()
        }),
    ];
    for (name, bound, config, input) in cases {
        let rows: Vec<Row> = (0..=6000).map(|k| input(f64::from(k) * 1e-3)).collect();
        let (on, off) = (coupled(config), config);
        let (plant_on, plant_off) = (run_plant(&on, &rows), run_plant(&off, &rows));
        let plant_drift = drift(&angles(&plant_on), &angles(&plant_off));
        let size = plant_drift.iter().fold(0.0, |most: f64, drift| most.max(drift.abs()));
        for system in System::BOTH {
            let (run_on, run_off) = (run(system, &on, &rows), run(system, &off, &rows));
            let phi = run_on.difference(&plant_on, |sample| sample.gimbal_angle_rad);
            let ours = drift(&angles(&run_on), &angles(&run_off));
            let worst = drift(&ours, &plant_drift).iter().fold(0.0, |most: f64, drift| most.max(drift.abs()));
            let text = format!(
                "{name} {}: drift {size:.2e} rad, off by {:.2e} of it; phi off by {phi:.2e} {:?}",
                system.name(),
                worst / size,
                run_on.faults,
            );
            println!("{text}");
            let offset = if run_on.events.is_empty() { 0.0 } else { 2e-4 * plant_on.peak_phi_rad() };
            assert!(phi <= bound && worst <= bound * size + offset, "{text}");
        }
    }
}
