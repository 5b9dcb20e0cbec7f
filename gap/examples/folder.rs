//! One line of JSON for each log of a folder: `cargo run --release -p gimbal-gap --example folder -- DIR [FROM TO]`.

use std::path::Path;
use std::time::Instant;

use gimbal_log::{Log, Needs};
use gimbal_model_file::ModelFile;
use rayon::prelude::*;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let number = |index: usize, default: usize| args.get(index).map_or(default, |text| text.parse().expect("a number"));
    let numbers: Vec<usize> = (number(1, 1)..=number(2, 100_000)).collect();
    numbers.into_par_iter().for_each(|number| {
        let folder = Path::new(&args[0]).join("logs");
        let path = folder.join(format!("{number:05}.csv"));
        if !path.exists() {
            return;
        }
        let log = Log::open(&path, Needs::Diagnosis).expect("a log");
        let model = ModelFile::open(&path.with_extension("toml")).expect("a model");
        let start = Instant::now();
        let diagnosis = gimbal_gap::diagnose(&log, &model);
        let mut report = gimbal_gap::report::json(&diagnosis, "log", "model");
        report["left_over"] = serde_json::json!(diagnosis.decision.as_ref().map(|d| d.left_over));
        report["strangers"] = serde_json::json!(
            diagnosis
                .decision
                .iter()
                .flat_map(|d| &d.strangers)
                .take(3)
                .map(|s| format!("{} {:.0}", s.of, s.nats()))
                .collect::<Vec<_>>()
        );
        report["log"] = serde_json::json!(number);
        report["elapsed_s"] = serde_json::json!(start.elapsed().as_secs_f64());
        println!("{report}");
    });
}
