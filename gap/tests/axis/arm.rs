//! A weight on an arm behind a gear: gravity, and friction that grows with what the gear carries; or a spring on it.
//!
//! ```text
//! u = N + r |N| sgn v        N = J a + B v + G(q)
//! ```

use std::fmt::Write;
use std::path::Path;

use gimbal_gap::axis::{AxisDiagnosis, AxisLog, diagnose, text};
use gimbal_model_file::AxisModel;

const MODEL: &str = "[axis]\nmotion = \"rotary\"\neffort_unit = \"V\"\ninertia = 0.064\nviscous = 0.42\ncoulomb = 0.18\n\
[axis.tolerance]\ninertia = 0.1\nviscous = 0.1\n[axis.columns]\ntime = { name = \"t\", unit = \"s\" }\n\
position = { name = \"q\", unit = \"rad\" }\neffort = { name = \"u\", unit = \"V\" }\n";

/// Rows of a second, and a count of the encoder [rad].
const ROWS_HZ: f64 = 188.0;
const COUNT_RAD: f64 = std::f64::consts::TAU / 4096.0;

/// A sweep, whose effort is the equation's.
fn log(load_v: impl Fn(f64) -> f64, load_ratio: f64) -> String {
    let mut out = String::from("t,q,u\n");
    for k in 0..1500 {
        let t = f64::from(k) / ROWS_HZ;
        let (phase, rate) = (0.6 * t * t, 1.2 * t);
        let (q, v) = (phase.sin(), rate * phase.cos());
        let a = 1.2 * phase.cos() - rate * rate * phase.sin();
        let turning = (v / 0.05).clamp(-1.0, 1.0);
        let need = 0.064 * a + 0.42 * v + load_v(q);
        let u = need + turning * (0.18 + load_ratio * need.abs());
        let _ = writeln!(out, "{t:.6},{:.9},{u:.4}", (q / COUNT_RAD).round() * COUNT_RAD);
    }
    out
}

fn diagnosed(load_v: impl Fn(f64) -> f64, load_ratio: f64) -> AxisDiagnosis {
    let model = AxisModel::parse(MODEL, "arm.toml").expect("reads").expect("an axis");
    let log = AxisLog::read(log(load_v, load_ratio).as_bytes(), Path::new("arm.csv"), &model).expect("reads");
    diagnose(log, &model, Vec::new())
}

#[test]
fn cross_friction_of_the_load_is_told_beside_the_gravity_that_is_the_load() {
    let diagnosis = diagnosed(|q| 4.5 * q.sin(), 0.3);
    let mut found: Vec<(&str, f64)> =
        diagnosis.found.iter().map(|found| (found.effect.as_str(), found.parameters[0].value)).collect();
    found.sort_by(|a, b| a.0.cmp(b.0));
    let [("load_dependence", ratio), ("torque_ripple", gravity_v)] = found[..] else {
        panic!("{}", text(&diagnosis));
    };
    assert!((ratio / 0.3 - 1.0).abs() < 0.1, "{}", text(&diagnosis));
    assert!((gravity_v / 4.5 - 1.0).abs() < 0.1, "{}", text(&diagnosis));
}

#[test]
fn cross_an_arm_has_gravity_alone_and_a_spring_on_it_is_a_spring() {
    let [gravity, spring] = [diagnosed(|q| 4.5 * q.sin(), 0.0), diagnosed(|q| 4.5 * q, 0.0)];
    for (effect, diagnosis) in [("torque_ripple", gravity), ("cable_spring", spring)] {
        let found: Vec<&str> = diagnosis.found.iter().map(|found| found.effect.as_str()).collect();
        assert_eq!(found, [effect], "{}", text(&diagnosis));
    }
}
