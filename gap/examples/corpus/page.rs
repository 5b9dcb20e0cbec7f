//! The page of the table.

use std::fmt::Write;

use gimbal_plant::Effect;

use crate::corpus::Excitation;
use crate::outcome::{Named, Outcome};
use crate::wilson;

/// Overlap over union that is asked for.
const OVERLAP: f64 = 0.7;

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Names by which logs were called that hold something else, the most frequent first.
fn others(own: &[&Outcome], effect: &str) -> String {
    let mut counts: Vec<(String, usize)> = Vec::new();
    let wrong = own.iter().filter(|outcome| matches!(outcome.named, Named::Wrong | Named::Beside | Named::CannotTell));
    for name in wrong.flat_map(|outcome| outcome.found.iter()).filter(|name| **name != effect) {
        match counts.iter_mut().find(|(other, _)| other == name) {
            Some((_, count)) => *count += 1,
            None => counts.push(((*name).to_owned(), 1)),
        }
    }
    counts.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let each: Vec<String> = counts.iter().map(|(name, count)| format!("`{name}` {count}")).collect();
    each.join(", ")
}

fn counted(own: &[&Outcome], named: Named) -> String {
    let count = own.iter().filter(|outcome| outcome.named == named).count();
    if count == 0 { String::new() } else { count.to_string() }
}

fn cells(own: &[&Outcome]) -> Vec<String> {
    let mut cells: Vec<String> = Named::ALL.iter().map(|(named, _)| counted(own, *named)).collect();
    let blocks = own.iter().filter(|outcome| outcome.block).count();
    cells.push(format!("{blocks}"));
    let overlaps: Vec<f64> = own.iter().filter_map(|outcome| outcome.overlap).collect();
    cells.push(median(overlaps).map_or(String::new(), |overlap| format!("{overlap:.2}")));
    let (within, all) = own.iter().fold((0, 0), |sum, outcome| (sum.0 + outcome.covered.0, sum.1 + outcome.covered.1));
    cells.push(if all == 0 { String::new() } else { format!("{within} of {all}") });
    let closed: Vec<f64> = own.iter().filter_map(|outcome| outcome.closed_percent).collect();
    cells.push(median(closed).map_or(String::new(), |percent| format!("{percent:.1}")));
    let marked = own.iter().filter(|outcome| outcome.marked).count();
    cells.push(if marked == 0 { String::new() } else { format!("{marked}") });
    cells
}

fn summary(out: &mut String, outcomes: &[Outcome]) {
    let _ = writeln!(
        out,
        "| logs | effect named, of those that the plant shows | or in its class | wrong name | block | parameters within 3 standard errors | spans over {OVERLAP} | gap closed, median | not marked and not seen |"
    );
    let _ = writeln!(out, "|---|---|---|---|---|---|---|---|---|");
    let mut line = |name: &str, of: &dyn Fn(&Outcome) -> bool| {
        let own: Vec<&Outcome> =
            outcomes.iter().filter(|outcome| of(outcome) && outcome.truth.smallest.is_some()).collect();
        let count = |is: &dyn Fn(&Outcome) -> bool| own.iter().filter(|outcome| is(outcome)).count();
        let all = own.len();
        let (within, values) =
            own.iter().fold((0, 0), |sum, outcome| (sum.0 + outcome.covered.0, sum.1 + outcome.covered.1));
        let spans: Vec<f64> = own.iter().filter_map(|outcome| outcome.overlap).collect();
        let closed = median(own.iter().filter_map(|outcome| outcome.closed_percent).collect());
        let _ = writeln!(
            out,
            "| {name}, {all} | {} | {} | {} | {} | {} | {} | {} | {} |",
            wilson::percent(count(&|outcome| outcome.named == Named::Right), all),
            wilson::percent(count(&|outcome| matches!(outcome.named, Named::Right | Named::Class)), all),
            wilson::percent(count(&|outcome| matches!(outcome.named, Named::Wrong | Named::Beside)), all),
            wilson::percent(count(&|outcome| outcome.block), all),
            wilson::percent(within, values),
            wilson::percent(spans.iter().filter(|share| **share >= OVERLAP).count(), spans.len()),
            closed.map_or("-".to_owned(), |percent| format!("{percent:.1} %")),
            count(&|outcome| outcome.named == Named::NotSeen && !outcome.marked),
        );
    };
    line("all", &|_| true);
    for excitation in Excitation::ALL {
        line(excitation.name(), &|outcome| outcome.truth.excitation == excitation);
    }
    let multiple = |outcome: &Outcome| outcome.truth.smallest.map_or(0.0, |least| outcome.truth.size / least);
    line("1 to 2 times the smallest", &|outcome| multiple(outcome) < 2.0);
    line("2 to 4 times", &|outcome| (2.0..4.0).contains(&multiple(outcome)));
    line("4 to 10 times", &|outcome| multiple(outcome) >= 4.0);
    line("marked by the report", &|outcome| outcome.marked);
    line("not marked", &|outcome| !outcome.marked);
}

