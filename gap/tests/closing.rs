//! The corrected model: what is found goes into the model file, and the gap is closed.

#[path = "../examples/corpus/mod.rs"]
mod corpus;

use corpus::{Case, Excitation, as_log, simulate};
use gimbal_gap::close::corrected;
use gimbal_gap::{Diagnosis, diagnose, pool};
use gimbal_log::Log;
use gimbal_model_file::{ModelFile, effects};
use gimbal_plant::Effect;
use gimbal_servo::{Config, Input};

fn log_with(effects: &[(&'static str, Vec<f64>)], seed: u64) -> Log {
    let effects = effects.to_vec();
    let case = Case { seed, excitation: Excitation::Manoeuvre, seconds: 20.0, effects, drift: 0.6, noise: 1.0 };
    as_log(&simulate(&case))
}

fn typical(name: &'static str) -> (&'static str, Vec<f64>) {
    (name, Effect::from_name(name).expect("an effect of the table").typical())
}

fn names(diagnosis: &Diagnosis) -> Vec<&'static str> {
    diagnosis.decision.iter().flat_map(|decision| decision.found.iter().map(|found| found.effect)).collect()
}

fn closed(log: &Log) -> (Diagnosis, ModelFile) {
    let model = ModelFile::default();
    let diagnosis = diagnose(log, &model);
    let text = corrected(&diagnosis, &model).unwrap_or_else(|why| panic!("{why}: {:?}", names(&diagnosis)));
    let model = ModelFile::parse(&text, "corrected.toml").unwrap_or_else(|error| panic!("{error}\n{text}"));
    (diagnosis, model)
}

/// theta of the flight law under a model, and rms of what the log has beside it, from the third second on.
fn off_rad(log: &Log, model: &ModelFile) -> f64 {
    use gimbal_log::Column::{AccelX, AccelY, AccelZ, GyroAngle, VehicleRate};
    let (flown, _) = effects::flown(&model.effects);
    let law = Config { period_s: 1e-3, ..model.config }.build_with::<f32>(&flown).expect("builds");
    let column = |column| log.column(column).expect("a column");
    let [x, y, z, rate, theta] = [AccelX, AccelY, AccelZ, VehicleRate, GyroAngle].map(column);
    let row = |k: usize| {
        law.axis().units().input(&Input {
            accel_x_mps2: x[k],
            accel_y_mps2: y[k],
            accel_z_mps2: z[k],
            vehicle_rate_radps: rate[k],
            ..Input::default()
        })
    };
    let mut state = law.settled(row(0));
    let mut sum = 0.0;
    for (k, theta) in theta.iter().enumerate() {
        let predicted = law.axis().units().output(&law.step(&mut state, row(k))).gyro_angle_rad;
        if k >= 3000 {
            sum += (theta - predicted).powi(2);
        }
    }
    (sum / (theta.len() - 3000) as f64).sqrt()
}

#[test]
fn closed_form_what_is_found_and_written_is_no_gap_any_more() {
    for name in ["cable_spring", "gyro_damping", "loop_delay"] {
        let log = log_with(&[typical(name)], 23);
        let (first, model) = closed(&log);
        let second = diagnose(&log, &model);
        assert_eq!((second.verdict().name(), names(&second)), ("no_gap", Vec::new()), "{name}");
        // The flight law with the corrected model follows the log.
        let (before, after) = (off_rad(&log, &ModelFile::default()), off_rad(&log, &model));
        println!("{name}: {:?}; theta off by {before:.2e} rad before, {after:.2e} rad after", names(&first));
        assert!(after < 0.2 * before, "{name}: {before:.2e} to {after:.2e} rad");
    }
}

#[test]
fn contract_known_good_parts_are_not_blamed() {
    let log = log_with(&[typical("gyro_damping")], 23);
    let text = "[known_good]\nparts = [\"gyro\", \"torque_sensor\"]\n";
    let model = ModelFile::parse(text, "m.toml").expect("reads");
    let diagnosis = diagnose(&log, &model);
    for name in ["gyro_damping", "angular_momentum", "torque_scale", "torque_bias"] {
        assert!(!names(&diagnosis).contains(&name), "{:?}", names(&diagnosis));
        assert!(!diagnosis.detectable.iter().any(|own| own.effect == name), "{name}");
    }
    // The page says what was left out.
    let page = gimbal_gap::report::html(&diagnosis, "log.csv");
    let (_, left_out) = page.split_once("Not looked for").expect("a section");
    for name in &diagnosis.not_looked_for {
        assert!(left_out.contains(&format!("<td>{name}</td>")), "{name}");
    }
    assert!(diagnosis.not_looked_for.contains(&"gyro_damping"));
    // The gap is there all the same, and the held parameter stays where it is.
    assert_ne!(diagnosis.verdict().name(), "no_gap");
    let fitted = diagnosis.fit.expect("a fit").physics.config.gyro.damping_nm_s_per_rad;
    let nominal = model.config.gyro.damping_nm_s_per_rad;
    assert!((fitted / nominal - 1.0).abs() < 1e-3, "{fitted} of {nominal}");
}

#[test]
fn closed_form_logs_of_one_platform_say_together_what_each_says() {
    let model = ModelFile::default();
    let log = |seed, stiffness| {
        let effects = vec![("cable_spring", vec![stiffness])];
        let case = Case { seed, excitation: Excitation::Manoeuvre, seconds: 12.0, effects, drift: 0.0, noise: 1.0 };
        diagnose(&as_log(&simulate(&case)), &model)
    };
    let (one, two, stiffer) = (log(23, 2e-3), log(24, 2e-3), log(25, 3e-3));
    let same = pool(&[one.clone(), two], &model);
    assert_eq!(same.verdict.name(), "explained", "{}", same.text(&["one".into(), "two".into()]));
    assert_eq!(same.sets[0].effects, ["cable_spring"]);
    let [shared] = &same.shared[..] else { panic!("{:?}", same.shared) };
    assert!(!shared.drifts && (shared.mean[0] - 2e-3).abs() < 4.0 * shared.mean[1], "{shared:?}");
    // Each log under what the other one says: most of the gap is gone.
    for (_, signals) in &same.unseen {
        for own in signals {
            assert!(own.after < 0.25 * own.before, "{own:?}");
        }
    }
    // Half as stiff again is no scatter of the estimate.
    let drifting = pool(&[one.clone(), stiffer], &model);
    assert!(drifting.shared.iter().any(|own| own.effect == "cable_spring" && own.drifts), "{:?}", drifting.shared);
    // A log repeats itself: what differs is nothing.
    let twice = pool(&[one.clone(), one], &model);
    let [repeat] = &twice.repeats[..] else { panic!("{:?}", twice.repeats) };
    assert_eq!(repeat.logs, [0, 1]);
    assert!(repeat.floors.len() == 2 && repeat.floors.iter().all(|(_, _, rms)| *rms < 1e-12), "{repeat:?}");
    assert!(same.repeats.is_empty());
}
