//! The score as Markdown, HTML and JSON.

use std::fmt::Write;

use super::gates::Gate;
use super::picture;
use super::tally::{Group, Score};

/// What stands at the head of a page.
#[derive(Debug, Clone, Default, serde::Serialize)]
pub struct Head {
    /// Name of the corpus.
    pub corpus: String,
    /// SHA-256 of `corpus.json`.
    pub corpus_sha256: String,
    /// SHA-256 of the manifest.
    pub manifest_sha256: String,
    /// SHA-256 of the program that diagnosed.
    pub program_sha256: String,
    /// Commit of that program; none for a check or a development set.
    pub commit: Option<String>,
    /// SHA-256 of the record of the diagnosis that the seed was drawn after.
    pub freeze_sha256: Option<String>,
    /// When that record was made [s since 1970].
    pub frozen_unix_s: Option<u64>,
    /// Seed of the corpus in hexadecimal digits.
    pub seed: String,
    /// Least and largest length of a log [s].
    pub length_s: (f64, f64),
    /// Shares of nothing, one, two, three and beyond [percent].
    pub shares: [usize; 5],
    /// When the diagnosis was finished [s since 1970].
    pub diagnosed_unix_s: u64,
    /// When the answers were opened [s since 1970]; none for a development set, whose answers are open from the start.
    pub opened_unix_s: Option<u64>,
}

fn cell_of(gate: &Gate) -> [String; 4] {
    let kept = match gate.kept() {
        None => "no case",
        Some(true) => "kept",
        Some(false) => "missed",
    };
    [gate.what.clone(), gate.text.clone(), gate.limit_text(), kept.to_owned()]
}

fn single_figures(score: &Score) -> Vec<[String; 2]> {
    let percent = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{:.1} %", 100.0 * value));
    let calibration = |of: &super::calibration::Calibration| {
        format!("{:.3} ({:.3}-{:.3}), {} cases", of.error, of.interval.0, of.interval.1, of.count)
    };
    let mut figures: Vec<[String; 2]> = [
        ("logs; diagnosis failed", format!("{}; {}", score.logs, score.failed)),
        ("mean probability on the truth, single effects that count", format!("{:.3}", score.mean_on_truth)),
        ("log score, mean of -ln p", format!("{:.3}", score.log_score)),
        ("calibration error of verdicts", calibration(&score.verdicts)),
        ("calibration error of effects", calibration(&score.effects)),
        ("shrink intervals that hold the best possible", score.shrink_coverage.text()),
        ("median share of the closable gap closed", percent(score.median_closed)),
        ("unknown effects flagged, all sizes and motions", score.unknown_flagged.text()),
        ("unknown effects flagged at 5 % false unknown", score.unknown_at_5_percent.text()),
        (
            "unknown against known, area under the curve",
            score.unknown_auroc.map_or("-".to_owned(), |v| format!("{v:.3}")),
        ),
        ("cannot tell, truth in the class", score.cannot_tell_holds_truth.text()),
        ("cannot tell, and the forge cannot either", score.cannot_tell_fair.text()),
        ("time of a diagnosis, mean and largest [s]", format!("{:.1}, {:.1}", score.seconds.0, score.seconds.1)),
    ]
    .map(|(name, value)| [name.to_owned(), value])
    .to_vec();
    for (percent, right, error) in &score.mixtures {
        figures.push([
            format!("verdicts right and calibration error at the mixture {percent:?} %"),
            format!("{:.1} %, {error:.3}", 100.0 * right),
        ]);
    }
    figures
}

fn group_row(group: &Group) -> [String; 9] {
    [
        group.name.clone(),
        group.detected.text(),
        group.top1.text(),
        group.top3.text(),
        group.exact.text(),
        group.right.text(),
        format!("{:.2}", group.on_truth),
        group.gate_top1.text(),
        group.gate_right.text(),
    ]
}

const GROUP_HEAD: [&str; 9] = [
    "",
    "gap reported",
    "top-1",
    "top-3",
    "exact set",
    "verdict right",
    "mean p on truth",
    "top-1, counted by the gates",
    "verdict right, counted by the gates",
];

