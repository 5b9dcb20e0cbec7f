//! Answers open for an untouched diagnosis that is older than the release, and for nothing else.

use std::fs;
use std::path::{Path, PathBuf};

use gimbal_forge::folder::{self, Answers, Entry, MANIFEST_SCHEMA, Manifest, Published, Refusal};
use gimbal_forge::seal::{self, sha256};

struct Case {
    root: PathBuf,
}

impl Drop for Case {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.root);
    }
}

const REPORT: &str = r#"{"schema":"gimbal-gap/1","verdict":"no_gap"}"#;

impl Case {
    fn new(name: &str) -> Self {
        let root = std::env::temp_dir().join(format!("gimbal-forge-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&root);
        let case = Self { root };
        fs::create_dir_all(case.corpus().join("logs")).expect("folder");
        fs::create_dir_all(case.reports().join("00001")).expect("folder");
        let answers = Answers {
            seed: "00".repeat(32),
            nonce: None,
            shares: [20, 40, 20, 5, 15],
            multiples: (0.5, 10.0),
            version: "0".to_owned(),
            rocket_sha256: None,
            length_s: (20.0, 20.0),
            answers: Vec::new(),
        };
        let plain = serde_json::to_vec(&answers).expect("JSON");
        let (key, recipient) = seal::fresh_key();
        let sealed = seal::seal(&plain, &recipient).expect("sealed");
        fs::write(case.corpus().join("answers.age"), &sealed).expect("written");
        fs::write(case.key(), key).expect("written");
        let log = b"time_s\n0\n";
        fs::write(case.corpus().join("logs/00001.csv"), log).expect("written");
        let published = Published {
            schema: folder::CORPUS_SCHEMA.to_owned(),
            made_unix_s: 100,
            open: false,
            freeze_sha256: None,
            answers_sha256: sha256(&plain),
            sealed_sha256: sha256(&sealed),
            recipient,
            files: [("00001.csv".to_owned(), sha256(log))].into(),
        };
        folder::write_json(&case.corpus().join("corpus.json"), &published).expect("written");
        case.diagnose(200);
        case
    }

    fn corpus(&self) -> PathBuf {
        self.root.join("corpus")
    }

    fn reports(&self) -> PathBuf {
        self.root.join("reports")
    }

    fn key(&self) -> PathBuf {
        self.root.join("key")
    }

    fn report(&self) -> PathBuf {
        self.reports().join("00001/gap.json")
    }

    fn diagnose(&self, finished_unix_s: u64) {
        fs::write(self.report(), REPORT).expect("written");
        let manifest = Manifest {
            schema: MANIFEST_SCHEMA.to_owned(),
            corpus_sha256: sha256(&fs::read(self.corpus().join("corpus.json")).expect("read")),
            command: "true".to_owned(),
            program_sha256: String::new(),
            span_unix_s: (150, finished_unix_s),
            reports: vec![Entry {
                log: "00001".to_owned(),
                sha256: Some(sha256(REPORT.as_bytes())),
                seconds: 1.0,
                failure: None,
            }],
        };
        folder::write_json(&self.reports().join("manifest.json"), &manifest).expect("written");
    }

    /// Opens a day from now, so that files written by the test are older.
    fn open(&self) -> Result<(Answers, Manifest), Refusal> {
        folder::open_answers(&self.corpus(), &self.reports(), &self.key(), 1 << 33)
    }
}

fn append(path: &Path, text: &str) {
    let mut bytes = fs::read(path).expect("read");
    bytes.extend_from_slice(text.as_bytes());
    fs::write(path, bytes).expect("written");
}

#[test]
fn contract_an_untouched_diagnosis_opens_and_opens_again() {
    let case = Case::new("plain");
    assert!(case.open().is_ok());
    assert!(folder::release_path(&case.key()).exists() && case.corpus().join("opened.json").exists());
    assert!(case.open().is_ok());
}

#[test]
fn contract_a_report_changed_after_the_manifest_is_refused() {
    let case = Case::new("changed");
    append(&case.report(), " ");
    assert!(matches!(case.open(), Err(Refusal::ReportChanged(log)) if log == "00001"));
    assert!(!folder::release_path(&case.key()).exists());
}

#[test]
fn contract_reports_newer_than_the_release_are_refused() {
    let case = Case::new("newer");
    assert!(case.open().is_ok());
    case.diagnose((1 << 33) + 1);
    assert!(matches!(case.open(), Err(Refusal::ReportsNewer { .. })));
    // the copy of the release in the corpus holds where the one beside the key is gone
    fs::remove_file(folder::release_path(&case.key())).expect("removed");
    assert!(matches!(case.open(), Err(Refusal::ReportsNewer { .. })));
}

#[test]
fn contract_a_second_diagnosis_of_an_opened_corpus_is_refused() {
    let case = Case::new("second");
    assert!(case.open().is_ok());
    case.diagnose(199);
    assert!(matches!(case.open(), Err(Refusal::OpenedBefore)));
}

#[test]
fn contract_a_manifest_from_the_future_or_of_another_corpus_is_refused() {
    let case = Case::new("future");
    case.diagnose(u64::MAX);
    assert!(matches!(case.open(), Err(Refusal::ReportsNewer { .. })));
    case.diagnose(200);
    append(&case.corpus().join("corpus.json"), "\n");
    assert!(matches!(case.open(), Err(Refusal::OtherCorpus)));
}

#[test]
fn contract_exchanged_answers_logs_and_keys_are_refused() {
    let case = Case::new("exchanged");
    let published: Published = folder::read_json(&case.corpus().join("corpus.json")).expect("read");
    assert!(folder::check_logs(&case.corpus(), &published).is_ok());
    append(&case.corpus().join("logs/00001.csv"), "1\n");
    assert!(matches!(folder::check_logs(&case.corpus(), &published), Err(Refusal::Corpus(_))));
    fs::write(case.key(), seal::fresh_key().0).expect("written");
    assert!(matches!(case.open(), Err(Refusal::Seal(_))));
    append(&case.corpus().join("answers.age"), "x");
    assert!(matches!(case.open(), Err(Refusal::Corpus(_))));
}

#[test]
fn contract_a_log_without_an_entry_is_refused() {
    let case = Case::new("count");
    let path = case.reports().join("manifest.json");
    let mut manifest: Manifest = folder::read_json(&path).expect("read");
    manifest.reports.clear();
    folder::write_json(&path, &manifest).expect("written");
    assert!(matches!(case.open(), Err(Refusal::ReportCount(_))));
}

#[test]
fn closed_form_what_is_sealed_opens_to_the_same_bytes_with_its_key_alone() {
    let (key, recipient) = seal::fresh_key();
    let sealed = seal::seal(b"answers", &recipient).expect("sealed");
    assert_eq!(seal::open(&sealed, &key).expect("opened"), b"answers");
    assert!(seal::open(&sealed, &seal::fresh_key().0).is_err());
    assert!(seal::open(&sealed, "no key").is_err());
    // FIPS 180-4, the one-block example
    assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}
