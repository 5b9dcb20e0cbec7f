//! Simulated logs with known effects.

use std::path::Path as File;

use gimbal_gap::axis::{AxisDiagnosis, AxisLog, diagnose, text};
use gimbal_model_file::AxisModel;

use crate::simulator::{MODEL, Path, Truth, log};

fn model() -> AxisModel {
    AxisModel::parse(MODEL, "axis.toml").expect("reads").expect("an axis")
}

fn diagnosed(truth: &Truth, path: Path, seed: u64) -> AxisDiagnosis {
    let log = log(truth, path, 24.0, seed);
    let log = AxisLog::read(log.as_bytes(), File::new("simulated.csv"), &model()).expect("reads");
    diagnose(log, &model(), Vec::new())
}

fn names(diagnosis: &AxisDiagnosis) -> Vec<&str> {
    diagnosis.found.iter().map(|found| found.effect.as_str()).collect()
}

#[test]
#[ignore = "a survey for the eye"]
fn survey() {
    let n = Truth::nominal;
    let cases: Vec<(&str, Truth)> = vec![
        ("none", n()),
        ("tolerated", Truth { inertia: 81.5, viscous: 148.0, coulomb: 27.0, ..n() }),
        ("inertia", Truth { inertia: 95.0, ..n() }),
        ("viscous", Truth { viscous: 210.0, ..n() }),
        ("coulomb", Truth { coulomb: 38.0, ..n() }),
        ("stribeck", Truth { static_excess: 12.0, ..n() }),
        ("presliding", Truth { bristle: 3e-4, ..n() }),
        ("asymmetry", Truth { asymmetry: 0.2, ..n() }),
        ("drag", Truth { drag: 200.0, ..n() }),
        ("warming", Truth { warming: (0.4, 6.0), ..n() }),
        ("constant", Truth { constant: 6.0, ..n() }),
        ("ripple", Truth { ripple: vec![(400.0, 5.0, 0.4)], ..n() }),
        ("motor_ripple", Truth { motor_ripple: vec![(300.0, 0.1, 0.4)], ..n() }),
        ("spring", Truth { spring: 80.0, ..n() }),
        ("dead_zone", Truth { dead_zone: 8.0, ..n() }),
        ("delay", Truth { delay_rows: 4, ..n() }),
        ("load", Truth { load_per_code: 10.0, ..n() }),
        ("gain", Truth { gain: 1.2, ..n() }),
        (
            "stribeck+ripple+constant",
            Truth { static_excess: 10.0, ripple: vec![(400.0, 6.0, 0.4)], constant: -5.0, ..n() },
        ),
        ("velocity x2", Truth { velocity_factor: 2.0, ..n() }),
        ("position x2", Truth { position_factor: 2.0, ..n() }),
        ("effort -1", Truth { effort_factor: -1.0, ..n() }),
    ];
    let only = std::env::var("ONLY").unwrap_or_default();
    for (name, truth) in cases.iter().filter(|case| case.0.contains(&only)) {
        for path in [Path::Strokes, Path::Sines] {
            let start = std::time::Instant::now();
            let diagnosis = diagnosed(truth, path, 5);
            let brief: Vec<String> = text(&diagnosis)
                .lines()
                .take_while(|l| !l.starts_with("Columns") || !only.is_empty())
                .map(str::to_owned)
                .collect();
            println!(
                "=== {name} {path:?} {:.1} s {:?}\n{}",
                start.elapsed().as_secs_f64(),
                names(&diagnosis),
                brief.join("\n")
            );
        }
    }
}
