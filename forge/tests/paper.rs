//! The nominal platform against the figures that the paper prints or implies.

use gimbal_forge::{Machine, Row, Sample, Track, Truth};
use gimbal_servo::Config;
use gimbal_servo::paper::{DEGREE_RAD, DYNE_CM_NM, STANDARD_GRAVITY_MPS2};

fn run(config: &Config, rows: Vec<Row>) -> (Vec<Sample>, Vec<f64>) {
    let truth = Truth::new(config);
    let track = Track { period_s: 1e-3, rows };
    let mut machine = Machine::new(&truth, &track, 20, 0.0);
    let samples = (0..track.rows.len())
        .map(|index| {
            if index > 0 {
                machine.advance();
            }
            machine.sample()
        })
        .collect();
    (samples, machine.events_s)
}

fn peak(samples: &[Sample], of: impl Fn(&Sample) -> f64) -> f64 {
    samples.iter().map(|sample| of(sample).abs()).fold(0.0, f64::max)
}

fn torque_step(torque_nm: f64) -> (Vec<Sample>, Vec<f64>) {
    let config = Config::consistent().without_friction().without_unbalance();
    run(&config, vec![Row { external_nm: torque_nm, ..Row::default() }; 10_001])
}

#[test]
fn paper_torque_steps_meet_the_stop_where_the_paper_says() {
    let (samples, events) = torque_step(1e5 * DYNE_CM_NM);
    assert!((peak(&samples, |s| s.gimbal_angle_rad) / DEGREE_RAD - 0.0566).abs() < 5e-5);
    assert!((peak(&samples, |s| s.gyro_angle_rad) / DEGREE_RAD - 0.244).abs() < 5e-4);
    assert!(events.is_empty());
    let lasting = |torque: f64| torque_step(torque * DYNE_CM_NM).0.last().expect("rows").gimbal_angle_rad / DEGREE_RAD;
    assert!((lasting(2.2e5) - 0.1346).abs() < 5e-5, "{}", lasting(2.2e5));
    assert!((lasting(2.5e5) - 1.099).abs() < 5e-4, "{}", lasting(2.5e5));
    let (samples, events) = torque_step(3e5 * DYNE_CM_NM);
    let last = samples.last().expect("rows").gimbal_angle_rad / DEGREE_RAD;
    assert!((last - 5.609).abs() < 5e-4, "{last}");
    assert!((events[0] - 61.0e-3).abs() < 5e-5, "contact {}", events[0]);
    assert!((events[1] - 422.3e-3).abs() < 5e-5, "release {}", events[1]);
}

#[test]
fn paper_twenty_g_on_the_unbalance_for_five_seconds() {
    let accel = 20.0 * STANDARD_GRAVITY_MPS2;
    let rows = (0..=10_000)
        .map(|index| Row { accel_mps2: [0.0, if index < 5000 { accel } else { 0.0 }, 0.0], ..Row::default() })
        .collect();
    let (samples, _) = run(&Config::consistent().without_friction(), rows);
    let phi = peak(&samples, |s| s.gimbal_angle_rad) / DEGREE_RAD;
    assert!((phi - 0.1110).abs() < 1e-4, "{phi}");
    let velocity = samples.last().expect("rows").velocity_error_mps[0];
    assert!((velocity.abs() - 0.1072).abs() < 2e-4, "{velocity}");
}

#[test]
fn paper_friction_of_four_bearings() {
    let level = |g: f64| {
        let row = Row { accel_mps2: [0.0, g * STANDARD_GRAVITY_MPS2, 0.0], rate_radps: 1.0, ..Row::default() };
        let (samples, _) = run(&Config::consistent().without_unbalance(), vec![row; 3]);
        samples[0].friction_nm / DYNE_CM_NM
    };
    // load and viscous part together; the viscous part alone is 14,582 dyne cm
    assert!((level(1.0) - 14_582.0 - 13_940.0).abs() < 50.0, "{}", level(1.0));
    assert!((level(20.0) - 14_582.0 - 49_500.0).abs() < 100.0, "{}", level(20.0));
}
