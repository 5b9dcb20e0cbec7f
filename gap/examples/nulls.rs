//! False alarms: logs without effect, every nominal parameter anywhere inside its tolerance.
//!
//! `cargo run --release -p gimbal-gap --example nulls -- LOGS SECONDS FIRST_SEED`, with `RAYON_NUM_THREADS=1` on one core.
//! Prints a markdown table with 95 % intervals (Wilson) by excitation, and every log that was not called `no_gap`. Noise: pick-off
//! 2e-6 rad rms through 16 bit over +-10 mrad, torque 1e-5 N m, acceleration 0.01 m/s2, rates 2e-4 rad/s.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts given as numbers on the command line"
)]

#[path = "corpus/mod.rs"]
pub mod corpus;
#[path = "corpus/progress.rs"]
mod progress;
#[path = "corpus/wilson.rs"]
mod wilson;

use corpus::{Case, Excitation, as_log};
use gimbal_gap::judge::Verdict;
use gimbal_model_file::ModelFile;
use rayon::prelude::*;

/// A log that is not `no_gap`.
struct Alarm {
    excitation: Excitation,
    seed: u64,
    told: String,
    /// Whether an effect was named or a gap called unexplained; else the data were refused.
    is_gap: bool,
}

fn diagnosed(excitation: Excitation, seed: u64, seconds: f64, model: &ModelFile) -> Option<Alarm> {
    let (platform, effects) = corpus::anywhere(seed);
    let case = Case { seed, excitation, seconds, effects, drift: 0.0, noise: 1.0 };
    let log = as_log(&corpus::simulate_platform(&case, &platform).converted());
    let diagnosis = gimbal_gap::diagnose(&log, model);
    if diagnosis.verdict() == Verdict::NoGap {
        return None;
    }
    let mut told = vec![diagnosis.verdict().name().to_owned()];
    told.extend(diagnosis.record.faults.iter().map(|fault| format!("data: {fault}")));
    for found in diagnosis.decision.iter().flat_map(|decision| &decision.found) {
        let values: Vec<String> = found
            .values
            .iter()
            .zip(&found.errors)
            .map(|(value, error)| format!("{value:.3e} +- {error:.1e} (z {:.1})", value / error.max(1e-300)))
            .collect();
        told.push(format!("{} p {:.2}: {}", found.effect, found.probability, values.join(", ")));
    }
    for set in diagnosis.decision.iter().flat_map(|decision| &decision.alternatives) {
        told.push(format!("or {} p {:.2}", set.effects.join("+"), set.probability));
    }
    told.extend(gain(&diagnosis));
    let told = told.join("; ");
    Some(Alarm { excitation, seed, told, is_gap: diagnosis.record.faults.is_empty() })
}

/// What the fit leaves, and what stands out of the noise.
fn gain(diagnosis: &gimbal_gap::Diagnosis) -> Option<String> {
    let (fit, decision) = (diagnosis.fit.as_ref()?, diagnosis.decision.as_ref()?);
    let [before, after] = decision.left_over;
    let goes_with = decision.goes_with().map_or_else(String::new, |stranger| format!(", goes with {stranger}"));
    Some(format!("square {:.1}, left over {before:.1} before, {after:.1} after{goes_with}", fit.square))
}

fn main() {
    let mut args = std::env::args().skip(1);
    let mut number = |default: f64| args.next().map_or(default, |text| text.parse().expect("a number"));
    let (logs, seconds, first) = (number(600.0) as u64, number(20.0), number(100_000.0) as u64);
    let model = ModelFile::default();
    let cases: Vec<(Excitation, u64)> =
        (0..logs).map(|log| (Excitation::ALL[(log % 3) as usize], first + log)).collect();
    let progress = progress::Progress::new(cases.len());
    let outcomes: Vec<Option<Alarm>> = cases
        .par_iter()
        .map(|&(excitation, seed)| {
            let alarm = diagnosed(excitation, seed, seconds, &model);
            let told = alarm.as_ref().map_or("no_gap", |alarm| &alarm.told);
            progress.step(&format!("{} {seed}: {told}", excitation.name()));
            alarm
        })
        .collect();
    println!(
        "{logs} logs of {seconds} s at 1 kHz without effect, seeds {first} to {}.\n",
        first + logs.saturating_sub(1)
    );
    println!("| excitation | logs | false alarms | 95 % interval | data refused |\n|---|---|---|---|---|");
    let line = |name: &str, only: Option<Excitation>| {
        let of = |excitation: Excitation| only.is_none_or(|only| only == excitation);
        let all = cases.iter().filter(|case| of(case.0)).count();
        let those = |is_gap: bool| {
            outcomes.iter().flatten().filter(|alarm| of(alarm.excitation) && alarm.is_gap == is_gap).count()
        };
        println!("| {name} | {all} | {} | {} | {} |", those(true), wilson::percent(those(true), all), those(false));
    };
    for excitation in Excitation::ALL {
        line(excitation.name(), Some(excitation));
    }
    line("all", None);
    println!();
    for alarm in outcomes.iter().flatten() {
        println!("- {}, seed {}: {}", alarm.excitation.name(), alarm.seed, alarm.told);
    }
}
