//! Torque steps, friction and unbalance off: peaks, contacts, releases and lasting offsets.

use gimbal_servo::paper::{DEGREE_RAD, DYNE_CM_NM};
use gimbal_servo::{Config, Faults, Fixed, Number};
use host_tests::Row;
use host_tests::axis::{Run, System, run, run_plant, si};
use host_tests::compare::relative;
use host_tests::inputs::{at_period, bare, held, torque_pulse, torque_step};

/// Periods that the library offers [s].
const PERIODS_S: [f64; 5] = [0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3];

fn consistent() -> Config {
    bare(Config::consistent())
}

/// A stop that no torque of these tests reaches.
fn unstopped(mut config: Config) -> Config {
    config.gyro.stop_angle_rad = 0.1;
    config
}

fn step(system: System, config: &Config, dyne_cm: f64, time_s: f64) -> Run {
    run(system, config, &torque_step(dyne_cm, time_s, config.period_s))
}

fn plant_step(config: &Config, dyne_cm: f64, time_s: f64) -> Run {
    run_plant(config, &torque_step(dyne_cm, time_s, config.period_s))
}

/// Peaks were computed beforehand by an independent f64 program and printed to four digits, which is 0.1 %; 0.5 % of
/// them is asked for. 0.1 % of the plant is asked for at every period; the loop is exact for a held torque, so that
/// 1e-5 holds at every period, and both look at the same instants.
#[test]
fn paper_peaks_of_phi_under_torque_steps() {
    let cases = [
        (consistent(), 1e5, 0.0566),
        (consistent(), 1.96e5, 0.1110),
        (unstopped(consistent()), 3e5, 0.1699),
        (unstopped(bare(Config::as_printed())), 1e5, 0.1523),
    ];
    for (config, dyne_cm, peak_deg) in cases {
        for period_s in PERIODS_S {
            let config = at_period(config, period_s);
            let plant = plant_step(&config, dyne_cm, 2.0);
            for system in System::BOTH {
                let run = step(system, &config, dyne_cm, 2.0);
                let peak = run.peak_phi_rad();
                let case = format!("{} {dyne_cm} dyne cm at {period_s} s: {}", system.name(), peak / DEGREE_RAD);
                // At 2 ms and more the samples may miss the top: the peak of a 60 Hz oscillation by (1 - cos) of half
                // a period, 0.3 % at 4 ms.
                assert!(relative(peak / DEGREE_RAD, peak_deg) <= 0.005, "{case}");
                assert!(relative(peak, plant.peak_phi_rad()) <= 1e-5, "{case}");
                assert!(relative(run.peak_theta_rad(), plant.peak_theta_rad()) <= 1e-5, "{case}");
                assert!(run.faults.is_empty(), "{case} {:?}", run.faults);
            }
        }
    }
}

/// Figures 2-1 and 2-2, and the misprint: theta meets its stop for 3e5 dyne cm only, as printed already for 1e5.
#[test]
fn paper_only_the_large_torque_brings_theta_to_its_stop() {
    let cases = [
        (consistent(), 1e5, false),
        (consistent(), 1.96e5, false),
        (consistent(), 3e5, true),
        (bare(Config::as_printed()), 1e5, true),
    ];
    for (config, dyne_cm, limited) in cases {
        for period_s in PERIODS_S {
            for system in System::BOTH {
                let run = step(system, &at_period(config, period_s), dyne_cm, 2.0);
                let case = format!("{} {dyne_cm} dyne cm at {period_s} s", system.name());
                assert_eq!(!run.events.is_empty(), limited, "{case}");
                assert_eq!(run.faults.contains(Faults::GYRO_SATURATED), limited, "{case}");
                assert_eq!(run.faults.contains(Faults::OFFSET_LEFT), limited, "{case}");
            }
        }
    }
}

/// Asked for: 0.2 % of the plant, contact and release to 0.1 ms. The cubic through both ends of a period places an
/// event to the fourth order of the period: at 1 ms and below the offset is met to 2e-4 and the times to 0.01 ms. At
/// 4 ms, a quarter of the loop's oscillation, 0.2 % and 0.1 ms still hold.
#[test]
fn cross_a_torque_kept_on_leaves_the_plants_offset() {
    for dyne_cm in [2.2e5, 2.3e5, 2.5e5, 2.75e5, 3e5, 3.5e5, 4e5] {
        for period_s in PERIODS_S {
            let config = at_period(consistent(), period_s);
            let plant = plant_step(&config, dyne_cm, 3.0);
            let (bound, time_bound_s) = if period_s <= 1e-3 { (2e-4, 1e-5) } else { (2e-3, 1e-4) };
            for system in System::BOTH {
                let run = step(system, &config, dyne_cm, 3.0);
                let off = relative(run.last().gimbal_angle_rad, plant.last().gimbal_angle_rad);
                let case = format!("{} {dyne_cm} dyne cm at {period_s} s: off by {off:e}", system.name());
                assert!(off <= bound, "{case}");
                assert_eq!(run.events.len(), plant.events.len(), "{case}");
                for (event, expected) in run.events.iter().zip(&plant.events) {
                    assert_eq!((event.contact, event.positive), (expected.contact, expected.positive), "{case}");
                    let late_s = event.time_s - expected.time_s;
                    assert!(late_s.abs() <= time_bound_s, "{case} {late_s:e} s late");
                }
                // theta is back near zero, and what is left of phi beside `theta Bo / H` is what went unseen.
                let last = run.last();
                let theta_off = last.gyro_angle_rad - plant.last().gyro_angle_rad;
                assert!(theta_off.abs() < 1e-6, "{case} theta {}", last.gyro_angle_rad);
                let seen = last.gyro_angle_rad / config.gyro.low_frequency_gain();
                let unseen_off = run.residual_offset_rad + seen - last.gimbal_angle_rad;
                assert!(unseen_off.abs() < 1e-6, "{case} offset {}", run.residual_offset_rad);
            }
        }
    }
}

