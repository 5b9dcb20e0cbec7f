//! `[axis]`: what reads, and how a mistake is told.

#![allow(clippy::float_cmp, reason = "values are read as they are written")]

use gimbal_model_file::AxisModel;
use gimbal_model_file::axis::Quantity;

const GOOD: &str = "[axis]\nmotion = \"rotary\"\neffort_unit = \"A\"\ninertia = 2e-4\n\n[axis.columns]\n\
time = { name = \"t\", unit = \"ms\" }\nposition = { name = \"q\", unit = \"deg\" }\neffort = { name = \"i\", unit = \"mA\" }\n";

fn told(text: &str) -> String {
    AxisModel::parse(text, "axis.toml").expect_err("wrong").to_string()
}

#[test]
fn closed_form_units_become_those_of_the_model() {
    let model = AxisModel::parse(GOOD, "axis.toml").expect("reads").expect("an axis");
    let columns = &model.columns;
    assert_eq!(model.size(&columns.time, Quantity::Time), 1e-3);
    assert_eq!(model.size(&columns.effort, Quantity::Effort), 1e-3);
    let degree = model.size(columns.position.as_ref().expect("there"), Quantity::Position);
    assert!((degree - std::f64::consts::PI / 180.0).abs() < 1e-18);
    assert_eq!(model.parameter_unit(2), "A s2/rad");
    assert_eq!(model.tolerance.coulomb, 0.15);
}

#[test]
fn contract_a_parameter_that_is_known_to_be_good_has_no_tolerance() {
    let known = GOOD.replace("inertia = 2e-4", "inertia = 2e-4\nknown_good = [\"viscous_friction\", \"stribeck\"]");
    let tolerance = AxisModel::parse(&known, "axis.toml").expect("reads").expect("an axis").tolerance;
    assert_eq!([tolerance.inertia, tolerance.viscous], [0.03, 0.0]);
}

#[test]
fn contract_a_file_without_the_table_is_no_axis() {
    assert_eq!(AxisModel::parse("preset = \"consistent\"\n", "servo.toml").expect("reads"), None);
}

#[test]
fn contract_mistakes_name_their_place_and_what_would_be_right() {
    let cases = [
        (
            "inertia = 2e-4",
            "inertia = -1.0",
            "axis.toml: line 4, column 1: `axis.inertia` is -1; it must be above zero",
        ),
        (
            "inertia = 2e-4",
            "inertia = 1.0\nviscos = 2.0",
            "line 5, column 1: `viscos` is not a key here; the nearest known one is `viscous`",
        ),
        (
            "unit = \"deg\"",
            "unit = \"mm\"",
            "line 8, column 1: `axis.columns.position` has the unit \"mm\"; write one of \"rad\"",
        ),
        ("\"q\", unit = \"deg\" }", "\"q\" }", "`axis.columns.position` has no `unit`; write one of \"rad\""),
        ("unit = \"mA\"", "unit = \"N\"", "`axis.columns.effort` has the unit \"N\"; write one of \"A\", \"mA\""),
        ("motion = \"rotary\"", "motion = \"round\"", "line 2, column 10"),
        ("inertia = 2e-4\n", "", "missing field `inertia`"),
        (
            "inertia = 2e-4",
            "inertia = 2e-4\nknown_good = [\"motor_lg\"]",
            "line 5, column 1: `axis.known_good` has `motor_lg`, which is no effect of an axis; the nearest known one is `motor_lag`",
        ),
        ("position = { name = \"q\", unit = \"deg\" }\n", "", "neither `position` nor `velocity`"),
    ];
    for (good, bad, expected) in cases {
        let message = told(&GOOD.replace(good, bad));
        assert!(message.contains(expected), "{message}\n  for {bad}");
    }
}
