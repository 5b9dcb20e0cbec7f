//! The gap monitor: quiet while the model is right, quick when it is not.

use gimbal_servo::monitor::Recorder;
use gimbal_servo::{Config, Fixed, Input, Number, estimator, monitor};
use host_tests::estimate_figures::{Acting, EFFECTS, watch, watch_plant};
use host_tests::random::Random;

#[test]
fn cross_no_alarm_while_the_model_is_right() {
    let (law, plant) = (watch(20, 0.0, 0.0, 1), watch_plant(3, 2));
    assert_eq!((law.alarms, plant.alarms), (0, 0));
}

#[test]
fn cross_effects_of_five_times_the_noise_are_flagged_within_five_seconds() {
    for name in EFFECTS {
        let acting = Acting::new(name);
        let seen = acting.seen(&acting.grown(1e-5), 0.0);
        assert!(seen.after_s.is_some_and(|after| (0.0..5.0).contains(&after)), "{name}: {seen:?}");
    }
}

#[test]
fn closed_form_the_ring_keeps_the_rows_before_the_alarm() {
    let law = Config::consistent().build::<f32>().unwrap();
    let mut state = law.start();
    let mut ring = Recorder::<f32, 4>::new(2);
    for row in 0..20 {
        let input = Input { accel_x_mps2: row as f32, ..Input::default() };
        let output = law.step(&mut state, input);
        ring.record(Some(0.0), &input, &output, row >= 15);
    }
    let rows: Vec<u32> = ring.rows().map(|record| record.row).collect();
    assert_eq!(rows, [8, 10, 12, 14]);
    assert!(ring.is_stopped());
}

/// theta comes near its stop, hundreds of times the residual's noise, and the residual is still measured less modelled.
#[test]
fn closed_form_the_residual_is_the_difference_wherever_theta_is() {
    largest_theta_with_its_residual::<f32>();
    largest_theta_with_its_residual::<Fixed>();
}

fn largest_theta_with_its_residual<N: Number>() {
    let config = Config::consistent();
    let axis = config.build::<N>().unwrap();
    let readings = estimator::Config::default().build::<N>(&config).unwrap();
    let test = monitor::Config::default().build::<N>(&config, readings.gyro_exponent()).unwrap();
    let (mut model, mut state, mut largest) = (axis.start(), test.start(), 0.0_f64);
    for row in 0..400 {
        let torque_nm = if row < 30 { 0.03 } else { -0.01 };
        let output = axis.step(&mut model, axis.units().input(&Input { torque_nm, ..Input::default() }));
        let modelled = axis.units().output(&output).gyro_angle_rad;
        largest = largest.max(modelled.abs());
        for difference in [5e-5, -2e-4] {
            let measured = readings.measured(Some(modelled + difference), None).gyro_angle_rad;
            let residual = test.step(&mut state, measured, &model).residual_rad.to_f64(test.residual_exponent());
            assert!((residual - difference).abs() < 1e-8, "row {row}: {residual} for {difference}, theta {modelled}");
        }
    }
    assert!(largest > 4e-3, "theta goes to {largest} rad alone");
}

/// Ten seconds of swings, the pick-off's noise on theta: quiet in both number systems. With theta off by its 200th part
/// both raise the alarm, within a block of each other, and on the way there with the same score to 1.5 % of its threshold.
#[test]
fn cross_both_number_systems_score_alike() {
    let (single, fixed) = (scores::<f32>(1.0), scores::<Fixed>(1.0));
    assert!(single.iter().chain(&fixed).all(|(_, disagrees)| !disagrees));
    let (single, fixed) = (scores::<f32>(1.005), scores::<Fixed>(1.005));
    for (row, (one, other)) in single.iter().zip(&fixed).enumerate() {
        assert!((one.0 - other.0).abs() < 0.05, "row {row}: {one:?} and {other:?}");
    }
    let alarm = |scores: &[(f64, bool)]| scores.iter().position(|(_, disagrees)| *disagrees);
    let (Some(one), Some(other)) = (alarm(&single), alarm(&fixed)) else { panic!("no alarm") };
    assert!(one.abs_diff(other) <= 32, "rows {one} and {other}");
    assert!(single[..one].iter().any(|(score, _)| *score > 0.1));
}

/// Score and alarm at each row, theta as measured `factor` times the model's, with noise.
fn scores<N: Number>(factor: f64) -> Vec<(f64, bool)> {
    let config = Config::consistent();
    let axis = config.build::<N>().unwrap();
    let readings = estimator::Config::default().build::<N>(&config).unwrap();
    let test = monitor::Config::default().build::<N>(&config, readings.gyro_exponent()).unwrap();
    let (mut model, mut state, mut random) = (axis.start(), test.start(), Random::new(7));
    let row = |k: u32| {
        let time = f64::from(k) * 1e-3;
        let input = Input {
            accel_y_mps2: 20.0 * (2.5 * time).sin(),
            accel_z_mps2: 9.8,
            vehicle_rate_radps: 0.1 * (1.1 * time).cos(),
            ..Input::default()
        };
        let output = axis.units().output(&axis.step(&mut model, axis.units().input(&input)));
        let measured = readings.measured(Some(factor * output.gyro_angle_rad + 2e-6 * random.normal()), None);
        let report = test.step(&mut state, measured.gyro_angle_rad, &model);
        (report.score.to_f64(10), report.disagrees)
    };
    (0..10_000).map(row).collect()
}
