//! Files that are wrong in one way: the message names the place and what would be right, on one line.

use gimbal_model_file::{ModelFile, Preset};
use gimbal_servo::{BuildError, Config};

fn told(text: &str) -> String {
    let message = ModelFile::parse(text, "m.toml").expect_err("a wrong file").to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

#[test]
fn contract_an_empty_file_is_the_consistent_preset() {
    let model = ModelFile::parse("", "m.toml").expect("reads");
    assert_eq!((model.preset, model.config), (Preset::Consistent, Config::consistent()));
}

#[test]
fn contract_overrides_stand_on_the_preset() {
    let text = "preset = \"as-printed\"\n[bearing]\ncount = 0\nviscous_law = \"metric\"\n[gyro]\nstop_angle_rad = 1\n\
                [servo]\nlag_time_constants_s = [1, 0.1, 0.01, 1e-3]\n[range]\ntorque_nm = 0.1\n\
                [tolerance]\nloop_gain = 0.1\ndefault_relative = 0.02\n";
    let model = ModelFile::parse(text, "m.toml").expect("reads");
    let mut expected = Config::as_printed();
    expected.bearing.count = 0;
    expected.bearing.viscous_law = gimbal_servo::bearing::ViscousLaw::Metric;
    expected.gyro.stop_angle_rad = 1.0;
    expected.servo.lag_time_constants_s = [1.0, 0.1, 0.01, 1e-3];
    expected.range.torque_nm = 0.1;
    assert_eq!(model.config, expected);
    let known = ["loop_gain", "motor_lag", "friction_level"].map(|effect| (100.0 * model.tolerance.of(effect)).round());
    assert_eq!(known.map(|percent| percent.to_string()), ["10", "2", "15"]);
}

#[test]
fn contract_an_unknown_key_is_told_with_the_nearest() {
    assert_eq!(
        told("[gyro]\n  stop_angle_deg = 0.5\n"),
        "m.toml: line 2, column 3: `stop_angle_deg` is not a key of [gyro]; the nearest known one is `stop_angle_rad`"
    );
    assert!(told("[tolerance]\nloop_gian = 0.1\n").contains("the nearest known one is `loop_gain`"));
}

#[test]
fn contract_an_unknown_table_is_told_with_the_nearest() {
    let message = told("[bearings]\ncount = 4\n");
    let expected =
        "m.toml: line 1, column 2: [bearings] is not a table of a model file; the nearest known one is [bearing]";
    assert_eq!(message, expected);
}

#[test]
fn contract_the_model_of_a_plain_axis_is_told_as_such() {
    let message = told("[axis]\nmotion = \"linear\"\n");
    assert!(message.starts_with("m.toml: line 1, column 2: [axis] makes this the model of a plain axis"), "{message}");
}

#[test]
fn contract_a_key_outside_of_its_table_is_told_with_its_home() {
    let message = told("motor_lag_s = 0.001\n");
    let expected = "m.toml: line 1, column 1: `motor_lag_s` stands outside of every table; write it below [servo]";
    assert_eq!(message, expected);
    assert!(told("presett = \"consistent\"\n").contains("the nearest known key is `preset`"));
}

#[test]
fn contract_a_wrong_type_is_told() {
    assert_eq!(
        told("[servo]\nmotor_lag_s = \"1 ms\"\n"),
        "m.toml: line 2, column 15: `servo.motor_lag_s` is the text \"1 ms\"; write a finite number such as 0.001"
    );
    assert!(told("[servo]\nmotor_lag_s = inf\n").contains("is the number inf; write a finite number"));
    assert!(told("[bearing]\ncount = 4.5\n").contains("is the number 4.5; write an integer such as 4"));
    assert!(told("[bearing]\ncount = -1\n").starts_with("m.toml: line 2, column 9: `bearing.count`"));
    assert!(told("[gyro]\ncross_coupling = 1\n").contains("write true or false"));
}

#[test]
fn contract_a_wrong_array_is_told() {
    assert_eq!(
        told("[servo]\nlead_time_constants_s = [1.0, 2.0]\n"),
        "m.toml: line 2, column 25: `servo.lead_time_constants_s` is an array of 2; write an array of 5 finite numbers"
    );
    assert!(told("[servo]\nlag_time_constants_s = [1, 2, 3, \"x\"]\n").contains("an array with the text \"x\""));
}

#[test]
fn contract_an_impossible_value_is_told_where_it_stands() {
    assert_eq!(
        told("[servo]\n\ngimbal_inertia_kg_m2 = -1\n"),
        "m.toml: line 3, column 24: `servo.gimbal_inertia_kg_m2` is -1; it must be positive and finite"
    );
    assert!(told("[tolerance]\nstop_angle = 3\n").contains("line 2, column 14: `tolerance.stop_angle` is 3"));
    let message = told("[bearing]\nviscous_law = \"dry\"\n");
    assert!(
        message.starts_with("m.toml: line 2, column 15: `bearing.viscous_law`: unknown variant `dry`"),
        "{message}"
    );
}

#[test]
fn contract_what_the_law_refuses_is_told_where_it_stands() {
    let model = ModelFile::parse("[servo]\ngain_nm_per_rad_s = 80.0\n", "m.toml").expect("reads");
    let error = BuildError::UnstablePole { real_radps: 3.0, imag_radps: 500.0 };
    let message = model.locate(&error).to_string();
    assert!(message.starts_with("m.toml: line 2, column 21: the loop is unstable"), "{message}");
    assert!(message.ends_with("with `servo.gain_nm_per_rad_s` of the preset consistent it is stable"), "{message}");
    // Not the gain: too much lead, beside a key that has no part in it.
    let text = "[servo]\nmotor_lag_s = 0.0009\nlead_time_constants_s = [2.16, 0.0385, 0.0156, 0.0127, 1.68]\n";
    let message = ModelFile::parse(text, "m.toml").expect("reads").locate(&error).to_string();
    assert!(message.starts_with("m.toml: line 3, column 25: the loop is unstable"), "{message}");
    assert!(message.contains("with `servo.lead_time_constants_s` of the preset"), "{message}");
}

#[test]
fn contract_a_wrong_preset_and_broken_toml_are_told() {
    let message = told("preset = \"printed\"\n");
    let expected = "m.toml: line 1, column 10: `printed` is not a preset; write \"consistent\" or \"as-printed\"";
    assert_eq!(message, expected);
    assert!(told("[servo\nx = 1\n").starts_with("m.toml: line 1, column"));
    assert!(told("[servo]\nmotor_lag_s = 1\nmotor_lag_s = 2\n").starts_with("m.toml: line 3, column 1: not TOML: "));
}

#[test]
fn contract_wrong_effects_are_told_with_what_would_be_right() {
    assert_eq!(
        told("[effects]\ncable_sping = { stiffness_nm_per_rad = 1e-3 }\n"),
        "m.toml: line 2, column 1: `cable_sping` is not a key of [effects]; the nearest known one is `cable_spring`"
    );
    let message = told("[effects.stribeck]\nexcess_nm = 1e-3\n");
    assert!(message.contains("`effects.stribeck` lacks `rate_radps`; it takes `excess_nm`, `rate_radps`"), "{message}");
    let message = told("[effects.stribeck]\nexcess = 1e-3\nrate_radps = 1\n");
    assert!(message.starts_with("m.toml: line 2, column 1: `excess` is not a key of [effects.stribeck]"), "{message}");
    let message = told("[effects]\nloop_delay = 1e-3\n");
    assert!(message.contains("write a table with `delay_s`"), "{message}");
    let message = told("[effects.loop_delay]\ndelay_s = -1e-3\n");
    assert!(message.contains("`effects.loop_delay.delay_s` is -0.001; it must be zero or positive"), "{message}");
}

#[test]
fn contract_wrong_known_parts_are_told_with_what_would_be_right() {
    let message = told("[known_good]\nparts = [\"torque_senser\"]\n");
    assert!(message.starts_with("m.toml: line 2, column 10: `torque_senser` is not a part"), "{message}");
    assert!(message.contains("the nearest known one is `torque_sensor`; parts: torque_sensor, pickoff"), "{message}");
    assert!(told("[known_good]\npart = []\n").contains("the nearest known one is `parts`"));
    assert!(told("[known_good]\nparts = 1\n").contains("write an array of names"));
}

#[test]
fn contract_what_cannot_take_effects_says_where_they_stand() {
    let text = "[effects]\ncable_spring = { stiffness_nm_per_rad = 1e-3 }\n";
    let model = ModelFile::parse(text, "m.toml").expect("reads");
    let message = model.without_effects("`gimbal sweep`").expect_err("refused").to_string();
    assert!(
        message.starts_with("m.toml: line 2, column 41: `gimbal sweep` does not take `effects.cable_spring`"),
        "{message}"
    );
}
