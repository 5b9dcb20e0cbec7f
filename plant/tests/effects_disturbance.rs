//! Effects of block `disturbance`, against their equations.

mod rig;

use gimbal_plant::{Row, Sample};
use rig::{GRAVITY_MPS2, assert_close, bare, nominal, on, steady, turning, with};

/// Motor torque with the effect less the nominal one, at a steady rate of 0.3 rad/s.
fn excess_nm(name: &str, values: &[f64]) -> f64 {
    let row = turning(0.3);
    let with = steady(&with(name, values), &row, 50);
    assert!(with.gimbal_angle_rad.abs() < 1e-14, "{with:?}");
    with.motor_torque_nm - steady(&nominal(), &row, 50).motor_torque_nm
}

#[test]
fn closed_form_torques_of_the_inputs_are_carried_by_the_motor() {
    let (x, y) = (3.0 * GRAVITY_MPS2, 4.0 * GRAVITY_MPS2);
    assert_close(excess_nm("mass_unbalance", &[2e-5, 1e-5]), 2e-5 * y - 1e-5 * x, 1e-15);
    assert_close(excess_nm("anisoelasticity", &[1e-7]), 1e-7 * x * y, 1e-15);
    assert_close(excess_nm("constant_torque", &[1e-3]), 1e-3, 1e-15);
    assert_close(excess_nm("cross_axis_coupling", &[1e-3]), 1e-3 * 0.3 * 0.7, 1e-15);
}

#[test]
fn closed_form_the_unbalance_reported_holds_the_change() {
    let row = turning(0.0);
    let change = steady(&with("mass_unbalance", &[2e-5, 1e-5]), &row, 1).unbalance_torque_nm
        - steady(&nominal(), &row, 1).unbalance_torque_nm;
    assert_close(change, 2e-5 * row.accel_y_mps2 - 1e-5 * row.accel_x_mps2, 1e-17);
}

#[test]
fn closed_form_a_spring_wound_up_evenly_is_followed_without_lag() {
    // T_d a ramp: theta constant, phi'' = theta' = 0, so T_m = T_d.
    let row = Row { vehicle_rate_radps: 0.2, ..Row::default() };
    let samples: Vec<Sample> = on(&bare(), "cable_spring", &[1e-3]).run(std::iter::repeat_n(row, 30_000)).collect();
    let last = samples[29_999];
    assert_close(last.relative_angle_rad, 0.2 * last.time_s - last.gimbal_angle_rad, 1e-10);
    assert_close(last.motor_torque_nm, 1e-3 * last.relative_angle_rad, 1e-9);
}

#[test]
fn closed_form_cable_hysteresis_loads_as_a_hyperbolic_tangent_and_unloads_as_a_line() {
    let (torque, displacement) = (6e-4, 0.05);
    let rate = |k: i32| if k < 4000 { 0.02 } else { -0.02 };
    let plant = on(&bare(), "cable_hysteresis", &[torque, displacement]);
    let rows = (0..=6500).map(|k| Row { vehicle_rate_radps: rate(k), ..Row::default() });
    let samples: Vec<Sample> = plant.run(rows).collect();
    for (k, sample) in samples.iter().enumerate() {
        let far = 0.08 / displacement;
        let share = if k < 4000 {
            (sample.relative_angle_rad / displacement).tanh()
        } else {
            far.tanh() - (far - sample.relative_angle_rad / displacement)
        };
        // the motor follows within the loop's transient; nothing else acts
        if !(4000..4300).contains(&k) && k > 300 && share > 0.0 {
            assert_close(sample.motor_torque_nm, torque * share, 4e-3 * torque);
        }
    }
    assert!(samples[6500].relative_angle_rad < 0.031 && samples[6500].motor_torque_nm < 0.0);
}

#[test]
fn closed_form_the_hysteresis_loop_does_not_depend_on_the_rate() {
    // one cycle of +-0.05 rad, in 2 s and in 4 s: the torque at the end is the same
    let at_end = |periods: i32| {
        let plant = on(&bare(), "cable_hysteresis", &[6e-4, 0.02]);
        let turn = std::f64::consts::TAU / (1e-3 * f64::from(periods));
        let rate = |k: i32| 0.05 * turn * (turn * 1e-3 * f64::from(k)).cos();
        // half a second at rest: the loop comes to rest as well
        let rows = (0..=periods + 500)
            .map(|k| Row { vehicle_rate_radps: if k < periods { rate(k) } else { 0.0 }, ..Row::default() });
        plant.run(rows).last().unwrap().motor_torque_nm
    };
    // stopping from 0.08 or 0.16 rad/s within 1 ms moves rel by 1e-4 rad, 5e-3 of x_y
    assert_close(at_end(2000), at_end(4000), 0.01 * 6e-4);
    assert!(at_end(2000).abs() > 1e-5);
}

#[test]
fn closed_form_ripple_at_rest_is_its_phase() {
    let row = Row::default();
    let sample = steady(&on(&bare(), "torque_ripple", &[3e-4, 12.0, 0.5]), &row, 100);
    assert_close(sample.motor_torque_nm, 3e-4 * 0.5_f64.sin(), 1e-15);
}

#[test]
fn closed_form_slow_ripple_is_followed_by_the_motor() {
    // 12 cycles at 0.02 rad/s: 0.24 rad/s, where the closed loop passes T_d to T_m with a gain of 1 within 1e-3
    let row = Row { vehicle_rate_radps: 0.02, ..Row::default() };
    let samples: Vec<Sample> =
        on(&bare(), "torque_ripple", &[3e-4, 12.0, 0.5]).run(std::iter::repeat_n(row, 30_000)).collect();
    for sample in &samples[2000..] {
        let ripple = 3e-4 * (12.0 * sample.relative_angle_rad + 0.5).sin();
        assert_close(sample.motor_torque_nm, ripple, 5e-3 * 3e-4);
    }
}
