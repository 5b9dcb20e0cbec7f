//! Simulated logs with known effects.

use std::path::Path as File;

use gimbal_gap::axis::{AxisDiagnosis, AxisLog, diagnose, json, text};
use gimbal_gap::judge::Verdict;
use gimbal_model_file::AxisModel;

use crate::simulator::{MODEL, Path, Truth, log, position_alone};

pub(crate) fn model() -> AxisModel {
    AxisModel::parse(MODEL, "axis.toml").expect("reads").expect("an axis")
}

pub(crate) fn read(text: &str) -> AxisLog {
    AxisLog::read(text.as_bytes(), File::new("simulated.csv"), &model()).expect("reads")
}

pub(crate) fn diagnosed(truth: &Truth, path: Path, seed: u64) -> AxisDiagnosis {
    diagnose(read(&log(truth, path, 24.0, seed)), &model(), Vec::new())
}

pub(crate) fn names(diagnosis: &AxisDiagnosis) -> Vec<&str> {
    diagnosis.found.iter().map(|found| found.effect.as_str()).collect()
}

/// Value of the first parameter of an effect.
pub(crate) fn value(diagnosis: &AxisDiagnosis, effect: &str) -> f64 {
    let found = diagnosis.found.iter().find(|found| found.effect == effect);
    let found = found.unwrap_or_else(|| panic!("{effect} not in {:?}", names(diagnosis)));
    found.parameters[0].value
}

#[test]
fn cross_an_axis_within_tolerance_has_no_gap() {
    for seed in 0..4 {
        let spread = f64::from(i32::try_from(seed).expect("small") - 2) * 0.01;
        let truth = Truth {
            inertia: 80.0 * (1.0 + spread),
            viscous: 150.0 * (1.0 - spread),
            coulomb: 25.0 * (1.0 + 3.0 * spread),
            ..Truth::nominal()
        };
        let diagnosis = diagnosed(&truth, Path::Sines, seed);
        assert_eq!(diagnosis.verdict.name(), "no_gap", "{}", text(&diagnosis));
    }
}

#[test]
fn cross_single_effects_are_named_with_their_size() {
    let n = Truth::nominal;
    let cases = [
        ("inertia", 95.0, 0.01, Truth { inertia: 95.0, ..n() }),
        ("viscous_friction", 210.0, 0.02, Truth { viscous: 210.0, ..n() }),
        ("friction_level", 38.0, 0.02, Truth { coulomb: 38.0, ..n() }),
        ("presliding", 25.0, 0.05, Truth { bristle: 3e-4, ..n() }),
        ("quadratic_drag", 200.0, 0.1, Truth { drag: 200.0, ..n() }),
        ("friction_drift", -10.0, 0.05, Truth { warming: (0.4, 6.0), ..n() }),
        ("torque_ripple", 5.0, 0.05, Truth { ripple: vec![(400.0, 5.0, 0.4)], ..n() }),
        ("motor_ripple", 0.1, 0.05, Truth { motor_ripple: vec![(300.0, 0.1, 0.4)], ..n() }),
        ("dead_zone", 8.0, 0.05, Truth { dead_zone: 8.0, ..n() }),
        ("motor_lag", 4e-3, 0.1, Truth { delay_rows: 4, ..n() }),
        ("external_load:code", 10.0, 0.01, Truth { load_per_code: 10.0, ..n() }),
        ("torque_scale", 1.0 / 1.2 - 1.0, 0.02, Truth { gain: 1.2, ..n() }),
    ];
    for (effect, size, tolerance, truth) in cases {
        let diagnosis = diagnosed(&truth, Path::Sines, 5);
        let found = value(&diagnosis, effect);
        assert!((found / size - 1.0).abs() < tolerance, "{effect}: {found} for {size}\n{}", text(&diagnosis));
        assert_eq!(diagnosis.found.iter().find(|f| f.shows_in == "effort").expect("one").effect, effect);
        let shrunk = &diagnosis.shrunk[0];
        assert!(shrunk.reduction_percent > 80.0 && shrunk.ci95_percent[0] > 0.0, "{effect}\n{}", text(&diagnosis));
    }
}

#[test]
fn cross_an_offset_and_an_asymmetry_are_told_as_each_other() {
    let n = Truth::nominal;
    for truth in [Truth { constant: 6.0, ..n() }, Truth { asymmetry: 0.24, ..n() }] {
        let diagnosis = diagnosed(&truth, Path::Sines, 5);
        let class = ["constant_torque", "direction_asymmetry"];
        let first = diagnosis.found.first().expect("one");
        assert!(class.contains(&first.effect.as_str()), "{}", text(&diagnosis));
        assert!((first.parameters[0].value - 6.0).abs() < 0.3, "{}", text(&diagnosis));
    }
}

