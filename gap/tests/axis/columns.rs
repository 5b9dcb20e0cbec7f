//! Columns that are not what they say, in simulated logs.

use std::path::Path as File;

use gimbal_gap::axis::{AxisLog, diagnose, text};
use gimbal_model_file::AxisModel;

use crate::simulated::{diagnosed, model, names, read, value, with_law, with_reference};
use crate::simulator::{MODEL, Path, Truth, log, position_alone};

#[test]
fn cross_wrong_columns_are_told_in_words_and_do_not_become_effects() {
    let n = Truth::nominal;
    let cases = [
        ("velocity_scale", 2.0, Truth { velocity_factor: 2.0, ..n() }),
        ("velocity_scale", std::f64::consts::TAU, Truth { velocity_factor: std::f64::consts::TAU, ..n() }),
        ("position_scale", 2.0, Truth { position_factor: 2.0, ..n() }),
        ("torque_sign", -1.0, Truth { effort_factor: -1.0, ..n() }),
    ];
    for (effect, size, truth) in cases {
        let diagnosis = diagnosed(&truth, Path::Sines, 5);
        let found = value(&diagnosis, effect);
        assert!((found / size - 1.0).abs() < 0.03, "{effect}: {found}");
        let others: Vec<&str> = names(&diagnosis).into_iter().filter(|name| *name != effect).collect();
        assert!(
            !others.iter().any(|name| ["inertia", "viscous_friction", "torque_scale"].contains(name)),
            "{others:?}"
        );
    }
}

#[test]
fn cross_a_wrong_unit_is_told_and_undone() {
    let position_alone = position_alone();
    let as_is = log(&Truth::nominal(), Path::Sines, 24.0, 5);
    let cases = [
        (position_alone.as_str(), "position_scale", "unit = \"m\"", "unit = \"mm\"", 1e-9),
        (&position_alone, "time_scale", "unit = \"s\"", "unit = \"ms\"", 1e-9),
        // the rate column measures the factor
        (MODEL, "time_scale", "unit = \"s\"", "unit = \"ms\"", 0.01),
    ];
    for (model, effect, unit, wrong, within) in cases {
        let model = AxisModel::parse(&model.replacen(unit, wrong, 1), "axis.toml").expect("reads").expect("an axis");
        let read = AxisLog::read(as_is.as_bytes(), File::new("simulated.csv"), &model).expect("reads");
        let diagnosis = diagnose(read, &model, Vec::new());
        assert_eq!(names(&diagnosis), [effect], "{}", text(&diagnosis));
        assert!((value(&diagnosis, effect) / 1e-3 - 1.0).abs() < within, "{}", text(&diagnosis));
    }
}

#[test]
fn cross_a_time_a_little_off_is_told_by_the_parameters_that_it_alone_makes_right() {
    // 8 %: the inertia of a wrong position would be 8 % off, of a wrong rate 17 %, where 3 % are known
    let logged = log(&Truth::nominal(), Path::Sines, 24.0, 5);
    let slow = with_cells(&logged, 0, |time| format!("{:.6}", 1.08 * time));
    let diagnosis = diagnose(read(&slow), &model(), Vec::new());
    assert_eq!(names(&diagnosis), ["time_scale"], "{}", text(&diagnosis));
    assert!((value(&diagnosis, "time_scale") / 1.08 - 1.0).abs() < 0.01, "{}", text(&diagnosis));
}

#[test]
fn cross_which_columns_scale_is_wrong_is_told_by_what_takes_fewest_effects() {
    // a spring takes from the inertia what a wrong scale adds to it
    let logged = |spring: f64, velocity_factor: f64| {
        log(&Truth { spring, velocity_factor, ..Truth::nominal() }, Path::Sines, 24.0, 5)
    };
    let slow = |spring: f64, factor: f64| with_cells(&logged(spring, 1.0), 0, |time| format!("{:.6}", factor * time));
    let cases = [
        ("velocity_scale", 0.95, logged(200.0, 0.95)),
        ("velocity_scale", 0.95, logged(1600.0, 0.95)),
        ("time_scale", 1.05, slow(200.0, 1.05)),
        ("time_scale", 1.1, slow(800.0, 1.1)),
    ];
    for (effect, factor, logged) in cases {
        let diagnosis = diagnose(read(&logged), &model(), Vec::new());
        assert_eq!(names(&diagnosis), [effect, "cable_spring"], "{}", text(&diagnosis));
        assert!((value(&diagnosis, effect) / factor - 1.0).abs() < 0.01, "{}", text(&diagnosis));
    }
}

#[test]
fn cross_a_scale_of_the_effort_is_told_once() {
    // the law's gains are off by the same factor, as its output is that column
    let logged = with_reference(&log(&Truth::nominal(), Path::Sines, 24.0, 5), |_| 0.0);
    let scaled = with_cells(&logged, 3, |effort| format!("{:.6}", 0.88 * effort));
    let model = with_law(39_000.0, 960.0);
    let read = AxisLog::read(scaled.as_bytes(), File::new("simulated.csv"), &model).expect("reads");
    let diagnosis = diagnose(read, &model, Vec::new());
    assert_eq!(names(&diagnosis), ["torque_scale"], "{}", text(&diagnosis));
}

#[test]
fn cross_a_coarse_encoder_is_no_wrong_scale() {
    // a step is 0.2 m/s from row to row, as much as the axis moves in one
    let step = 2e-4;
    let logged = log(&Truth::nominal(), Path::Sines, 24.0, 5);
    let coarse = with_cells(&logged, 1, |position| format!("{:.9}", step * (position / step).round()));
    let diagnosis = diagnose(read(&coarse), &model(), Vec::new());
    assert!(!names(&diagnosis).iter().any(|name| name.ends_with("_scale")), "{}", text(&diagnosis));
}

/// The log with what a column's values become.
fn with_cells(logged: &str, column: usize, becomes: impl Fn(f64) -> String) -> String {
    let (head, rows) = logged.split_once('\n').expect("a head");
    let mut out = format!("{head}\n");
    for line in rows.lines() {
        let mut cells: Vec<String> = line.split(',').map(String::from).collect();
        cells[column] = becomes(cells[column].parse().expect("a number"));
        out.push_str(&(cells.join(",") + "\n"));
    }
    out
}
