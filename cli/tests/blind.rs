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
    let diagnose =
        ["blind", "diagnose", "corpus", "--out", "reports", "--", "/bin/cp", "report.json", "{out}/gap.json"];
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
    let refused =
        gimbal(&["blind", "forge", "corpus", "--key", "corpus/key", "--seed", "1", "--logs", "1"], folder.path());
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("outside the corpus"), "{}", said(&refused));
    // a seed from nowhere is none: neither on record, nor known, nor for development
    let refused = gimbal(&["blind", "forge", "corpus", "--key", "key", "--logs", "1"], folder.path());
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("--freeze"), "{}", said(&refused));
}

/// Runs git in a folder, as somebody.
fn git(words: &[&str], here: &Path) {
    let somebody = ["-c", "user.name=somebody", "-c", "user.email=somebody@localhost", "-c", "commit.gpgsign=false"];
    let status = Command::new("git").args(somebody).args(words).current_dir(here).output().expect("git runs").status;
    assert!(status.success(), "git {words:?}");
}

const DIAGNOSE: [&str; 8] = ["blind", "diagnose", "corpus", "--out", "reports", "--", "/bin/cp", "report.json"];

#[test]
fn contract_the_seed_of_a_scoring_corpus_is_drawn_after_the_diagnosis_is_on_record() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    git(&["init", "-q"], here);
    std::fs::write(here.join("calibration.toml"), "scale = 2").expect("written");
    let freeze = ["blind", "freeze", "record.json", "--program", "/bin/cp", "--commit", "abc", "--calibration"];
    let frozen = gimbal(&[&freeze[..], &["calibration.toml"]].concat(), here);
    assert!(frozen.status.success(), "{}", said(&frozen));
    let forge: Vec<&str> =
        "blind forge corpus --key key --freeze record.json --logs 3 --seconds 5 6 --rocket none".split(' ').collect();
    let early = gimbal(&forge, here);
    assert_eq!(early.status.code(), Some(2));
    assert!(said(&early).contains("record.json: commit it first"), "{}", said(&early));
    git(&["add", "record.json"], here);
    git(&["commit", "-q", "-m", "record"], here);
    let made = gimbal(&forge, here);
    assert!(made.status.success(), "{}", said(&made));
    std::fs::write(here.join("report.json"), REPORT).expect("written");

    // another program, another calibration
    std::fs::copy("/bin/cat", here.join("other")).expect("copied");
    let other = ["blind", "diagnose", "corpus", "--out", "reports", "--", "./other", "report.json"];
    let refused = gimbal(&other, here);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("not the one that was recorded"), "{}", said(&refused));
    let diagnose = [&DIAGNOSE[..], &["{out}/gap.json"]].concat();
    std::fs::write(here.join("calibration.toml"), "scale = 3").expect("written");
    let refused = gimbal(&diagnose, here);
    assert!(said(&refused).contains("not the one that was recorded"), "{}", said(&refused));
    std::fs::write(here.join("calibration.toml"), "scale = 2").expect("written");

    let diagnosed = gimbal(&diagnose, here);
    assert!(diagnosed.status.success(), "{}", said(&diagnosed));
    // a second diagnosis into another folder
    let mut again = diagnose.clone();
    again[4] = "others";
    let refused = gimbal(&again, here);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("one diagnosis a corpus"), "{}", said(&refused));

    let score = ["blind", "score", "corpus", "--key", "key", "--reports", "reports", "--out", "score"];
    // a manifest that names another program
    let manifest = here.join("reports/manifest.json");
    let text = std::fs::read_to_string(&manifest).expect("a manifest");
    let program = gimbal_forge::seal::sha256(&std::fs::read("/bin/cp").expect("cp"));
    std::fs::write(&manifest, text.replace(&program, &"0".repeat(64))).expect("written");
    let refused = gimbal(&score, here);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("not the one that was recorded"), "{}", said(&refused));
    assert!(!here.join("key.released").exists(), "refused before anything is opened");
    std::fs::write(&manifest, text).expect("written");
    // a record made after the corpus
    let record = here.join("corpus/freeze.json");
    let text = std::fs::read_to_string(&record).expect("a record");
    std::fs::write(&record, text.replace("abc", "abd")).expect("written");
    let refused = gimbal(&score, here);
    assert!(said(&refused).contains("freeze.json is not the file that was published"), "{}", said(&refused));
    std::fs::write(&record, text).expect("written");
    let scored = gimbal(&score, here);
    assert!(scored.status.success(), "{}", said(&scored));
    let page = std::fs::read_to_string(here.join("score/score.md")).expect("a page");
    assert!(page.contains("Diagnosis of commit `abc`") && page.contains("the seed was drawn after that"), "{page}");
}

#[test]
fn contract_a_development_set_is_open_and_counts_for_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path();
    let forge = "blind forge corpus --open --logs 3 --seconds 5 6 --rocket none --shares 0 100 0 0 0 --multiples 1 10";
    let forge: Vec<&str> = [&forge.split(' ').collect::<Vec<_>>()[..], &["--seed", "4"]].concat();
    let made = gimbal(&forge, here);
    assert!(made.status.success(), "{}", said(&made));
    for index in 1..=3 {
        let path = here.join(format!("corpus/logs/{index:05}.answer.json"));
        let answer: serde_json::Value =
            serde_json::from_slice(&std::fs::read(path).expect("an answer")).expect("an answer");
        assert_eq!(answer["kind"], "one");
        assert!(answer["effects"][0]["multiple"].as_f64().expect("a size") >= 1.0);
    }
    std::fs::write(here.join("report.json"), REPORT).expect("written");
    // as often as one likes
    for reports in ["first", "second"] {
        let mut diagnose = [&DIAGNOSE[..], &["{out}/gap.json"]].concat();
        diagnose[4] = reports;
        let diagnosed = gimbal(&diagnose, here);
        assert!(diagnosed.status.success(), "{}", said(&diagnosed));
        let scored = gimbal(&["blind", "score", "corpus", "--reports", reports, "--out", "score"], here);
        assert!(scored.status.success(), "{}", said(&scored));
    }
    let page = std::fs::read_to_string(here.join("score/score.md")).expect("a page");
    assert!(page.contains("A development set") && page.contains("no blind score"), "{page}");
    // against itself nothing is lost; against a perfect one everything
    let score = ["blind", "score", "corpus", "--reports", "second", "--out", "again", "--against"];
    assert!(gimbal(&[&score[..], &["score/score.json"]].concat(), here).status.success());
    let text = std::fs::read_to_string(here.join("score/score.json")).expect("a score");
    let mut perfect: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    perfect["score"]["by_kind"][1]["right"] = serde_json::json!({ "hits": 300, "of": 300 });
    std::fs::write(here.join("perfect.json"), perfect.to_string()).expect("written");
    let lost = gimbal(&[&score[..], &["perfect.json"]].concat(), here);
    assert_eq!(lost.status.code(), Some(1), "{}", said(&lost));
    assert!(said(&lost).contains("LOST  verdicts right, put in: one"), "{}", said(&lost));
}

#[test]
fn contract_every_corpus_that_was_opened_stands_in_the_table() {
    let docs = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs"));
    let page = std::fs::read_to_string(docs.join("blind.md")).expect("the page");
    let rows = std::fs::read_dir(docs.join("blind")).expect("corpora").flatten();
    let rows: Vec<_> = rows.filter_map(|entry| std::fs::read_to_string(entry.path().join("row.md")).ok()).collect();
    assert!(!rows.is_empty());
    for row in rows {
        assert!(page.contains(row.trim()), "docs/blind.md lacks the row\n{row}");
    }
}