#[test]
fn cross_a_force_in_time_is_unknown_and_its_frequency_is_told() {
    let truth = Truth { hum: (2.0, 7.3), ..Truth::nominal() };
    for seed in 0..3 {
        let diagnosis = diagnosed(&truth, Path::Sines, seed);
        assert_eq!(diagnosis.verdict, Verdict::Unexplained, "{}", text(&diagnosis));
        // lines lie 1/24 Hz apart
        assert!(diagnosis.notes.iter().any(|note| note.contains("beats at 7.29 Hz")), "{}", text(&diagnosis));
    }
}

#[test]
fn cross_short_sticks_at_reversals_leave_nothing() {
    // friction there is whatever the effort is: with those rows in the balance more than twice the floor is left
    for seed in 0..3 {
        let shrunk = &diagnosed(&Truth::nominal(), Path::Sines, seed).shrunk[0];
        assert!(shrunk.after < shrunk.noise_floor, "{} of {}", shrunk.after, shrunk.noise_floor);
    }
}

#[test]
fn cross_friction_along_a_hyperbolic_tangent_is_no_effect() {
    for smooth_rate in [5e-4, 1e-3, 4e-3] {
        let off = Truth { inertia: 81.5, viscous: 147.0, coulomb: 22.5, smooth_rate, ..Truth::nominal() };
        let diagnosis = diagnosed(&off, Path::Strokes, 3);
        assert_eq!(diagnosis.verdict.name(), "no_gap", "{smooth_rate}: {}", text(&diagnosis));
    }
}

#[test]
fn cross_friction_that_is_larger_one_way_at_all_rates_is_an_asymmetry() {
    let truth = Truth { asymmetry: 0.24, viscous_asymmetry: 0.24, ..Truth::nominal() };
    let diagnosis = diagnosed(&truth, Path::Sines, 5);
    assert_eq!(names(&diagnosis), ["direction_asymmetry"], "{}", text(&diagnosis));
    assert!((value(&diagnosis, "direction_asymmetry") / 0.24 - 1.0).abs() < 0.05, "{}", text(&diagnosis));
}

#[test]
fn cross_a_small_shift_of_a_parameter_beside_a_large_effect_is_no_effect_and_a_large_one_is() {
    for (viscous, effects) in [(160.0, &["torque_ripple"][..]), (190.0, &["torque_ripple", "viscous_friction"])] {
        let truth = Truth { viscous, ripple: vec![(400.0, 30.0, 0.4)], ..Truth::nominal() };
        let diagnosis = diagnosed(&truth, Path::Sines, 5);
        assert_eq!(names(&diagnosis), effects, "{viscous}: {}", text(&diagnosis));
    }
}

/// A sweep from 0.3 to 6 Hz of the nominal axis with such a Coulomb friction, seen by an encoder: its effort as it is made of the
/// time, of what the motion needs, and of the slope of that.
fn swept(coulomb_n: f64, step_m: f64, effort_n: impl Fn(f64, f64, f64) -> f64) -> String {
    let angle = |t: f64| std::f64::consts::TAU * t * (0.3 + 5.7 * t / 48.0);
    let hz = |t: f64| 0.3 + 5.7 * t / 24.0;
    let position = |t: f64| 0.04 / hz(t) / (1.0 + 0.5 * hz(t)) * angle(t).sin();
    let needed = |t: f64| {
        let (before, now, after) = (position(t - 1e-4), position(t), position(t + 1e-4));
        let (rate, acceleration) = ((after - before) / 2e-4, (after - 2.0 * now + before) / 1e-8);
        80.0 * acceleration + 150.0 * rate + coulomb_n * (rate / 1e-3).tanh()
    };
    let mut out = String::from("t,x,v,f,code\n");
    for row in 0..24_000 {
        let t = 1e-3 * f64::from(row);
        let effort = effort_n(t, needed(t), (needed(t + 1e-4) - needed(t - 1e-4)) / 2e-4);
        let rate = (position(t + 1e-4) - position(t - 1e-4)) / 2e-4;
        out.push_str(&format!("{t:.4},{:.9},{rate:.3},{effort:.3},0\n", step_m * (position(t) / step_m).round()));
    }
    out
}

