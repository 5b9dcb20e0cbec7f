//! The diagnosis of axes of any origin: `axes LOGS FIRST_SEED` simulates as many axes, diagnoses each and prints a table.
//!
//! `cargo run --release -p gimbal-gap --example axes -- 400 0`. One in ten axes has an effect beyond the library, three
//! have none, four have one, two have two; with `none`, `one`, `two`, `beyond` or
//! `swamped` at the end only those are run, with `held` those of one
//! effect, by a library that lacks it. `axes SEED` alone prints one axis and its report.

use std::collections::BTreeMap;

use rayon::prelude::*;

#[path = "../corpus/wilson.rs"]
mod wilson;

#[path = "mod.rs"]
pub mod axes;

use axes::draw::{Group, group};
use axes::score::{Outcome, Scored, scored, without_its_family};
use wilson::percent;

fn main() {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    match numbers[..] {
        [seed] => {
            let Some(one) = scored(seed) else { return eprintln!("no axis of this seed holds its loop") };
            println!("{:#?}\n{}", one.axis, axes::run::model(&one.axis));
            println!("{}\n{}", line(&one), one.report);
            one.sets.iter().for_each(|(set, p)| println!("  {:.1} % {set}", 100.0 * p));
        }
        [count, first] => {
            let kind = |word: String| match word.as_str() {
                "none" => Some(Group::None),
                "one" => Some(Group::One),
                "two" => Some(Group::Two),
                "beyond" => Some(Group::Beyond),
                "swamped" => Some(Group::Swamped),
                _ => None,
            };
            let only = std::env::args().find_map(kind);
            let seeds: Vec<u64> =
                (first..first + count).filter(|seed| only.is_none_or(|only| group(*seed) == only)).collect();
            let all: Vec<Scored> = if std::env::args().any(|word| word == "held") {
                seeds.into_par_iter().filter(|seed| group(*seed) == Group::One).filter_map(without_its_family).collect()
            } else {
                seeds.into_par_iter().filter_map(scored).collect()
            };
            table(&all);
        }
        _ => eprintln!("axes LOGS FIRST_SEED [none|one|two|beyond|swamped], or axes SEED"),
    }
}

/// One axis in one line.
fn line(one: &Scored) -> String {
    let told: Vec<String> = one.told.iter().map(|(name, p)| format!("{name} {:.0} %", 100.0 * p)).collect();
    format!(
        "{} {:?}: {} -> {} ({}; unknown {:.0} %, {:.1} % gone, unseen {:.0} %) {} {} Hz",
        one.seed,
        one.outcome,
        if one.truth.is_empty() { "none".to_owned() } else { one.truth.join(" + ") },
        one.verdict.name(),
        told.join(", "),
        100.0 * one.unknown,
        one.held_out,
        one.unseen.unwrap_or(f64::NAN),
        one.axis.path.course.name(),
        20_000 / one.axis.log_every
    )
}

fn median(mut values: Vec<f64>) -> String {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).map_or("-".to_owned(), |value| format!("{value:.1}"))
}

/// Probabilities told against how often they are right.
fn calibration(all: &[Scored]) {
    println!("\n| probability of an effect | named | right |\n|---|---|---|");
    for (low, high) in [(0.0, 0.2), (0.2, 0.4), (0.4, 0.6), (0.6, 0.8), (0.8, 0.95), (0.95, 1.01)] {
        let told = all.iter().flat_map(|one| one.told.iter().map(move |(name, p)| (one, name, *p)));
        let inside: Vec<bool> = told
            .filter(|(_, _, p)| (low..high).contains(p))
            .map(|(one, name, _)| one.group != Group::Beyond && one.truth.iter().any(|truth| truth == name))
            .collect();
        let right = inside.iter().filter(|right| **right).count();
        println!("| {low:.2} to {:.2} | {} | {} |", f64::min(high, 1.0), inside.len(), percent(right, inside.len()));
    }
}

fn table(all: &[Scored]) {
    let of = |group: Group| all.iter().filter(move |one| one.group == group);
    let ends = |group: Group, outcome: Outcome| of(group).filter(|one| one.outcome == outcome).count();
    println!("| axes | logs | right | in class | with others | one of two | unknown | missed | wrong |");
    println!("|---|---|---|---|---|---|---|---|---|");
    let count = of(Group::None).count();
    println!(
        "| no effect | {count} | {} | - | - | - | - | - | {} |",
        ends(Group::None, Outcome::Quiet),
        ends(Group::None, Outcome::Alarm)
    );
    for (name, group) in [
        ("one effect", Group::One),
        ("two effects", Group::Two),
        ("beyond the library", Group::Beyond),
        ("ripple drives the loop", Group::Swamped),
    ] {
        let kinds = [
            Outcome::Right,
            Outcome::Class,
            Outcome::Extra,
            Outcome::Part,
            Outcome::Unknown,
            Outcome::Missed,
            Outcome::Wrong,
        ];
        let cells: Vec<String> = kinds.iter().map(|kind| ends(group, *kind).to_string()).collect();
        println!("| {name} | {} | {} |", of(group).count(), cells.join(" | "));
    }
    println!("\nFalse alarms: {} of the axes without effect.", percent(ends(Group::None, Outcome::Alarm), count));
    println!(
        "\n| effect | logs | right or in class | parameter within 3 standard errors | gone, held out | gone, other log |"
    );
    println!("|---|---|---|---|---|---|");
    let mut by: BTreeMap<&str, Vec<&Scored>> = BTreeMap::new();
    for one in all.iter().filter(|one| matches!(one.group, Group::One | Group::Beyond)) {
        by.entry(one.truth[0]).or_default().push(one);
    }
    for (name, ones) in by {
        let good = |one: &&&Scored| match one.group {
            Group::Beyond => one.outcome == Outcome::Unknown,
            _ => matches!(one.outcome, Outcome::Right | Outcome::Class),
        };
        let errors: Vec<f64> = ones.iter().flat_map(|one| &one.errors).map(|(_, error)| error.abs()).collect();
        println!(
            "| {name} | {} | {} | {} of {} | {} | {} |",
            ones.len(),
            ones.iter().filter(good).count(),
            errors.iter().filter(|error| **error < 3.0).count(),
            errors.len(),
            median(ones.iter().map(|one| one.held_out).collect()),
            median(ones.iter().filter_map(|one| one.unseen).collect())
        );
    }
    calibration(all);
    println!("\n```text");
    for one in all
        .iter()
        .filter(|one| std::env::var_os("ALL").is_some() || !matches!(one.outcome, Outcome::Quiet | Outcome::Right))
    {
        println!("{}", line(one));
    }
    println!("```");
}
