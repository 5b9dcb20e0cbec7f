//! Verdicts over simulated logs: `cargo run --release -p gimbal-gap --example verdicts -- SECONDS SEED SIZE [EFFECT...]`.
//!
//! One line a log, and a count at the end; SIZE multiplies the typical size of every effect.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts given as numbers on the command line"
)]

#[path = "corpus/mod.rs"]
pub mod corpus;

use std::time::Instant;

use corpus::{Case, Excitation, as_log};
use gimbal_model_file::ModelFile;
use gimbal_plant::Effect;

fn main() {
    let mut args = std::env::args().skip(1);
    let mut number = |default: f64| args.next().map_or(default, |text| text.parse().expect("a number"));
    let (seconds, seed, size) = (number(30.0), number(11.0) as u64, number(1.0));
    let only: Vec<String> = args.collect();
    let model = ModelFile::default();
    for excitation in Excitation::ALL {
        let mut counts = [0; 4];
        for effect in [None].into_iter().chain(Effect::all().map(Some)) {
            let name = effect.map_or("nominal", Effect::name);
            if !only.is_empty() && !only.iter().any(|only| only == name) {
                continue;
            }
            let mut values = effect.map(Effect::typical).unwrap_or_default();
            for value in values.iter_mut().take(effect.map_or(0, Effect::sizes)) {
                *value *= size;
            }
            if name == "loop_delay" {
                values[0] *= 1.0585;
            }
            let effects = effect.map(|effect| (effect.name(), values)).into_iter().collect();
            let case = Case { seed, excitation, seconds, effects, drift: 1.0, noise: 1.0 };
            let log = as_log(&corpus::simulate(&case));
            let start = Instant::now();
            let diagnosis = gimbal_gap::diagnose(&log, &model);
            let elapsed = start.elapsed().as_secs_f64();
            let report = gimbal_gap::report::json(&diagnosis, "simulated", "consistent");
            let found: Vec<&str> =
                diagnosis.decision.iter().flat_map(|d| d.found.iter().map(|found| found.effect)).collect();
            let others: Vec<String> = diagnosis
                .decision
                .iter()
                .flat_map(|d| {
                    d.alternatives.iter().map(|set| format!("{} {:.2}", set.effects.join("+"), set.probability))
                })
                .collect();
            let listed = others.iter().any(|other| other.starts_with(name));
            let mark = if found == [name] || found.is_empty() && effect.is_none() {
                counts[0] += 1;
                "right"
            } else if listed {
                counts[1] += 1;
                "class"
            } else if found.is_empty() {
                counts[2] += 1;
                "miss"
            } else {
                counts[3] += 1;
                "WRONG"
            };
            let gone = report["shrink"]["signals"][0]["reduction_percent"].as_f64().unwrap_or(0.0);
            println!(
                "{mark:5} {excitation:?} {name:24} {elapsed:.2} s {} {:?} p {:.2} unknown {:.2} gone {gone:.1} % left {:?} | {}",
                diagnosis.verdict().name(),
                found,
                diagnosis.decision.as_ref().and_then(|d| d.found.first()).map_or(0.0, |found| found.probability),
                diagnosis.decision.as_ref().map_or(0.0, |d| d.unknown_probability),
                diagnosis.decision.as_ref().map(|d| d.left_over.map(f64::round)).unwrap_or_default(),
                others.join(", ")
            );
            for fault in &diagnosis.record.faults {
                println!("      {fault}");
            }
        }
        println!("{excitation:?}: right {} class {} missed {} wrong {}", counts[0], counts[1], counts[2], counts[3]);
    }
}