#[test]
fn cross_a_lag_that_noise_hides_in_the_wide_band_is_told_in_a_narrower_one() {
    // one bad sample makes the effort look large, and the band wide: the encoder's steps are most of the third derivative
    // there, and in a sweep a lag goes with time
    let model = AxisModel::parse(&position_alone(), "axis.toml").expect("reads").expect("an axis");
    for step_m in [5e-6, 2e-5] {
        let logged = swept(25.0, step_m, |_, needed, slope| needed + 4.5e-3 * slope);
        let first = logged.lines().nth(1).expect("rows");
        let cells: Vec<&str> = first.split(',').collect();
        let logged = logged.replacen(first, &[cells[0], cells[1], cells[2], "90000.0", cells[4]].join(","), 1);
        let read = AxisLog::read(logged.as_bytes(), File::new("simulated.csv"), &model).expect("reads");
        let diagnosis = diagnose(read, &model, Vec::new());
        assert_eq!(names(&diagnosis), ["motor_lag"], "{}", text(&diagnosis));
        assert!((value(&diagnosis, "motor_lag") / 4.5e-3 - 1.0).abs() < 0.15, "{}", text(&diagnosis));
    }
}

/// A swept axis by a model file that differs in a line.
fn diagnosed_sweep(logged: &str, line: &str, becomes: &str) -> AxisDiagnosis {
    let model = position_alone().replace("effort_held = true\n", "").replace(line, becomes);
    let model = AxisModel::parse(&model, "axis.toml").expect("reads").expect("an axis");
    let read = AxisLog::read(logged.as_bytes(), File::new("simulated.csv"), &model).expect("reads");
    diagnose(read, &model, Vec::new())
}

#[test]
fn cross_effort_and_motion_read_a_part_of_a_row_apart_are_no_effect() {
    for apart_s in [-2.5e-4, 2.5e-4] {
        let logged = swept(25.0, 1e-7, |_, needed, slope| needed + apart_s * slope);
        let diagnosis = diagnosed_sweep(&logged, "", "");
        assert_eq!(diagnosis.verdict.name(), "no_gap", "{}", text(&diagnosis));
    }
}

#[test]
fn cross_a_dead_zone_larger_than_friction_is_no_friction() {
    let logged = swept(25.0, 1e-7, |_, needed, _| needed + 40.0 * (needed / 0.5).tanh());
    let diagnosis = diagnosed_sweep(&logged, "", "");
    assert_eq!(names(&diagnosis), ["dead_zone"], "{}", text(&diagnosis));
    assert!((value(&diagnosis, "dead_zone") / 40.0 - 1.0).abs() < 0.05, "{}", text(&diagnosis));
}

#[test]
fn cross_an_axis_that_has_no_coulomb_friction_may_have_effects() {
    for sign in [-1.0, 1.0] {
        let logged = swept(0.0, 1e-7, |t, needed, _| needed + sign * 20.0 * (1.0 - (-t / 6.0).exp()));
        let diagnosis = diagnosed_sweep(&logged, "coulomb = 25.0", "coulomb = 0.0");
        assert_eq!(names(&diagnosis), ["bias_drift"], "{}", text(&diagnosis));
    }
}

#[test]
fn cross_a_law_with_gains_far_off_is_told_by_its_gains() {
    let diagnosis = diagnosed_with_law(46_800.0, 1152.0, |_| 0.0);
    // the loop of the simulator has 39000 and 960
    assert!((value(&diagnosis, "loop_gain") / 39_000.0 - 1.0).abs() < 0.01, "{}", text(&diagnosis));
}

#[test]
fn cross_a_law_that_is_not_the_loops_is_doubted() {
    assert_eq!(diagnosed_with_law(39_000.0, 960.0, |_| 0.0).verdict, Verdict::NoGap);
    // a thing of its own kind in the loop: a dither of 19.3 Hz that the law does not have
    let dither = |time_s: f64| 4e-4 * (std::f64::consts::TAU * 19.3 * time_s).sin();
    let dithered = diagnosed_with_law(39_000.0, 960.0, dither);
    assert_eq!(dithered.verdict, Verdict::Unexplained, "{}", text(&dithered));
    assert!(dithered.unknown_probability > 0.5);
}

/// The nominal axis under a law of these gains, with what is added to the reference.
fn diagnosed_with_law(position_gain: f64, velocity_gain: f64, added: impl Fn(f64) -> f64) -> AxisDiagnosis {
    let model = with_law(position_gain, velocity_gain);
    let logged = with_reference(&log(&Truth::nominal(), Path::Sines, 24.0, 5), added);
    let read = AxisLog::read(logged.as_bytes(), File::new("simulated.csv"), &model).expect("reads");
    diagnose(read, &model, Vec::new())
}

