//! The gap monitor: quiet while the model is right, quick when it is not.

use gimbal_servo::monitor::Recorder;
use gimbal_servo::{Config, Input};
use host_tests::estimate_figures::{Acting, EFFECTS, watch, watch_plant};

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
