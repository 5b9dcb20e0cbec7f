//! Effects of block `servo`, against their equations.

mod rig;

use gimbal_plant::{Plant, Row, Sample};
use gimbal_servo::Config;
use rig::{assert_close, bare, on};

const STEP: Row = Row {
    accel_x_mps2: 0.0,
    accel_y_mps2: 1.0,
    accel_z_mps2: 0.0,
    vehicle_rate_radps: 0.0,
    cross_rate_radps: 0.0,
    spin_rate_radps: 0.0,
    torque_nm: 0.01,
};

fn step_response(plant: &Plant, periods: usize) -> Vec<Sample> {
    plant.run(std::iter::repeat_n(STEP, periods + 1)).collect()
}

/// Integral of phi under the constant torque, once it has come to rest [rad s].
fn angle_integral_rad_s(plant: &Plant) -> f64 {
    step_response(plant, 40_000)[40_000].velocity_error_mps[0]
}

#[test]
fn closed_form_loop_gain_divides_the_integral_of_the_angle() {
    // the integrator of F must reach T_d: integral of phi = T_d Bo / (K (1 + s) H)
    let Config { servo, gyro, .. } = bare();
    let exact =
        STEP.torque_nm * gyro.damping_nm_s_per_rad / (servo.gain_nm_per_rad_s * 1.1 * gyro.angular_momentum_nm_s);
    assert_close(angle_integral_rad_s(&on(&bare(), "loop_gain", &[0.1])), exact, 1e-6 * exact);
}

#[test]
fn closed_form_motor_lag_is_that_of_the_configuration() {
    let mut config = bare();
    config.servo.motor_lag_s *= 1.2;
    assert_eq!(
        step_response(&on(&bare(), "motor_lag", &[0.2]), 300),
        step_response(&Plant::new(&config).unwrap(), 300)
    );
}

#[test]
fn closed_form_in_an_open_loop_the_delayed_torque_is_the_torque_of_before() {
    // A servo of a millionth of its gain does not move the theta that it answers.
    let mut config = bare();
    config.servo.gain_nm_per_rad_s *= 1e-6;
    config.gyro.stop_angle_rad = 100.0;
    let nominal = step_response(&Plant::new(&config).unwrap(), 300);
    let delayed = step_response(&on(&config, "loop_delay", &[3e-3]), 300);
    for k in 0..=300 {
        let exact = if k < 3 { 0.0 } else { nominal[k - 3].motor_torque_nm };
        assert_close(delayed[k].motor_torque_nm, exact, 1e-5 * exact + 1e-18);
    }
    assert!(nominal[297].motor_torque_nm > 1e-9);
}

#[test]
fn closed_form_the_phase_margin_carries_a_delay_of_nine_tenths_of_a_millisecond() {
    // 28 deg at 526 rad/s
    let swing = |delay_s: f64| {
        let samples = step_response(&on(&bare(), "loop_delay", &[delay_s]), 1000);
        samples[900..].iter().fold(0.0_f64, |worst, sample| worst.max(sample.gimbal_rate_radps.abs()))
    };
    assert!(swing(0.85e-3) < swing(0.1e-3) + 0.02, "{}", swing(0.85e-3));
    assert!(swing(1.0e-3) > 0.1, "{}", swing(1.0e-3));
}

#[test]
fn closed_form_halving_the_tolerance_does_not_move_the_delayed_loop() {
    let plant = on(&bare(), "loop_delay", &[0.37e-3]);
    let coarse = step_response(&plant, 300);
    let fine = step_response(&plant.with_tolerance(1e-13), 300);
    let peak = fine.iter().fold(0.0_f64, |peak, sample| peak.max(sample.gimbal_angle_rad));
    for (a, b) in coarse.iter().zip(&fine) {
        assert_close(a.gimbal_angle_rad, b.gimbal_angle_rad, 1e-9 * peak);
    }
}

#[test]
fn closed_form_a_saturated_motor_gives_its_limit_and_the_gimbal_the_rest() {
    let nominal = step_response(&Plant::new(&bare()).unwrap(), 400);
    let saturated = step_response(&on(&bare(), "torque_saturation", &[8e-3]), 400);
    for (a, b) in nominal.iter().zip(&saturated) {
        assert!(b.motor_torque_nm <= 8e-3);
        if a.motor_torque_nm >= 8e-3 {
            break;
        }
        assert_close(b.motor_torque_nm, a.motor_torque_nm, 1e-12);
    }
    // 8e-3 of 1e-2 N m: the rest is H theta', until theta is on its stop and the gimbal is accelerated by it
    let (before, last) = (saturated[399], saturated[400]);
    assert_close(last.motor_torque_nm, 8e-3, 0.0);
    assert!(last.stop.sign() > 0.0);
    let acceleration = (last.gimbal_rate_radps - before.gimbal_rate_radps) / 1e-3;
    assert_close(acceleration, 2e-3 / bare().servo.gimbal_inertia_kg_m2, 1e-9);
}

#[test]
fn closed_form_a_dead_zone_is_silent_below_its_width_and_carried_by_the_integrator() {
    let width = 1e-3;
    let plant = on(&bare(), "dead_zone", &[width]);
    let nominal = step_response(&Plant::new(&bare()).unwrap(), 5000);
    let dead = step_response(&plant, 5000);
    for (a, b) in nominal.iter().zip(&dead) {
        if a.motor_torque_nm > width {
            break;
        }
        assert_close(b.motor_torque_nm, 0.0, 0.0);
    }
    assert_close(dead[5000].motor_torque_nm, STEP.torque_nm, 1e-3 * STEP.torque_nm);
    let still = rig::steady(&plant, &STEP, 100);
    assert_close(still.motor_torque_nm, STEP.torque_nm, 1e-15);
    assert_close(still.gimbal_angle_rad, 0.0, 1e-15);
    // integral of phi: the integrator reaches T_d + width
    let ratio = angle_integral_rad_s(&plant) / angle_integral_rad_s(&Plant::new(&bare()).unwrap());
    assert_close(ratio, 1.1, 1e-5);
}

#[test]
fn closed_form_a_quantised_pickoff_logs_whole_steps_and_is_blind_below_half_a_step() {
    let step = 2e-5;
    let samples = step_response(&on(&bare(), "pickoff_quantisation", &[step]), 1000);
    let mut blind = 0;
    for sample in &samples {
        let steps = sample.logged.gyro_angle_rad / step;
        assert_close(steps, steps.round(), 1e-9);
        assert!((sample.logged.gyro_angle_rad - sample.gyro_angle_rad).abs() <= 0.500_001 * step);
        if blind + 1 == samples.iter().position(|later| later == sample).unwrap() + 1
            && sample.gyro_angle_rad.abs() < 0.5 * step
        {
            assert_close(sample.motor_torque_nm, 0.0, 0.0);
            blind += 1;
        }
    }
    assert!(blind >= 2, "{blind}");
    // the loop still holds the torque, on average over its limit cycle
    let mean = samples[800..].iter().map(|sample| sample.motor_torque_nm).sum::<f64>() / 201.0;
    assert_close(mean, STEP.torque_nm, 0.05 * STEP.torque_nm);
}