pub(crate) fn with_law(position_gain: f64, velocity_gain: f64) -> AxisModel {
    let law = format!(
        "[axis.controller]\noutput = \"effort\"\nposition_gain = {position_gain:?}\nvelocity_gain = {velocity_gain:?}\n"
    );
    let columns = "position_reference = { name = \"r\", unit = \"m\" }\n[axis.columns.auxiliary]\n";
    let model = MODEL.replace("[axis.columns.auxiliary]\n", columns) + &law;
    AxisModel::parse(&model, "axis.toml").expect("reads").expect("an axis")
}

/// The reference that the simulator's law had, from what it gave: `command = 39000 (reference - position) - 960 rate`;
/// and what is added to it.
pub(crate) fn with_reference(logged: &str, added: impl Fn(f64) -> f64) -> String {
    let mut out = String::from("t,x,v,f,code,r\n");
    for line in logged.lines().skip(1) {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let [time, position, rate, command, _] = cells[..] else { panic!("five cells: {line}") };
        out.push_str(&format!("{line},{:.9}\n", position + (command + 960.0 * rate) / 39_000.0 + added(time)));
    }
    out
}

#[test]
fn contract_the_verdict_hangs_on_neither_order_nor_origin_nor_spare_columns() {
    let truth = Truth { static_excess: 12.0, constant: 5.0, ripple: vec![(400.0, 6.0, 0.4)], ..Truth::nominal() };
    let text = log(&truth, Path::Sines, 24.0, 3);
    let as_is = diagnose(read(&text), &model(), Vec::new());
    let mut shuffled = String::from("spare,f,code,v,x,t\n");
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let time: f64 = cells[0].parse().expect("a number");
        shuffled.push_str(&format!("7,{},{},{},{},{:.4}\n", cells[3], cells[4], cells[2], cells[1], time + 100.0));
    }
    let other = diagnose(read(&shuffled), &model(), Vec::new());
    assert_eq!(names(&as_is), names(&other));
    let without: String = text.lines().map(|line| line.rsplit_once(',').expect("cells").0.to_owned() + "\n").collect();
    assert_eq!(names(&as_is), names(&diagnose(read(&without), &model(), Vec::new())));
}

#[test]
fn contract_the_report_keeps_the_schema() {
    let truth = Truth { coulomb: 38.0, ..Truth::nominal() };
    let unseen = vec![("other.csv".to_owned(), read(&log(&truth, Path::Strokes, 24.0, 9)))];
    let diagnosis = diagnose(read(&log(&truth, Path::Sines, 24.0, 3)), &model(), unseen);
    let report = json(&diagnosis, "a.csv", "axis.toml");
    assert_eq!(report["schema"], "gimbal-gap/1");
    for key in ["log", "model", "verdict", "where", "effects", "unknown_probability", "alternatives", "shrink", "notes"]
    {
        assert!(!report[key].is_null(), "{key}");
    }
    for key in ["blocks", "signals", "spans", "regimes", "bands"] {
        assert!(report["where"][key].is_array(), "{key}");
    }
    let sum: f64 =
        report["ranking"].as_array().expect("sets").iter().filter_map(|set| set["probability"].as_f64()).sum();
    let unknown = report["unknown_probability"].as_f64().expect("a number");
    assert!((sum + unknown - 1.0).abs() < 0.05, "{sum} + {unknown}");
    let signals = report["shrink"]["signals"].as_array().expect("signals");
    assert_eq!(signals[1]["name"], "effort of other.csv, not fitted");
    assert!(signals[1]["reduction_percent"].as_f64().expect("a number") > 80.0, "{}", signals[1]);
}

#[test]
fn contract_a_bad_cell_is_told_with_its_place() {
    let text = log(&Truth::nominal(), Path::Sines, 1.0, 1).replacen("0.0030,", "0.0030,x", 1);
    let error = AxisLog::read(text.as_bytes(), File::new("bad.csv"), &model()).expect_err("wrong").to_string();
    assert!(error.starts_with("bad.csv: line 5, column `x`:"), "{error}");
    let text = text.replacen("t,x,v,f,code", "t,x,v,force,code", 1);
    let error = AxisLog::read(text.as_bytes(), File::new("bad.csv"), &model()).expect_err("wrong").to_string();
    assert!(error.contains("no column `f`") && error.contains("force"), "{error}");
}