/// A table that Markdown and HTML share.
struct Table {
    title: String,
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

fn tables(score: &Score) -> Vec<Table> {
    let table = |title: &str, head: &[&str], rows: Vec<Vec<String>>| Table {
        title: title.to_owned(),
        head: head.iter().map(|name| (*name).to_owned()).collect(),
        rows,
    };
    let groups = |title: &str, groups: &[Group]| {
        table(title, &GROUP_HEAD, groups.iter().map(|group| group_row(group).to_vec()).collect())
    };
    vec![
        table(
            "Gates",
            &["what", "value and 95 % interval", "limit", ""],
            score.gates.iter().map(|gate| cell_of(gate).to_vec()).collect(),
        ),
        table("Figures", &["what", "value"], single_figures(score).iter().map(|row| row.to_vec()).collect()),
        groups("By what was put in", &score.by_kind),
        groups("By excitation", &score.by_excitation),
        groups("By size over the detectable one, single effects", &score.by_size),
        groups("By effect, single and unknown ones", &score.by_effect),
        table(
            "95 % intervals of parameters that hold the truth",
            &["effect", "rate"],
            score.coverage_by_effect.iter().map(|(name, rate)| vec![name.clone(), rate.text()]).collect(),
        ),
        table(
            "Families and motions left out of a recalibration, mean of -ln p of the verdicts' outcomes",
            &["left out", "logs", "as reported", "recalibrated with it", "without it", "cost"],
            score
                .held_out
                .iter()
                .map(|row| {
                    let mut cells = vec![row.name.clone(), row.logs.to_string()];
                    let figures = [row.reported, row.with, row.without, row.without - row.with];
                    cells.extend(figures.map(|value| format!("{value:.3}")));
                    cells
                })
                .collect(),
        ),
        table(
            "Taken for another",
            &["truth", "likeliest name", "logs"],
            score
                .confusion
                .iter()
                .filter(|(truth, named, _)| truth != named)
                .map(|(truth, named, count)| vec![truth.clone(), named.clone(), count.to_string()])
                .collect(),
        ),
    ]
}

fn head_lines(head: &Head) -> Vec<String> {
    let mut lines = vec![format!(
        "Corpus `{}`: logs of {:.0} to {:.0} s, {:?} % nothing, one, two, three effects and one beyond the table. SHA-256 \
         of its hashes `{}`, seed `{}`.",
        head.corpus, head.length_s.0, head.length_s.1, head.shares, head.corpus_sha256, head.seed
    )];
    match (&head.commit, &head.freeze_sha256, head.frozen_unix_s) {
        (Some(commit), Some(record), Some(time)) => lines.push(format!(
            "Diagnosis of commit `{commit}`, program `{}`, recorded {} as `{record}`; the seed was drawn after that.",
            head.program_sha256,
            date(time)
        )),
        _ => lines.push(format!("Program `{}`. The seed was known: a check, no blind score.", head.program_sha256)),
    }
    lines.push(format!("Diagnosed {}, manifest `{}`.", date(head.diagnosed_unix_s), head.manifest_sha256));
    lines.push(match head.opened_unix_s {
        Some(opened) => format!("Opened {}. Intervals behind rates are Wilson's, 95 %.", date(opened)),
        None => "A development set: its answers were open before the diagnosis.".to_owned(),
    });
    lines
}

/// The row of a corpus in the table of all that were opened.
#[must_use]
pub fn row(head: &Head, score: &Score) -> String {
    let minute = |unix_s: u64| date(unix_s).replace(" UTC", "");
    let gate = |place: usize| score.gates.get(place).map_or_else(String::new, |gate| gate.text.clone());
    let commit = head.commit.as_deref().unwrap_or("-");
    let cells = [
        format!("[{0}](blind/{0}/score.md)", head.corpus),
        score.logs.to_string(),
        minute(head.diagnosed_unix_s),
        commit.chars().take(7).collect(),
        head.corpus_sha256.chars().take(12).collect(),
        format!("{:?}", head.shares).replace(['[', ']'], "").replace(", ", "/"),
        gate(0),
        gate(1),
        gate(2),
        gate(3),
        gate(4),
        gate(5),
        gate(6),
    ];
    format!("| {} |", cells.join(" | "))
}

/// A date and time from seconds since 1970, UTC.
#[must_use]
pub fn date(unix_s: u64) -> String {
    let (days, second) = (unix_s / 86_400, unix_s % 86_400);
    // days since 0000-03-01, whole 400-year cycles first (Gregorian)
    let shifted = days + 719_468;
    let (era, day_of_era) = (shifted / 146_097, shifted % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02} UTC", second / 3600, second / 60 % 60)
}

/// The page as Markdown.
#[must_use]
pub fn markdown(head: &Head, score: &Score) -> String {
    let mut text = format!("# Blind score: {}\n\n{}\n", head.corpus, head_lines(head).join("\n"));
    for table in tables(score) {
        let _ = write!(
            text,
            "\n## {}\n\n| {} |\n|{}\n",
            table.title,
            table.head.join(" | "),
            "---|".repeat(table.head.len())
        );
        for row in &table.rows {
            let _ = writeln!(text, "| {} |", row.join(" | "));
        }
    }
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:72rem;padding:0 1rem;\
color:#1b1f24;background:#fff}table{border-collapse:collapse;margin:.6rem 0}td{white-space:nowrap}td,th{padding:.2rem .7rem;border-bottom:\
1px solid #d5dae0;text-align:left;font-variant-numeric:tabular-nums}svg text{font-size:11px;fill:currentColor}.frame{\
fill:none;stroke:#8a929c}.ideal{stroke:#8a929c;stroke-dasharray:4 4}.dot{fill:#1f6feb}.hit{fill:#1f6feb}.miss{fill:\
#c2410c}.wide{overflow-x:auto}@media(prefers-color-scheme:dark){body{color:#e3e6ea;background:#14171a}td,th{\
border-color:#343a41}}";

/// The page as HTML with inline pictures; no network, no scripts.
#[must_use]
pub fn html(head: &Head, score: &Score) -> String {
    let mut text = format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>Blind score: {0}</title><style>{STYLE}</style></head><body><h1>Blind score: \
         {0}</h1>",
        escaped(&head.corpus)
    );
    for line in head_lines(head) {
        let _ = write!(text, "<p>{}</p>", escaped(&line.replace('`', "")));
    }
    for table in tables(score) {
        let _ = write!(text, "<h2>{}</h2><div class=\"wide\"><table><tr>", escaped(&table.title));
        for name in &table.head {
            let _ = write!(text, "<th>{}</th>", escaped(name));
        }
        text.push_str("</tr>");
        for row in &table.rows {
            text.push_str("<tr>");
            for cell in row {
                let _ = write!(text, "<td>{}</td>", escaped(cell));
            }
            text.push_str("</tr>");
        }
        text.push_str("</table></div>");
    }
    let _ = writeln!(
        text,
        "<h2>Probabilities against outcomes</h2><div class=\"wide\">{}{}</div><h2>Confusion between \
         effects</h2><p>Rows: the truth. Columns: the likeliest name. Shade: share of the row.</p><div \
         class=\"wide\">{}</div></body></html>",
        picture::reliability("verdicts", &score.verdicts),
        picture::reliability("effects", &score.effects),
        picture::confusion(&score.confusion)
    );
    text
}
