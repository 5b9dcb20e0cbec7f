//! Several logs of one platform taken together, against simulated ones.

#[path = "../examples/corpus/mod.rs"]
mod corpus;

use corpus::{Case, Excitation, as_log};
use gimbal_gap::judge::Verdict;
use gimbal_gap::{Diagnosis, Pool, diagnose, pool};
use gimbal_model_file::ModelFile;
use gimbal_servo::Config;

const LOGS: usize = 4;
const SECONDS: f64 = 10.0;
const SEED: u64 = 500;

/// Diagnoses of logs of one platform, its parameters drawn once; `change` makes each run's own.
fn diagnoses(
    effects: &[(&'static str, Vec<f64>)],
    excitation: Excitation,
    change: impl Fn(usize, &mut Config),
) -> Vec<Diagnosis> {
    diagnoses_of(LOGS, effects, excitation, change)
}

/// The first of them.
fn diagnoses_of(
    count: usize,
    effects: &[(&'static str, Vec<f64>)],
    excitation: Excitation,
    change: impl Fn(usize, &mut Config),
) -> Vec<Diagnosis> {
    let platform = corpus::drifted(&Config::consistent(), 0.6, SEED);
    let log = |place: usize| {
        let mut platform = platform;
        change(place, &mut platform);
        let seed = SEED + 1000 * place as u64;
        let case = Case { seed, excitation, seconds: SECONDS, effects: effects.to_vec(), drift: 0.0, noise: 1.0 };
        diagnose(&as_log(&corpus::simulate_platform(&case, &platform)), &ModelFile::default())
    };
    (0..count).map(log).collect()
}

fn names(diagnosis: &Diagnosis) -> Vec<&'static str> {
    diagnosis.decision.iter().flat_map(|decision| decision.found.iter().map(|found| found.effect)).collect()
}

fn together(diagnoses: &[Diagnosis]) -> Pool {
    let pool = pool(diagnoses, &ModelFile::default());
    let sum: f64 = pool.sets.iter().map(|set| set.probability).sum::<f64>() + pool.unknown_probability;
    assert!((sum - 1.0).abs() < 1e-6, "probabilities sum to {sum}");
    pool
}

fn told(pool: &Pool) -> String {
    pool.text(&["a", "b", "c", "d", "e", "f", "g", "h"].map(str::to_owned))
}

#[test]
fn an_effect_too_small_for_every_log_is_named_by_all_of_them() {
    let size = 5.4e-7;
    let logs = diagnoses_of(2 * LOGS, &[("cable_spring", vec![size])], Excitation::Manoeuvre, |_, _| ());
    for log in &logs {
        assert_eq!(names(log), Vec::<&str>::new());
    }
    let alone: Vec<f64> = logs
        .iter()
        .map(|log| {
            let pool = together(std::slice::from_ref(log));
            assert!(pool.named.is_empty(), "{}", told(&pool));
            pool.sets.iter().find(|set| set.effects == ["cable_spring"]).map_or(0.0, |set| set.nats)
        })
        .collect();
    let pool = together(&logs);
    assert_eq!(pool.named, ["cable_spring"], "{alone:?} {}", told(&pool));
    let own = &pool.shared[0];
    let [value, error] = own.mean;
    assert!((value - size).abs() < 3.0 * error, "{value} +- {error}");
    assert!(!own.drifts && own.shared_nats.is_some_and(|nats| nats > 0.0), "{}", told(&pool));
    let nats = pool.sets.iter().find(|set| set.effects == ["cable_spring"]).expect("the set").nats;
    assert!(alone.iter().all(|alone| *alone < 18.0) && nats > 18.0, "{alone:?}, together {nats}");
}

#[test]
fn an_effect_of_one_log_alone_is_not_one_of_the_platform() {
    let mut logs = diagnoses(&[], Excitation::Manoeuvre, |_, _| ());
    let with = diagnoses_of(1, &[("cable_spring", vec![1.4e-6])], Excitation::Manoeuvre, |_, _| ());
    assert_eq!(names(&with[0]), ["cable_spring"]);
    logs[0] = with.into_iter().next().expect("a log");
    let pool = together(&logs);
    assert_eq!((pool.verdict, pool.named.len()), (Verdict::NoGap, 0), "{}", told(&pool));
    assert!(told(&pool).contains("named in one log, not by all logs together: cable_spring"), "{}", told(&pool));
}

#[test]
fn no_effect_is_made_of_the_chance_in_several_logs() {
    for excitation in [Excitation::Manoeuvre, Excitation::RateTable] {
        let pool = together(&diagnoses(&[], excitation, |_, _| ()));
        assert_eq!((pool.verdict, pool.named.len()), (Verdict::NoGap, 0), "{excitation:?}: {}", told(&pool));
        // what no log shows is not ruled out by taking them together
        assert!(pool.unknown_probability >= 0.03, "{excitation:?}: {}", pool.unknown_probability);
    }
}

#[test]
fn friction_that_changes_from_run_to_run_is_told_from_friction_of_another_level() {
    let levels = [1.2, 1.45, 1.7, 1.3];
    let level = |factor: f64| move |config: &mut Config| config.bearing.load_torque_nm_per_n *= factor;
    let drifting = together(&diagnoses(&[], Excitation::Manoeuvre, |log, config| level(levels[log])(config)));
    assert_eq!(drifting.named, ["friction_level"], "{}", told(&drifting));
    let own = &drifting.shared[0];
    assert!(own.drifts && own.shared_nats.is_some_and(|nats| nats < -100.0), "{}", told(&drifting));
    for ((_, value, error), level) in own.values.iter().zip(levels) {
        // the platform's own level is drawn within its tolerance
        let off = (1.0 + value) / level;
        assert!((0.85..1.15).contains(&off) && *error < 0.05, "{value} +- {error} of {level}: {}", told(&drifting));
    }
    assert!(told(&drifting).contains("drifts from run to run over 4 logs"), "{}", told(&drifting));
    // inside its tolerance it is no effect, and is told all the same
    let inside = [0.93, 1.0, 1.07, 0.97];
    let inside = together(&diagnoses(&[], Excitation::Manoeuvre, |log, config| level(inside[log])(config)));
    assert_eq!((inside.verdict, inside.named.len()), (Verdict::NoGap, 0), "{}", told(&inside));
    assert_eq!(
        inside.drifting.iter().map(|own| own.effect).collect::<Vec<_>>(),
        ["friction_level"],
        "{}",
        told(&inside)
    );
}

#[test]
fn a_value_that_all_logs_share_is_known_better_than_by_one() {
    let size = 2e-5;
    let logs = diagnoses(&[("cable_spring", vec![size])], Excitation::Manoeuvre, |_, _| ());
    let pool = together(&logs);
    assert_eq!((pool.verdict, pool.named.as_slice()), (Verdict::Explained, &["cable_spring"][..]), "{}", told(&pool));
    let own = &pool.shared[0];
    assert!(!own.drifts && own.shared_nats.is_some_and(|nats| nats > 0.0), "{}", told(&pool));
    let [value, error] = own.mean;
    assert!((value - size).abs() < 3.0 * error, "{value} +- {error}");
    // one log's error, of as many logs as there are
    let weights: f64 = logs
        .iter()
        .filter_map(|log| log.decision.as_ref()?.found.iter().find(|found| found.effect == "cable_spring"))
        .map(|found| found.errors[0].powi(-2))
        .sum();
    let ratio = error * weights.sqrt();
    assert!((0.7..1.6).contains(&ratio), "{error} is {ratio} times that of {LOGS} logs");
    for (_, signals) in &pool.unseen {
        for own in signals {
            assert!(own.after < 1.05 * own.before, "{}", told(&pool));
        }
    }
}
