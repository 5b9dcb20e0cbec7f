//! Effects of blocks `gyro` and `structure`, against their equations.

mod rig;

use gimbal_plant::{Plant, Row, Sample, Stop, StopEventKind};
use gimbal_servo::Config;
use rig::{assert_close, bare, on, turning, with};

fn step(torque_nm: f64) -> Row {
    Row { torque_nm, accel_y_mps2: 1.0, ..Row::default() }
}

fn run(plant: &Plant, row: Row, periods: usize) -> Vec<Sample> {
    plant.run(std::iter::repeat_n(row, periods + 1)).collect()
}

/// Integral of phi under 0.01 N m, over `T_d Bo / (K H)` of the nominal plant.
fn relative_integral(name: &str, value: f64) -> f64 {
    let Config { servo, gyro, .. } = bare();
    let nominal = 0.01 * gyro.damping_nm_s_per_rad / (servo.gain_nm_per_rad_s * gyro.angular_momentum_nm_s);
    run(&on(&bare(), name, &[value]), step(0.01), 40_000)[40_000].velocity_error_mps[0] / nominal
}

#[test]
fn closed_form_damping_and_momentum_set_the_integral_of_the_angle() {
    assert_close(relative_integral("gyro_damping", 0.1), 1.1, 1e-5);
    assert_close(relative_integral("angular_momentum", 0.05), 1.0 / 1.05, 1e-5);
}

#[test]
fn closed_form_theta_stops_at_the_changed_angle() {
    for change in [0.1, -0.5] {
        let samples = run(&on(&bare(), "stop_angle", &[change]), step(0.03), 300);
        let peak = samples.iter().fold(0.0_f64, |peak, sample| peak.max(sample.gyro_angle_rad));
        assert_close(peak, bare().gyro.stop_angle_rad * (1.0 + change), 1e-17);
    }
}

#[test]
fn closed_form_a_torque_on_the_float_turns_the_platform() {
    // theta held still by the loop: phi' = -(M + c a_x) / H
    let momentum = bare().gyro.angular_momentum_nm_s;
    let row = turning(0.3);
    // the integral has the drift from the first instant: Jo theta' + Bo theta = H phi + integral of the torque
    let drift = |name: &str, value: f64| {
        let plant = with(name, &[value]);
        let samples: Vec<Sample> = plant.run(std::iter::repeat_n(row, 30_001)).collect();
        (samples[30_000].gimbal_angle_rad - samples[29_000].gimbal_angle_rad) / 1.0
    };
    assert_close(drift("float_torque", 2e-6), -2e-6 / momentum, 1e-9);
    assert_close(drift("g_sensitive_float_torque", 1e-7), -1e-7 * row.accel_x_mps2 / momentum, 1e-9);
    let settled = rig::steady(&with("float_torque", &[2e-6]), &row, 100);
    assert_close(settled.gimbal_angle_rad, -2e-6 / momentum * 0.1, 1e-14);
}

#[test]
fn closed_form_a_torque_on_the_float_decides_the_release() {
    // on the positive stop the float is held by H phi' + M: it leaves at phi' = -M / H
    let torque = 2e-4;
    let plant = on(&bare(), "float_torque", &[torque]);
    let mut state = plant.start();
    let samples: Vec<_> = (0..1000).map(|_| plant.step(&mut state, &step(0.03), &step(0.03))).collect();
    let [contact, release, ..] = state.events() else { panic!("{:?}", state.events()) };
    assert_eq!((contact.kind, release.kind), (StopEventKind::Contact, StopEventKind::Release));
    let leave = -torque / bare().gyro.angular_momentum_nm_s;
    let before = samples.iter().rfind(|sample| sample.time_s <= release.time_s).unwrap();
    let after = samples.iter().find(|sample| sample.time_s > release.time_s).unwrap();
    assert_eq!((before.stop, after.stop), (Stop::Positive, Stop::Free));
    assert!(before.gimbal_rate_radps >= leave && after.gimbal_rate_radps <= leave, "{before:?} {after:?}");
}

#[test]
fn closed_form_parameters_that_change_are_those_of_the_configuration() {
    let same = |name: &str, value: f64, change: fn(&mut Config, f64)| {
        let mut config = bare();
        change(&mut config, 1.0 + value);
        let expected = run(&Plant::new(&config).unwrap(), step(0.03), 300);
        assert_eq!(run(&on(&bare(), name, &[value]), step(0.03), 300), expected, "{name}");
    };
    same("gyro_damping", 0.1, |config, factor| config.gyro.damping_nm_s_per_rad *= factor);
    same("angular_momentum", -0.1, |config, factor| config.gyro.angular_momentum_nm_s *= factor);
    same("stop_angle", 0.1, |config, factor| config.gyro.stop_angle_rad *= factor);
    same("gimbal_inertia", 0.1, |config, factor| config.servo.gimbal_inertia_kg_m2 *= factor);
    same("loop_gain", 0.1, |config, factor| config.servo.gain_nm_per_rad_s *= factor);
}

/// Neither gyro nor servo: the gimbal answers torque alone.
fn adrift() -> Config {
    let mut config = bare();
    config.gyro.angular_momentum_nm_s = 1e-14;
    config.servo.gain_nm_per_rad_s = 1e-14;
    config
}

#[test]
fn closed_form_inertia_divides_the_acceleration() {
    let last = run(&on(&adrift(), "gimbal_inertia", &[0.1]), step(1e-3), 100)[100];
    assert_close(last.gimbal_rate_radps, 1e-3 * 0.1 / (1.1 * adrift().servo.gimbal_inertia_kg_m2), 1e-12);
}

#[test]
fn closed_form_an_appendage_rings_about_the_motion_of_the_whole() {
    // undamped: phi' = T / Jg (t + r / (1 - r) sin(W t) / W), W = 2 pi f / sqrt(1 - r); the mean keeps Jg
    let (ratio, frequency_hz) = (0.1, 40.0);
    let ringing = std::f64::consts::TAU * frequency_hz / f64::sqrt(1.0 - ratio);
    let torque = 1e-3;
    for sample in run(&on(&adrift(), "flexible_mode", &[ratio, frequency_hz, 0.0]), step(torque), 500) {
        let swing = ratio / (1.0 - ratio) * (ringing * sample.time_s).sin() / ringing;
        let exact = torque / adrift().servo.gimbal_inertia_kg_m2 * (sample.time_s + swing);
        assert_close(sample.gimbal_rate_radps, exact, 1e-10);
    }
}

#[test]
fn closed_form_the_appendage_loses_its_swing_by_its_damping() {
    // the ringing decays with d W0^2 / W0 / (1 - r) = d 2 pi f / (1 - r)
    let (ratio, frequency_hz, damping) = (0.1, 40.0, 0.02);
    let decay = damping * std::f64::consts::TAU * frequency_hz / (1.0 - ratio);
    let samples = run(&on(&adrift(), "flexible_mode", &[ratio, frequency_hz, damping]), step(1e-3), 400);
    let slope = 1e-3 / adrift().servo.gimbal_inertia_kg_m2;
    let swing = |from: usize| {
        let of = |sample: &Sample| (sample.gimbal_rate_radps - slope * sample.time_s).abs();
        samples[from..from + 50].iter().map(of).fold(0.0, f64::max)
    };
    assert_close((swing(0) / swing(200)).ln() / 0.2, decay, 0.05 * decay);
}
