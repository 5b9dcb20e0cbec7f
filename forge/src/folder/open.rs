//! Opens answers, where reports, manifest and release allow it.

use std::path::Path;

use super::{
    Answers, Manifest, Published, Refusal, Release, modified_unix_s, read, read_json, release_path, write_json,
};
use crate::freeze;
use crate::seal::{self, sha256};

/// Opens the answers, if reports, manifest and release allow it, and records the release.
///
/// # Errors
/// A [`Refusal`], before anything is opened.
pub fn open_answers(
    corpus: &Path,
    reports: &Path,
    key: &Path,
    now_unix_s: u64,
) -> Result<(Answers, Manifest), Refusal> {
    let published_bytes = read(&corpus.join("corpus.json"))?;
    let published: Published = read_json(&corpus.join("corpus.json"))?;
    let manifest_path = reports.join("manifest.json");
    let manifest_bytes = read(&manifest_path)?;
    let manifest: Manifest = read_json(&manifest_path)?;
    let corpus_sha256 = sha256(&published_bytes);
    if manifest.corpus_sha256 != corpus_sha256 {
        return Err(Refusal::OtherCorpus);
    }
    let newest = check_reports(&published, &manifest, reports)?;
    let freeze = freeze::of_corpus(corpus, &published)?;
    if let Some(freeze) = &freeze {
        freeze.check_order(&published, &manifest)?;
    }
    let sealed = read(&corpus.join("answers.age"))?;
    if sha256(&sealed) != published.sealed_sha256 {
        return Err(Refusal::Corpus("answers.age".to_owned()));
    }
    let key_text = read(key)?;
    let release = Release { released_unix_s: now_unix_s, manifest_sha256: sha256(&manifest_bytes), corpus_sha256 };
    let records = [release_path(key), corpus.join("opened.json")];
    for record in &records {
        if !record.exists() {
            continue;
        }
        let before: Release = read_json(record)?;
        let same_manifest = before.manifest_sha256 == release.manifest_sha256;
        if before.corpus_sha256 != release.corpus_sha256 || same_manifest {
            continue;
        }
        let reports_unix_s = manifest.span_unix_s.1.max(newest);
        if reports_unix_s > before.released_unix_s {
            return Err(Refusal::ReportsNewer { reports_unix_s, released_unix_s: before.released_unix_s });
        }
        return Err(Refusal::OpenedBefore);
    }
    if manifest.span_unix_s.1 > now_unix_s {
        return Err(Refusal::ReportsNewer { reports_unix_s: manifest.span_unix_s.1, released_unix_s: now_unix_s });
    }
    // the release is on record before anything is opened
    for record in &records {
        if !record.exists() {
            write_json(record, &release)?;
        }
    }
    let plain = seal::open(&sealed, &String::from_utf8_lossy(&key_text))?;
    if sha256(&plain) != published.answers_sha256 {
        return Err(Refusal::Corpus("the answers inside answers.age".to_owned()));
    }
    let answers: Answers =
        serde_json::from_slice(&plain).map_err(|why| Refusal::file(&corpus.join("answers.age"), why))?;
    if let (Some(freeze), Some(sha256)) = (&freeze, &published.freeze_sha256) {
        freeze.check_seed(sha256, &answers)?;
    }
    Ok((answers, manifest))
}

/// The answers of a development set, whose reports may be made again and again.
///
/// # Errors
/// A file is missing or not the one that was published, or the manifest belongs to another corpus.
pub fn development_answers(corpus: &Path, reports: &Path) -> Result<(Answers, Manifest), Refusal> {
    let published_path = corpus.join("corpus.json");
    let published: Published = read_json(&published_path)?;
    let manifest: Manifest = read_json(&reports.join("manifest.json"))?;
    if manifest.corpus_sha256 != sha256(&read(&published_path)?) {
        return Err(Refusal::OtherCorpus);
    }
    check_reports(&published, &manifest, reports)?;
    let path = corpus.join("answers.json");
    let plain = read(&path)?;
    if sha256(&plain) != published.answers_sha256 {
        return Err(Refusal::Corpus("answers.json".to_owned()));
    }
    let answers = serde_json::from_slice(&plain).map_err(|why| Refusal::file(&path, why))?;
    Ok((answers, manifest))
}

/// Every log has one entry, every entry its report; gives the newest report's time.
fn check_reports(published: &Published, manifest: &Manifest, reports: &Path) -> Result<u64, Refusal> {
    let mut logs: Vec<&str> = published.files.keys().filter_map(|name| name.strip_suffix(".csv")).collect();
    for entry in &manifest.reports {
        let Some(place) = logs.iter().position(|log| *log == entry.log) else {
            return Err(Refusal::ReportCount(entry.log.clone()));
        };
        logs.swap_remove(place);
    }
    if let Some(missing) = logs.first() {
        return Err(Refusal::ReportCount((*missing).to_owned()));
    }
    let mut newest = 0;
    for entry in &manifest.reports {
        let path = reports.join(&entry.log).join("gap.json");
        match &entry.sha256 {
            Some(hash) => {
                if sha256(&read(&path)?) != *hash {
                    return Err(Refusal::ReportChanged(entry.log.clone()));
                }
                newest = newest.max(modified_unix_s(&path));
            }
            None if path.exists() => return Err(Refusal::ReportChanged(entry.log.clone())),
            None => {}
        }
    }
    Ok(newest)
}

/// The answers of an opened corpus with the reports that the manifest holds.
///
/// A report that does not have its form counts as a failed diagnosis.
///
/// # Errors
/// A report cannot be read.
pub fn judged(answers: Answers, manifest: &Manifest, reports: &Path) -> Result<Vec<crate::score::Judged>, Refusal> {
    let mut all = Vec::with_capacity(answers.answers.len());
    for answer in answers.answers {
        let entry = manifest
            .reports
            .iter()
            .find(|entry| entry.log == answer.log)
            .ok_or_else(|| Refusal::ReportCount(answer.log.clone()))?;
        let report = match entry.sha256 {
            None => None,
            Some(_) => crate::score::report::Report::parse(&read(&reports.join(&entry.log).join("gap.json"))?).ok(),
        };
        all.push(crate::score::judge::judge(answer, report, entry.seconds));
    }
    Ok(all)
}
