//! Effects of block `friction`, against their equations.

mod rig;

use gimbal_plant::Sample;
use gimbal_servo::Config;
use rig::{GRAVITY_MPS2, assert_close, nominal, steady, turning, with};

/// `T_load` and `T_visc` under [`turning`] at a slow rate [N m].
fn palmgren_nm() -> (f64, f64) {
    let bearing = Config::consistent().bearing;
    let level = bearing.friction_level_nm(5.0 * GRAVITY_MPS2, GRAVITY_MPS2, 0.3);
    let viscous = 4.0 * bearing.viscous_torque_nm(0.3);
    (level - viscous, viscous)
}

/// Motor torque with the effect less the nominal one, at a steady rate.
fn excess_nm(name: &str, values: &[f64], rate_radps: f64) -> f64 {
    let row = turning(rate_radps);
    let with = steady(&with(name, values), &row, 50);
    assert!(with.gimbal_angle_rad.abs() < 1e-14, "{with:?}");
    with.motor_torque_nm - steady(&nominal(), &row, 50).motor_torque_nm
}

#[test]
fn closed_form_friction_level_adds_a_share_of_the_load_torque() {
    let (load, _) = palmgren_nm();
    assert_close(excess_nm("friction_level", &[0.3], 0.3), 0.3 * load, 1e-15);
    assert_close(excess_nm("friction_level", &[-0.5], -0.3), 0.5 * load, 1e-15);
}

#[test]
fn closed_form_load_dependence_grows_with_the_radial_acceleration() {
    let (load, _) = palmgren_nm();
    assert_close(excess_nm("load_dependence", &[0.01], 0.3), 0.01 * 5.0 * load, 1e-15);
}

#[test]
fn closed_form_direction_asymmetry_has_the_sign_of_the_rate() {
    let (load, viscous) = palmgren_nm();
    for rate in [0.3, -0.3] {
        assert_close(excess_nm("direction_asymmetry", &[0.1], rate), 0.1 * (load + viscous), 1e-15);
    }
}

#[test]
fn closed_form_friction_drifts_exponentially() {
    let (load, viscous) = palmgren_nm();
    let row = turning(0.3);
    let plant = with("friction_drift", &[0.3, 0.2]);
    for sample in plant.run_from(plant.settled(&row), std::iter::repeat_n(row, 500)) {
        let factor = 1.0 + 0.3 * (1.0 - (-sample.time_s / 0.2).exp());
        assert_close(sample.friction_torque_nm, (load + viscous) * factor, 1e-15);
    }
}

#[test]
fn closed_form_viscous_friction_and_quadratic_drag_follow_the_rate() {
    for rate in [0.3, -0.7] {
        assert_close(excess_nm("viscous_friction", &[1e-3], rate), 1e-3 * rate, 1e-15);
        assert_close(excess_nm("quadratic_drag", &[1e-3], rate), 1e-3 * rate * f64::abs(rate), 1e-15);
    }
}

#[test]
fn closed_form_stribeck_is_a_bell_of_the_rate() {
    for rate in [0.03, 0.1, -0.05] {
        let bell = 6e-4 * (-f64::powi(rate / 0.05, 2)).exp() * f64::signum(rate);
        assert_close(excess_nm("stribeck", &[6e-4, 0.05], rate), bell, 1e-15);
    }
}

#[test]
fn closed_form_presliding_friction_builds_up_from_every_reversal() {
    let displacement = 2e-3;
    let plant = with("presliding", &[displacement]);
    let rows = (0..=3000).map(|k| turning(0.05 * (5e-3 * f64::from(k)).cos()));
    let samples: Vec<Sample> = plant.run(rows).collect();
    let (load, viscous) = palmgren_nm();
    let ratio = |sample: &Sample| sample.friction_torque_nm / (load + viscous);
    // from rest at rel = 0, then from the ratio and the angle of each reversal
    let mut reversal = (0.0, 0.0, 1.0);
    let mut reversals = 0;
    for (before, after) in samples.iter().zip(&samples[1..]) {
        let forward = f64::signum(after.relative_angle_rad - before.relative_angle_rad);
        if forward * reversal.2 < 0.0 {
            let at = if reversal.2 > 0.0 { f64::max } else { f64::min };
            let furthest = at(before.relative_angle_rad, after.relative_angle_rad);
            let built = reversal.2 + (reversal.0 - reversal.2) * (-(furthest - reversal.1).abs() / displacement).exp();
            reversal = (built, furthest, forward);
            reversals += 1;
        }
        let (start, angle, sign) = reversal;
        let dahl = sign + (start - sign) * (-(after.relative_angle_rad - angle).abs() / displacement).exp();
        // the reversal itself lies between two rows, at most 1e-7 rad further
        assert_close(ratio(after), dahl, 2e-4);
    }
    assert!(reversals >= 4);
}
