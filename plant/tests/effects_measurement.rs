//! Effects of block `measurement`: the log changes, the loop does not.

mod rig;

use gimbal_plant::{Row, Sample};
use rig::{assert_close, flight, nominal, with};

fn run(name: &str, value: f64) -> Vec<Sample> {
    with(name, &[value]).run(flight().into_iter().take(1501)).collect()
}

fn plain() -> Vec<Sample> {
    nominal().run(flight().into_iter().take(1501)).collect()
}

/// The loop has not noticed the sensors.
fn assert_same_truth(a: &Sample, b: &Sample) {
    assert_eq!(Sample { logged: b.logged, ..*a }, *b);
}

#[test]
fn closed_form_scale_and_bias_change_one_column() {
    type Change = fn(f64) -> f64;
    let cases: [(&str, f64, Change, Change); 4] = [
        ("pickoff_scale", 0.02, |theta| 1.02 * theta, |torque| torque),
        ("pickoff_bias", 1e-4, |theta| theta + 1e-4, |torque| torque),
        ("torque_scale", -0.02, |theta| theta, |torque| 0.98 * torque),
        ("torque_bias", 2e-4, |theta| theta, |torque| torque + 2e-4),
    ];
    let plain = plain();
    for (name, value, theta, torque) in cases {
        for (sample, nominal) in run(name, value).iter().zip(&plain) {
            assert_same_truth(sample, nominal);
            assert_close(sample.logged.gyro_angle_rad, theta(nominal.gyro_angle_rad), 1e-17);
            assert_close(sample.logged.motor_torque_nm, torque(nominal.motor_torque_nm), 1e-17);
            assert_eq!(sample.logged.inputs, nominal.logged.inputs);
        }
    }
}

#[test]
fn closed_form_late_inputs_are_those_of_earlier_rows() {
    let rows = flight();
    // two and a half periods
    let samples = run("time_skew", 2.5e-3);
    for (sample, nominal) in samples.iter().zip(&plain()) {
        assert_same_truth(sample, nominal);
    }
    for k in 3..samples.len() {
        let exact = rows[k - 2].toward(&rows[k - 3], 0.5);
        let logged = samples[k].logged.inputs;
        assert_close(logged.accel_x_mps2, exact.accel_x_mps2, 1e-9);
        assert_close(logged.accel_y_mps2, exact.accel_y_mps2, 1e-9);
        assert_close(logged.accel_z_mps2, exact.accel_z_mps2, 1e-9);
        assert_close(logged.vehicle_rate_radps, exact.vehicle_rate_radps, 1e-12);
        assert_close(logged.cross_rate_radps, exact.cross_rate_radps, 1e-12);
        assert_close(logged.torque_nm, rows[k].torque_nm, 0.0);
        assert_close(samples[k].logged.gyro_angle_rad, samples[k].gyro_angle_rad, 0.0);
    }
    let first: Row = samples[1].logged.inputs;
    assert_close(first.accel_y_mps2, rows[0].accel_y_mps2, 0.0);
}

#[test]
fn closed_form_early_inputs_are_a_late_theta_and_torque() {
    let plain = plain();
    let samples = run("time_skew", -3e-3);
    for k in 3..samples.len() {
        assert_same_truth(&samples[k], &plain[k]);
        assert_close(samples[k].logged.gyro_angle_rad, plain[k - 3].gyro_angle_rad, 1e-13);
        assert_close(samples[k].logged.motor_torque_nm, plain[k - 3].motor_torque_nm, 1e-13);
        assert_eq!(samples[k].logged.inputs, plain[k].logged.inputs);
    }
    assert_close(samples[1].logged.gyro_angle_rad, 0.0, 0.0);
}
