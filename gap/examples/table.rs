//! Every effect under every excitation: `cargo run --release -p gimbal-gap --example table -- LOGS SECONDS FIRST_SEED [EFFECT...] > docs/gap-table.md`
//!
//! LOGS logs for each effect and excitation. The size is log-uniform from 1 to 10 times the smallest detectable one, which comes from
//! the plant with and without the effect (`corpus/detectable.rs`); where the realistic range ends before it, its end is taken.
//! Nominal parameters are off by up to their tolerance. Noise: pick-off 2e-6 rad rms through 16 bit over +-10 mrad, torque
//! 1e-5 N m, acceleration 0.01 m/s2, rates 2e-4 rad/s. `RAYON_NUM_THREADS` says on how many threads. With `SIZES=DIR` the sizes,
//! which do not depend on the diagnosis, are kept in a folder for the next run; `SIZES_ONLY=1` finds them alone.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts given as numbers on the command line"
)]

#[path = "corpus/mod.rs"]
pub mod corpus;
#[path = "corpus/outcome.rs"]
mod outcome;
#[path = "corpus/page.rs"]
mod page;
#[path = "corpus/progress.rs"]
mod progress;
#[path = "corpus/wilson.rs"]
mod wilson;

use corpus::detectable::{Bench, without_own_drift};
use corpus::draw::Drawn;
use corpus::{Excitation, as_log};
use gimbal_model_file::ModelFile;
use gimbal_plant::Effect;
use gimbal_servo::Config;
use outcome::{Outcome, Truth};
use rand::RngExt;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Smallest and largest size over the detectable one.
const MULTIPLES: (f64, f64) = (1.0, 10.0);

/// One log: what was put in, and what came out; none where only sizes are asked for.
fn one(bench: &Bench, excitation: Excitation, seed: u64, seconds: f64, effect: Effect) -> Option<Outcome> {
    let model = ModelFile::default();
    let place = Effect::all().position(|other| other == effect).unwrap_or(0) as u64;
    let rng = &mut corpus::rng(seed, 100 + place);
    let peak_nm = bench.outputs[1].iter().fold(0.0, |peak: f64, value| peak.max(value.abs()));
    let drawn = Drawn::new(effect, peak_nm, seconds, rng);
    let share: f64 = rng.random();
    let of = || {
        let smallest = bench.smallest(&drawn);
        let size = smallest.map_or(drawn.largest(), |least| {
            let most = MULTIPLES.1.min(drawn.largest() / least).max(MULTIPLES.0);
            least * MULTIPLES.0 * (most / MULTIPLES.0).powf(share)
        });
        Kept { smallest, size, windows: bench.windows(effect, &drawn.values(size)) }
    };
    let Kept { smallest, size, windows } = kept(&format!("{seed}-{excitation:?}-{seconds}-{}", effect.name()), of);
    if std::env::var_os("SIZES_ONLY").is_some() {
        return None;
    }
    let values = drawn.values(size);
    let platform = without_own_drift(&bench.platform, &Config::consistent(), effect);
    let effects = [(effect.name(), values.clone())];
    let log = as_log(&corpus::simulate_rows(&bench.rows, &platform, &effects, 1.0, rng).converted());
    let diagnosis = gimbal_gap::diagnose(&log, &model);
    let report = gimbal_gap::report::json(&diagnosis, "simulated", "consistent");
    Some(Outcome::new(Truth { effect, excitation, seed, values, size, smallest, windows }, &diagnosis, &report))
}

/// What does not depend on the diagnosis.
#[derive(Serialize, Deserialize)]
struct Kept {
    smallest: Option<f64>,
    size: f64,
    windows: Vec<bool>,
}

/// From the folder `SIZES` where it has it; found and kept there else.
fn kept(name: &str, find: impl Fn() -> Kept) -> Kept {
    let Some(folder) = std::env::var_os("SIZES") else { return find() };
    let path = std::path::Path::new(&folder).join(format!("{name}.json"));
    let read = std::fs::read_to_string(&path).ok().and_then(|text| serde_json::from_str(&text).ok());
    read.unwrap_or_else(|| {
        let found = find();
        std::fs::write(&path, serde_json::to_string(&found).expect("numbers")).expect("the folder SIZES");
        found
    })
}

fn main() {
    let mut args = std::env::args().skip(1);
    let mut number = |default: f64| args.next().map_or(default, |text| text.parse().expect("a number"));
    let (logs, seconds, first) = (number(3.0) as u64, number(30.0), number(40_000.0) as u64);
    let only: Vec<String> = args.collect();
    let effects: Vec<Effect> =
        Effect::all().filter(|effect| only.is_empty() || only.iter().any(|name| name == effect.name())).collect();
    let scenes: Vec<(Excitation, u64)> =
        (0..logs).flat_map(|log| Excitation::ALL.map(|excitation| (excitation, first + log))).collect();
    let progress = progress::Progress::new(scenes.len() * effects.len());
    let mut outcomes = Vec::new();
    for (excitation, seed) in scenes {
        let nominal = Config::consistent();
        let rows = corpus::rows(excitation, seconds, seed);
        let bench = Bench::new(rows, &nominal, &corpus::drifted(&nominal, 1.0, seed), &mut corpus::rng(seed, 5));
        let each = effects.par_iter().map(|&effect| {
            let outcome = one(&bench, excitation, seed, seconds, effect);
            progress.step(&outcome.as_ref().map_or_else(|| effect.name().to_owned(), Outcome::told));
            outcome
        });
        outcomes.extend(each.collect::<Vec<_>>().into_iter().flatten());
    }
    println!("{}", page::page(&outcomes, &effects, logs, seconds, first));
}