/// Figures computed beforehand by an independent f64 program, torque kept on for 10 s: half of the last digit, and
/// 0.2 %.
#[test]
fn paper_lasting_offsets_after_ten_seconds() {
    for (dyne_cm, offset_deg) in [(2.2e5, 0.1346), (2.5e5, 1.099), (3e5, 5.609), (4e5, 31.67)] {
        for system in System::BOTH {
            let run = step(system, &consistent(), dyne_cm, 10.0);
            let left_deg = run.last().gimbal_angle_rad / DEGREE_RAD;
            assert!(relative(left_deg, offset_deg) <= 0.002, "{} {dyne_cm}: {left_deg}", system.name());
            assert!(run.last().gyro_angle_rad.abs() < 1e-6);
        }
    }
}

/// Contact at 61.0 ms and release at 422.3 ms, printed to 0.1 ms.
#[test]
fn paper_contact_and_release_under_3e5_dyne_cm() {
    for system in System::BOTH {
        let run = step(system, &consistent(), 3e5, 1.0);
        let times_ms: Vec<f64> = run.events.iter().map(|event| event.time_s * 1e3).collect();
        assert_eq!(times_ms.len(), 2, "{times_ms:?}");
        assert!((times_ms[0] - 61.0).abs() <= 0.1 && (times_ms[1] - 422.3).abs() <= 0.1, "{times_ms:?}");
    }
}

/// -0.040 +- 0.001 deg, the small difference of two drifts of 5.6 deg: 1.8e-4 of either. Held inputs, so that the
/// torque ends at 4 s to the microsecond.
#[test]
fn paper_a_torque_switched_off_brings_most_of_the_offset_back() {
    for period_s in [0.25e-3, 0.5e-3, 1e-3] {
        let config = at_period(held(consistent()), period_s);
        let rows = torque_pulse(3e5, 4.0, 10.0, period_s);
        let plant = run_plant(&config, &rows);
        for system in System::BOTH {
            let run = run(system, &config, &rows);
            let left_deg = run.last().gimbal_angle_rad / DEGREE_RAD;
            let case = format!("{} at {period_s} s: {left_deg}", system.name());
            assert!((left_deg + 0.040).abs() <= 0.001, "{case}");
            let plant_deg = plant.last().gimbal_angle_rad / DEGREE_RAD;
            assert!((left_deg - plant_deg).abs() <= 0.001, "{case} against {plant_deg}");
            assert_eq!(run.events.len(), 4, "{case}: both stops are met");
            assert!(!run.events[2].positive, "{case}");
        }
    }
}

/// In the steady state the motor carries the torque: (1) with everything at rest.
#[test]
fn closed_form_the_motor_carries_a_steady_torque() {
    for system in System::BOTH {
        let run = step(system, &consistent(), 1e5, 10.0);
        assert!(relative(run.last().motor_torque_nm, 1e5 * DYNE_CM_NM) < 1e-5);
    }
}

/// A settled state is one that its row leaves alone: phi, theta and phi' stay zero and the motor carries the torque,
/// friction and unbalance included.
#[test]
fn closed_form_a_settled_state_stays_as_it_is() {
    fn stays<N: Number>() {
        let config = Config::consistent();
        let law = config.build::<N>().unwrap();
        let row = Row { accel_y_mps2: 30.0, vehicle_rate_radps: 0.1, torque_nm: 3e-3, ..Row::default() };
        let input = law.units().input(&si(&row));
        let mut state = law.settled(input);
        for _ in 0..2000 {
            let output = law.units().output(&law.step(&mut state, input));
            assert!(output.gimbal_angle_rad.abs() < 1e-8 && output.gyro_angle_rad.abs() < 1e-8, "{output:?}");
            let carried = output.friction_torque_nm + output.unbalance_torque_nm + row.torque_nm;
            assert!(relative(output.motor_torque_nm, carried) < 1e-6, "{output:?}");
            assert!(output.faults.is_empty(), "{output:?}");
        }
    }
    stays::<f32>();
    stays::<Fixed>();
}
