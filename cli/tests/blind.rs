//! `gimbal blind` from end to end with a diagnosis that says the same of every log.

use std::path::Path;
use std::process::{Command, Output};

fn gimbal(args: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gimbal")).args(args).current_dir(folder).output().expect("gimbal runs")
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

const REPORT: &str = r#"{"schema":"gimbal-gap/1","verdict":"no_gap","effects":[],"unknown_probability":0.0}"#;

#[test]
fn contract_a_corpus_is_forged_diagnosed_and_scored_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    let forge = [
        "blind",
        "forge",
        "corpus",
        "--key",
        "key",
        "--logs",
        "5",
        "--seconds",
        "5",
        "6",
        "--seed",
        "1",
        "--rocket",
        "none",
    ];
    let made = gimbal(&forge, here);
    assert!(made.status.success(), "{}", said(&made));
    assert_eq!(gimbal(&forge, here).status.code(), Some(2), "a corpus is made once");
    // logs and models are those of the contracts, read by the project's own readers
    for index in 1..=5 {
        let log = here.join(format!("corpus/logs/{index:05}.csv"));
        let model = here.join(format!("corpus/logs/{index:05}.toml"));
        let text = std::fs::read_to_string(&model).expect("a model");
        gimbal_model_file::ModelFile::parse(&text, "model").expect("a model of the contract");
        let run = gimbal(&["run", &log.to_string_lossy(), "--model", &model.to_string_lossy(), "--json"], here);
        assert!(run.status.success(), "{}", said(&run));
    }
    std::fs::write(here.join("report.json"), REPORT).expect("written");
    let diagnose = ["blind", "diagnose", "corpus", "--out", "reports", "--", "cp", "report.json", "{out}/gap.json"];
    let diagnosed = gimbal(&diagnose, here);
    assert!(diagnosed.status.success(), "{}", said(&diagnosed));
    assert_eq!(gimbal(&diagnose, here).status.code(), Some(2), "one diagnosis a corpus");
    let score = ["blind", "score", "corpus", "--key", "key", "--reports", "reports", "--out", "score", "--json"];
    let scored = gimbal(&score, here);
    assert!(scored.status.success(), "{}", said(&scored));
    let result: serde_json::Value = serde_json::from_slice(&scored.stdout).expect("JSON");
    assert_eq!(result["schema"], "gimbal-blind-score/1");
    assert_eq!(result["score"]["logs"], 5);
    assert_eq!(result["score"]["false_alarms"]["hits"], 0);
    for name in ["score.md", "score.html", "score.json", "answers.json"] {
        assert!(here.join("score").join(name).exists(), "{name}");
    }
    assert!(here.join("key.released").exists());
    std::fs::write(here.join("reports/00003/gap.json"), format!("{REPORT} ")).expect("written");
    let refused = gimbal(&score, here);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("changed after the manifest"), "{}", said(&refused));
}

#[test]
fn contract_a_key_inside_its_corpus_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = gimbal(&["blind", "forge", "corpus", "--key", "corpus/key", "--logs", "1"], folder.path());
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("outside the corpus"), "{}", said(&refused));
}
