//! How small an effect may be that several logs of one platform name together, each too short to name it alone.
//!
//! `cargo run --release -p gimbal-gap --example pooled -- EFFECT LARGEST STEPS [SECONDS] [SEED]`: sizes from LARGEST down, each the
//! one before over the root of two; at every size eight logs of one platform (parameters drawn once over their tolerances), manoeuvres of
//! SECONDS, and the verdict of 1, 2, 4 and 8 of them. Prints a markdown table: the evidence of the effect in nats, bold where it is named alone.
//! `none` for the effect gives pools without one: STEPS platforms, four logs of each on a rate table, in a manoeuvre, in flight and on the table
//! again, what was named in them, and how near to it they came.

#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts given on the command line")]

#[path = "corpus/mod.rs"]
pub mod corpus;

use std::time::Instant;

use corpus::{Case, Excitation, as_log};
use gimbal_gap::{Diagnosis, Pool, diagnose, pool};
use gimbal_model_file::ModelFile;
use gimbal_plant::Effect;
use gimbal_servo::Config;

/// Logs that are taken together.
const COUNTS: [usize; 4] = [1, 2, 4, 8];
/// Parameters of the platform are off by up to this share of their tolerances.
const DRIFT: f64 = 0.6;

/// Logs of one platform under one motion after the other.
fn diagnoses(
    effects: &[(&'static str, Vec<f64>)],
    motions: &[Excitation],
    seconds: f64,
    seed: u64,
    count: usize,
) -> Vec<Diagnosis> {
    let platform = corpus::drifted(&Config::consistent(), DRIFT, seed);
    let log = |place: usize| {
        let case = Case {
            seed: seed + 1000 * place as u64,
            excitation: motions[place % motions.len()],
            seconds,
            effects: effects.to_vec(),
            drift: 0.0,
            noise: 1.0,
        };
        diagnose(&as_log(&corpus::simulate_platform(&case, &platform)), &ModelFile::default())
    };
    (0..count).map(log).collect()
}

/// Evidence of an effect, bold where it is what is named.
fn told(pool: &Pool, effect: &str) -> String {
    let nats = pool.sets.iter().find(|set| set.effects == [effect]).map_or(0.0, |set| set.nats);
    let named = pool.named.join(" + ");
    match named.as_str() {
        "" => format!("{nats:.1}"),
        own if own == effect => format!("**{nats:.1}**"),
        other => format!("{nats:.1} ({other})"),
    }
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let number = |index: usize, default: f64| args.get(index).map_or(default, |text| text.parse().expect("a number"));
    let (largest, steps, seconds, seed) =
        (number(1, 1e-3), number(2, 6.0) as usize, number(3, 10.0), number(4, 500.0) as u64);
    let name = args.first().map_or("cable_spring", String::as_str);
    if name == "none" {
        for platform in 0..steps as u64 {
            let logs = diagnoses(&[], &Excitation::ALL, seconds, seed + platform, COUNTS[2]);
            let pool = pool(&logs, &ModelFile::default());
            let best = pool.sets.iter().filter(|set| !set.effects.is_empty()).max_by(|a, b| a.nats.total_cmp(&b.nats));
            let best = best.map_or_else(String::new, |set| format!("{} {:.1} nats", set.effects.join(" + "), set.nats));
            let drifting: Vec<&str> = pool.drifting.iter().map(|own| own.effect).collect();
            let verdict = pool.verdict.name();
            println!("platform {}: {verdict}, at most {best}, drifting {drifting:?}", seed + platform);
        }
        return;
    }
    let effect = Effect::from_name(name).expect("an effect");
    let parameter = effect.parameters()[0];
    println!("| {} [{}] | 1 log | 2 | 4 | 8 |\n|---|---|---|---|---|", parameter.name, parameter.unit);
    for step in 0..steps {
        let mut values = effect.typical();
        values[0] = largest * 0.5_f64.powf(0.5 * step as f64);
        let size = values[0];
        let start = Instant::now();
        let logs = diagnoses(&[(effect.name(), values)], &[Excitation::Manoeuvre], seconds, seed, COUNTS[3]);
        let each_s = start.elapsed().as_secs_f64() / COUNTS[3] as f64;
        let cells: Vec<String> = COUNTS
            .iter()
            .map(|count| {
                let start = Instant::now();
                let pool = pool(&logs[..*count], &ModelFile::default());
                eprintln!("a log by itself {each_s:.1} s, {count} together {:.1} s", start.elapsed().as_secs_f64());
                for set in pool.sets.iter().take(4) {
                    let fitted = if set.is_fitted { "" } else { ", not fitted" };
                    eprintln!("  {:?}: {:.3}, {:.1} nats{fitted}", set.effects, set.probability, set.nats);
                }
                eprintln!("  unknown {:.3}, {}", pool.unknown_probability, pool.headline());
                for own in pool.shared.iter().filter(|own| own.effect == name) {
                    let [value, error] = own.mean;
                    eprintln!("{size:.2e}, {count} logs: {value:.3e} +- {error:.1e}, {}", own.preference());
                }
                told(&pool, name)
            })
            .collect();
        println!("| {size:.2e} | {} |", cells.join(" | "));
    }
}
