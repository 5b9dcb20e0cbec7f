//! The diagnosis on logs from the reference plant.

mod alike;
mod bristles;
#[path = "../../examples/corpus/mod.rs"]
mod corpus;
mod noise;
mod nominal;

use corpus::{Case, Excitation, as_log, simulate};
use gimbal_gap::report::json;
use gimbal_gap::{Diagnosis, diagnose};
use gimbal_log::{Column, Log};
use gimbal_model_file::ModelFile;
use gimbal_plant::Effect;
use gimbal_servo::Config;
use rand::RngExt;
use rand_distr::StandardNormal;
use serde_json::Value;

const SECONDS: f64 = 20.0;

fn log_with(excitation: Excitation, effects: &[(&'static str, Vec<f64>)]) -> Log {
    let case = Case { seed: 23, excitation, seconds: SECONDS, effects: effects.to_vec(), drift: 0.6, noise: 1.0 };
    as_log(&simulate(&case))
}

/// Columns that no diagnosis can do without, in another order than a bench has them.
const LEAST: [Column; 6] =
    [Column::GyroAngle, Column::VehicleRate, Column::AccelZ, Column::AccelY, Column::AccelX, Column::Time];

fn of_columns(log: &Log, columns: &[Column]) -> Log {
    let mut own = Log::default();
    own.time.period_s = 1e-3;
    for &column in columns {
        own.set(column, log.column(column).expect("a column").to_vec());
    }
    own
}

fn typical(name: &'static str) -> (&'static str, Vec<f64>) {
    (name, Effect::from_name(name).expect("an effect of the table").typical())
}

fn report(diagnosis: &Diagnosis) -> Value {
    json(diagnosis, "log.csv", "consistent")
}

fn names(diagnosis: &Diagnosis) -> Vec<&'static str> {
    diagnosis.decision.iter().flat_map(|decision| decision.found.iter().map(|found| found.effect)).collect()
}

#[test]
fn an_effect_of_each_block_is_named_with_its_size() {
    for name in ["viscous_friction", "cable_spring", "loop_gain", "gyro_damping", "flexible_mode", "time_skew"] {
        let effect = typical(name);
        let log = log_with(Excitation::Manoeuvre, std::slice::from_ref(&effect));
        let diagnosis = diagnose(&log, &ModelFile::default());
        let found = &diagnosis.decision.as_ref().expect("a decision").found;
        let found = found.iter().find(|found| found.effect == name);
        let found = found.unwrap_or_else(|| panic!("{name}: {:#}", report(&diagnosis)["effects"]));
        let (value, error) = (found.values[0], found.errors[0]);
        assert!(
            (value - effect.1[0]).abs() < 5.0 * error + 0.05 * effect.1[0].abs(),
            "{name}: {value} +- {error}, in truth {}",
            effect.1[0]
        );
        let block = Effect::from_name(name).expect("an effect").block().to_string();
        let reported = report(&diagnosis);
        let own = reported["effects"].as_array().expect("effects").iter().find(|effect| effect["name"] == name);
        assert_eq!(own.expect("the effect")["block"], block.as_str());
    }
}

#[test]
fn a_mode_far_above_the_noise_is_named_however_lightly_damped() {
    let truth = [0.01, 36.0, 0.015];
    for excitation in [Excitation::RateTable, Excitation::Flight] {
        let diagnosis = diagnose(&log_with(excitation, &[("flexible_mode", truth.to_vec())]), &ModelFile::default());
        assert_eq!(names(&diagnosis), ["flexible_mode"], "{excitation:?}");
        let found = &diagnosis.decision.as_ref().expect("a decision").found[0];
        for (value, truth) in found.values.iter().zip(truth) {
            assert!((value / truth - 1.0).abs() < 0.1, "{excitation:?}: {:?}", found.values);
        }
    }
}

#[test]
fn two_effects_at_once_are_both_named() {
    let effects = [typical("cable_spring"), typical("stribeck")];
    let diagnosis = diagnose(&log_with(Excitation::Manoeuvre, &effects), &ModelFile::default());
    let mut found = names(&diagnosis);
    found.sort_unstable();
    assert_eq!(found, ["cable_spring", "stribeck"]);
}

#[test]
fn the_report_keeps_its_schema() {
    let diagnosis = diagnose(&log_with(Excitation::RateTable, &[typical("viscous_friction")]), &ModelFile::default());
    let report = report(&diagnosis);
    assert_eq!(report["schema"], "gimbal-gap/1");
    for key in ["blocks", "signals", "spans", "regimes", "bands"] {
        assert!(report["where"][key].is_array(), "where.{key}");
    }
    for (list, keys) in [
        ("effects", &["name", "block", "probability", "parameters", "removes"][..]),
        ("alternatives", &["effects", "probability", "told_apart_by"][..]),
        ("detectable", &["name", "parameter", "unit", "seen"][..]),
    ] {
        for entry in report[list].as_array().expect(list) {
            for key in keys {
                assert!(!entry[*key].is_null(), "{list}.{key}");
            }
        }
    }
    for entry in report["shrink"]["signals"].as_array().expect("signals") {
        for key in ["name", "unit", "before", "after", "noise_floor", "reduction_percent", "ci95_percent"] {
            assert!(!entry[key].is_null(), "shrink.signals.{key}");
        }
        assert!(entry["after"].as_f64() < entry["before"].as_f64());
    }
    assert!(report["shrink"]["velocity_error_mps"]["before"].is_number());
    for how in ["free_running", "one_step"] {
        let signals = report["shrink"][how].as_array().expect(how);
        assert_eq!(signals.len(), 2, "{how}");
        for entry in signals {
            assert!(entry["after"].as_f64() < entry["before"].as_f64(), "{how}: {entry}");
        }
    }
    for list in ["parameter_correlations", "bounds_hit", "not_looked_for"] {
        assert!(report[list].is_array(), "{list}");
    }
    assert!(report["left_over"].is_null());
    assert!(report["unknown_probability"].is_number() && report["notes"].is_array());
    let decision = diagnosis.decision.expect("a decision");
    let sum: f64 = decision.ranking.iter().map(|set| set.probability).sum::<f64>() + decision.unknown_probability;
    assert!((sum - 1.0).abs() < 1e-6, "probabilities sum to {sum}");
}

#[test]
fn time_origin_and_columns_that_are_not_needed_change_nothing() {
    let log = log_with(Excitation::Manoeuvre, &[typical("cable_spring")]);
    let mut moved = log.clone();
    let later: Vec<f64> = log.column(Column::Time).expect("time").iter().map(|time| time + 1234.5).collect();
    moved.set(Column::Time, later);
    let without = of_columns(&log, &[&[Column::MotorTorque], &LEAST[..]].concat());
    let [own, moved, without] = [log, moved, without].map(|log| names(&diagnose(&log, &ModelFile::default())));
    assert!(own.contains(&"cable_spring"));
    assert_eq!(own, moved);
    assert_eq!(own, without);
}

#[test]
fn wrong_data_are_named_and_no_effect_is_invented() {
    let log = log_with(Excitation::Manoeuvre, &[]);
    let theta = log.column(Column::GyroAngle).expect("theta").to_vec();
    let spoiled = |change: &dyn Fn(f64) -> f64| {
        let mut other = log.clone();
        other.set(Column::GyroAngle, theta.iter().map(|theta| change(*theta)).collect());
        other
    };
    for (what, log) in [
        ("degrees", spoiled(&|theta| theta.to_degrees())),
        ("sign", spoiled(&|theta| -theta)),
        ("stuck", spoiled(&|_| 1e-3)),
    ] {
        let diagnosis = diagnose(&log, &ModelFile::default());
        assert!(names(&diagnosis).is_empty(), "{what}: {:?}", names(&diagnosis));
        assert!(!diagnosis.record.faults.is_empty(), "{what}");
    }
}

#[test]
fn what_follows_a_shove_onto_the_stop_begins_there() {
    let mut log = log_with(Excitation::Manoeuvre, &[typical("cable_spring")]);
    let stop_rad = ModelFile::default().config.gyro.stop_angle_rad;
    let mut theta_rad = log.column(Column::GyroAngle).expect("the pick-off").to_vec();
    // nothing that is logged moves it there, or back
    for (k, theta) in theta_rad.iter_mut().take(2500).enumerate() {
        let way = if k < 2300 { (k as f64 / 200.0).min(1.0) } else { (2500 - k) as f64 / 200.0 };
        *theta += way * (stop_rad - *theta);
    }
    log.set(Column::GyroAngle, theta_rad);
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(names(&diagnosis), ["cable_spring"], "{:#}", report(&diagnosis)["notes"]);
}

#[test]
fn a_ceiling_of_the_torque_is_found_without_a_sensor_that_shows_it() {
    let nominal = log_with(Excitation::Manoeuvre, &[]);
    let torque_nm = nominal.column(Column::MotorTorque).expect("the motor torque");
    let limit_nm = 0.7 * torque_nm.iter().fold(0.0, |peak: f64, own| peak.max(own.abs()));
    let log = of_columns(&log_with(Excitation::Manoeuvre, &[("torque_saturation", vec![limit_nm])]), &LEAST);
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(names(&diagnosis), ["torque_saturation"]);
    let found = &diagnosis.decision.as_ref().expect("a decision").found[0];
    let (value, error) = (found.values[0], found.errors[0]);
    assert!((value - limit_nm).abs() < 3.0 * error && error < 0.03 * limit_nm, "{value} +- {error}, {limit_nm}");
}

#[test]
fn a_stop_is_found_wherever_the_float_stands_on_it() {
    for change in [-0.7, -0.93] {
        let log = log_with(Excitation::Manoeuvre, &[("stop_angle", vec![change])]);
        let diagnosis = diagnose(&log, &ModelFile::default());
        assert_eq!(names(&diagnosis), ["stop_angle"], "{change}: {:#}", report(&diagnosis)["notes"]);
        let found = &diagnosis.decision.as_ref().expect("a decision").found[0];
        assert!((found.values[0] - change).abs() < 3.0 * found.errors[0], "{change}: {:?}", found.values);
    }
}

#[test]
fn a_float_that_goes_past_its_stop_says_that_the_stop_is_farther() {
    let log = log_with(Excitation::Manoeuvre, &[]);
    let theta_rad = log.column(Column::GyroAngle).expect("the pick-off");
    let peak_rad = theta_rad.iter().fold(0.0, |peak: f64, own| peak.max(own.abs()));
    let mut model = ModelFile::default();
    for (share, found) in [(0.8, vec!["stop_angle"]), (0.97, vec![])] {
        model.config.gyro.stop_angle_rad = share * peak_rad;
        let diagnosis = diagnose(&log, &model);
        assert_eq!(names(&diagnosis), found, "{share}: {:#}", report(&diagnosis)["notes"]);
        for own in &diagnosis.decision.as_ref().expect("a decision").found {
            assert!((own.values[0] - (1.0 / share - 1.0)).abs() < 2.0 * own.errors[0], "{:?}", own.values);
        }
    }
}

/// Rounding leaves what no effect takes; that is no reason to take back an effect that stands by itself.
#[test]
fn an_effect_beside_a_quantised_pickoff_is_named() {
    let effects = [("loop_delay", vec![4e-4]), ("pickoff_quantisation", vec![2e-5])];
    let diagnosis = diagnose(&log_with(Excitation::Manoeuvre, &effects), &ModelFile::default());
    assert_eq!(names(&diagnosis), ["loop_delay", "pickoff_quantisation"], "{:#}", report(&diagnosis)["notes"]);
    let decision = diagnosis.decision.as_ref().expect("a decision");
    for (found, (_, value)) in decision.found.iter().zip(&effects) {
        assert!((found.values[0] - value[0]).abs() < 3.0 * found.errors[0], "{found:?}");
    }
}

/// The float is on its stop for a few rows only, under noise of the pick-off: the loop's answer tells it.
#[test]
fn a_stop_that_is_touched_is_found_by_what_the_loop_makes_of_it() {
    let stop_rad = ModelFile::default().config.gyro.stop_angle_rad;
    let free = log_with(Excitation::Manoeuvre, &[]);
    let theta_rad = free.column(Column::GyroAngle).expect("the pick-off");
    let peak_rad = theta_rad.iter().fold(0.0, |peak: f64, own| peak.max(own.abs()));
    for (share, found) in [(0.99, vec!["stop_angle"]), (2.0, vec![])] {
        let change = share * peak_rad / stop_rad - 1.0;
        let mut log = log_with(Excitation::Manoeuvre, &[("stop_angle", vec![change])]);
        let mut rng = corpus::rng(23, 9);
        let mut noisy = |theta: &f64| theta + 1e-5 * rng.sample::<f64, _>(StandardNormal);
        let theta_rad = log.column(Column::GyroAngle).expect("the pick-off").iter().map(&mut noisy).collect();
        log.set(Column::GyroAngle, theta_rad);
        let diagnosis = diagnose(&log, &ModelFile::default());
        assert_eq!(names(&diagnosis), found, "{share}: {:#}", report(&diagnosis)["notes"]);
        for own in &diagnosis.decision.as_ref().expect("a decision").found {
            assert!((own.values[0] - change).abs() < 2.0 * own.errors[0], "{change}: {:?}", own.values);
        }
    }
}

#[test]
fn what_a_sensor_reads_wrong_is_no_torque() {
    let mut log = log_with(Excitation::Manoeuvre, &[]);
    let theta_rad = log.column(Column::GyroAngle).expect("the pick-off");
    let peak_rad = theta_rad.iter().fold(0.0, |peak: f64, own| peak.max(own.abs()));
    let read = theta_rad.iter().map(|theta| theta * (1.0 + 0.01 * (theta / peak_rad).powi(2))).collect();
    log.set(Column::GyroAngle, read);
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(report(&diagnosis)["verdict"], "unexplained", "{:?}", names(&diagnosis));
    let decision = diagnosis.decision.as_ref().expect("a decision");
    assert_eq!(decision.goes_with().map(|stranger| stranger.of), Some("what the pick-off reads"));
}

/// What follows a stop says what it says of a platform that begins there.
#[test]
fn an_effect_beside_a_stop_is_named() {
    for (effect, value) in [("gyro_damping", 0.15), ("friction_level", 0.3)] {
        let effects = vec![("stop_angle", vec![-0.7]), (effect, vec![value])];
        let case =
            Case { seed: 25, excitation: Excitation::Manoeuvre, seconds: SECONDS, effects, drift: 0.6, noise: 1.0 };
        let diagnosis = diagnose(&as_log(&simulate(&case)), &ModelFile::default());
        assert_eq!(names(&diagnosis), [effect, "stop_angle"], "{:#}", report(&diagnosis)["notes"]);
    }
}

/// With `phi' + e w_x` for `phi'`, which the gyro sees, the equations are those of a platform whose vehicle turns by `e w_x` more
/// and on which the torque `Jg e w_x'` acts.
#[test]
fn a_gyro_out_of_line_goes_with_the_cross_rate() {
    let off_rad = 1e-4;
    let platform = corpus::drifted(&Config::consistent(), 0.6, 23);
    let mut rows = corpus::rows(Excitation::Manoeuvre, SECONDS, 23);
    let cross: Vec<f64> = rows.iter().map(|row| row.cross_rate_radps).collect();
    for (k, row) in rows.iter_mut().enumerate() {
        let (before, after) = (cross[k.saturating_sub(1)], cross[(k + 1).min(cross.len() - 1)]);
        row.vehicle_rate_radps += off_rad * cross[k];
        row.torque_nm += platform.servo.gimbal_inertia_kg_m2 * off_rad * (after - before) / 2e-3;
    }
    let mut log = as_log(&corpus::simulate_rows(&rows, &platform, &[], 1.0, &mut corpus::rng(23, 3)).converted());
    let rate_radps = log.column(Column::VehicleRate).expect("the rate").iter().zip(&cross);
    log.set(Column::VehicleRate, rate_radps.map(|(rate, cross)| rate - off_rad * cross).collect());
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(report(&diagnosis)["verdict"], "unexplained", "{:?}", names(&diagnosis));
    let decision = diagnosis.decision.as_ref().expect("a decision");
    assert_eq!(decision.goes_with().map(|stranger| stranger.of), Some("cross rate, to the gyro"));
}

/// What the gimbal turned by before a log has wound its cable, and nothing in the log says how far.
#[test]
fn a_cable_that_was_wound_before_the_log_is_told_by_its_values() {
    let truth = [6e-5, 0.11];
    let case = Case {
        seed: 23,
        excitation: Excitation::RateTable,
        seconds: 24.0,
        effects: vec![("cable_hysteresis", truth.to_vec())],
        drift: 0.6,
        noise: 1.0,
    };
    let whole = as_log(&simulate(&case));
    let mut log = Log::default();
    log.time.period_s = 1e-3;
    for column in LEAST.into_iter().chain([Column::MotorTorque]) {
        log.set(column, whole.column(column).expect("logged")[9000..].to_vec());
    }
    let diagnosis = diagnose(&log, &ModelFile::default());
    assert_eq!(names(&diagnosis), ["cable_hysteresis"]);
    let found = &diagnosis.decision.as_ref().expect("a decision").found[0];
    for ((value, error), truth) in found.values.iter().zip(&found.errors).zip(truth) {
        assert!((value - truth).abs() < 2.0 * error, "{value:e} +- {error:e} of {truth:e}");
    }
}
