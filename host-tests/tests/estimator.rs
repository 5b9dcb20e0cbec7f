//! The estimator against the plant, with the noise of the sensors on every channel.

use gimbal_servo::estimator::{self, Flags};
use gimbal_servo::{BuildError, Config, Fixed};
use host_tests::Row;
use host_tests::axis::System;
use host_tests::estimate::{Flight, Noise, estimate};
use host_tests::estimate_faults::faults;
use host_tests::estimate_figures::{self, Saturations, Wrong, cases, free_score, saturations, wrong_score};
use host_tests::inputs;

/// The static ratio leaves 2 to 4 %.
#[test]
fn cross_attitude_within_one_percent_and_velocity_within_two_without_saturation() {
    for case in cases(1) {
        for system in System::BOTH {
            let (score, saturates) = free_score(&case, system);
            if !saturates {
                assert!(score.attitude <= 0.01, "{} {}: {}", case.name, system.name(), score.attitude);
                assert!(score.velocity <= 0.02, "{} {}: {}", case.name, system.name(), score.velocity);
                assert!(score.attitude < 0.5 * score.static_ratio, "{}", case.name);
            }
        }
    }
}

#[test]
fn cross_wrong_parameters_cost_their_ratio_and_two_percent() {
    let case = &cases(1)[2];
    for seed in 0..5 {
        let Some(Wrong { score, ratio, saturates: false, .. }) = wrong_score(case, seed) else { continue };
        assert!(score.attitude <= ratio + 0.02, "seed {seed}: {} beside {ratio}", score.attitude);
        assert!(score.velocity <= ratio + 0.02, "seed {seed}: {} beside {ratio}", score.velocity);
    }
}

#[test]
fn cross_offset_after_saturation_within_five_percent_with_exact_parameters() {
    for system in System::BOTH {
        let found = saturations(40, 0.0, system, 5);
        let largest = Saturations::quantile(&found.errors, 1000);
        assert!(largest <= 0.05, "{}: {largest}", system.name());
    }
}

/// 95 % of 200 runs, three standard deviations of the count: 90.4 % at least.
#[test]
fn cross_offset_bound_covers_with_wrong_parameters() {
    let found = saturations(200, 0.03, System::F32, 11);
    assert!(found.coverage() >= 0.904, "{}", found.coverage());
    let median = Saturations::quantile(&found.bounds, 500);
    assert!(median <= 0.15, "{median}");
}

#[test]
fn cross_states_follow_the_float() {
    let (nominal, config) = (inputs::bare(Config::consistent()), estimator::Config::default());
    // Contact at 161 ms, release at 522 ms.
    let mut rows = inputs::torque_step(3e5, 1.0, 1e-3);
    rows[..100].fill(Row::default());
    let flight = Flight::new(&nominal, &config.sensors, &Noise::default(), &rows, 1);
    for system in System::BOTH {
        let points = estimate(system, &nominal, &config, &flight.readings).points;
        let set = |time: usize, flag| points[time].flags.contains(flag);
        assert!(set(155, Flags::SATURATION_AHEAD) && !set(155, Flags::SATURATED));
        assert!(set(170, Flags::SATURATED) && set(510, Flags::SATURATED) && set(530, Flags::OFFSET_HELD));
        assert!(!set(540, Flags::SATURATED) && !set(450, Flags::OFFSET_HELD));
        for point in &points {
            assert_eq!(point.flags.contains(Flags::BOUND_TOO_WIDE), point.bound_rad > config.widest_bound_rad);
        }
    }
}

#[test]
fn cross_faults_move_nothing_beyond_the_bound_without_a_flag() {
    let found = faults(600, 3);
    assert_eq!(found.unflagged, 0, "{:?}", found.which);
}

#[test]
fn closed_form_no_reading_at_all_is_flagged_and_lost() {
    let axis = Config::consistent();
    let law = estimator::Config::default().build::<Fixed>(&axis).unwrap();
    let model = axis.build::<Fixed>().unwrap();
    let (mut state, mut model_state) = (law.start(), model.start());
    for k in 0..200 {
        let output = model.step(&mut model_state, gimbal_servo::Input::default());
        let estimate = law.step(&mut state, &law.measured(None, None), &model, &model_state, output.faults);
        assert!(estimate.flags.contains(Flags::GYRO_MISSING));
        assert_eq!(estimate.flags.contains(Flags::GYRO_LOST), k >= 50, "row {k}");
    }
}

#[test]
fn closed_form_a_wrong_field_is_named() {
    let mut config = estimator::Config::default();
    config.sensors.gyro_noise_rad = f64::NAN;
    let error = config.build::<f32>(&Config::consistent()).unwrap_err();
    assert!(matches!(error, BuildError::OutOfRange { field: "sensors.gyro_noise_rad", .. }));
}

/// Readings that are two periods old: the filter's own prediction makes up for it.
#[test]
fn cross_a_delay_of_the_readings_is_made_good() {
    let case = &cases(1)[1];
    let (late, mut known) = (2, estimate_figures::exact());
    let flight = case.flight(&known);
    let mut delayed = flight.clone();
    for k in (late..delayed.readings.len()).rev() {
        delayed.readings[k].gyro_angle_rad = flight.readings[k - late].gyro_angle_rad;
        delayed.readings[k].motor_torque_nm = flight.readings[k - late].motor_torque_nm;
    }
    let untold = case.score_of(&known, &delayed).attitude;
    known.sensors.delay_s = 2e-3;
    let told = case.score_of(&known, &delayed).attitude;
    assert!(told < 0.02 && told < 0.7 * untold, "{told} told of the delay, {untold} untold");
}