/// Markdown.
pub(crate) fn page(outcomes: &[Outcome], effects: &[Effect], logs: u64, seconds: f64, first: u64) -> String {
    let mut out = format!(
        "# Every effect under every excitation\n\n\
         `cargo run --release -p gimbal-gap --example table -- {logs} {seconds} {first} > docs/gap-table.md` prints this page.\n\n\
         Logs of {seconds} s at 1 kHz, {logs} for each effect and excitation, seeds from {first} on. Sizes are log-uniform from 1 to 10 times the\n\
         smallest that the log can show (d = 5: from the plant with and without the effect, over the noise, after every nominal\n\
         parameter has taken from it what it can inside its tolerance; `gap/examples/corpus/detectable.rs`). Nominal parameters are off by\n\
         up to 3 %, friction by up to 15 %. Noise: pick-off 2e-6 rad rms through 16 bit over +-10 mrad, torque 1e-5 N m, acceleration\n\
         0.01 m/s2, rates 2e-4 rad/s. Columns of the log: those of the contract without `gimbal_angle_rad` and `relative_angle_rad`.\n\n\
         ## Together\n\n\
         Shares in percent with 95 % intervals (Wilson). *Marked*: the report's `detectable` says that this log cannot show the effect,\n\
         or only at a larger size.\n\n"
    );
    summary(&mut out, outcomes);
    out.push_str(
        "\n## One by one\n\n\
         *smallest*: median of the sizes with d = 5; *none*: the realistic range of the effect ends before, and its end was put in.\n\
         *right*: the effect alone is named; *class*: it is one of those that are said not to be told apart; *beside*: another is named with\n\
         it; *cannot tell*: a class without it, or data refused; *unknown*: a gap that nothing explains; *not seen*: `no_gap`. *block*: logs\n\
         in which the effect's block has the largest share of the gap. *overlap*: median overlap over union of spans, of logs where the effect stands out for 5 to 80 %\n\
         of the time and is named. *within*: parameters within three of their standard errors, where it is named. *closed*: median share of the gap that is\n\
         closed on held-out data [%]. *marked*: logs in which the report itself says that the effect cannot be seen here at that size.\n",
    );
    for excitation in Excitation::ALL {
        let names: Vec<&str> = Named::ALL.iter().map(|(_, name)| *name).collect();
        let _ = writeln!(out, "\n### {}\n", excitation.name());
        let _ = writeln!(
            out,
            "| effect | smallest | {} | block | overlap | within | closed | marked | named instead or beside |",
            names.join(" | ")
        );
        let _ = writeln!(out, "|{}", "---|".repeat(names.len() + 8));
        for effect in effects {
            let own: Vec<&Outcome> = outcomes
                .iter()
                .filter(|outcome| outcome.truth.effect == *effect && outcome.truth.excitation == excitation)
                .collect();
            let smallest = median(own.iter().filter_map(|outcome| outcome.truth.smallest).collect());
            let none = own.iter().filter(|outcome| outcome.truth.smallest.is_none()).count();
            let unit = match effect.parameters()[0].unit {
                "1" => "",
                _ if effect.name() == "torque_saturation" => "of the peak",
                unit => unit,
            };
            let mut smallest = smallest.map_or(String::new(), |size| format!("{size:.1e} {unit}"));
            if none > 0 {
                let _ = write!(smallest, "{}none in {none}", if smallest.is_empty() { "" } else { ", " });
            }
            let _ = writeln!(
                out,
                "| `{}` | {smallest} | {} | {} |",
                effect.name(),
                cells(&own).join(" | "),
                others(&own, effect.name())
            );
        }
    }
    out
}
