//! Axes of any origin, a few of those that `gap/examples/axes` draws: what has no effect is quiet, what has one is named.

#[path = "../../examples/axes/mod.rs"]
mod axes;

use axes::draw::{Group, axis, group};
use axes::effect::Kind;
use axes::score::{Outcome, Scored, scored};
use rayon::prelude::*;

/// The first axes of a kind from a seed on.
fn some(kind: Group, count: usize) -> Vec<Scored> {
    let seeds: Vec<u64> = (0..4000).filter(|seed| group(*seed) == kind).take(count).collect();
    seeds.into_par_iter().filter_map(scored).collect()
}

fn told(all: &[Scored]) -> String {
    let lines: Vec<String> =
        all.iter().map(|one| format!("{} {:?} {:?} {:?}", one.seed, one.outcome, one.truth, one.told)).collect();
    lines.join("\n")
}

#[test]
fn cross_axes_of_any_origin_without_effect_are_quiet() {
    let all = some(Group::None, 12);
    assert!(all.len() >= 10);
    assert!(all.iter().all(|one| one.outcome == Outcome::Quiet), "{}", told(&all));
}

#[test]
fn cross_effects_of_axes_of_any_origin_are_named_or_in_a_class() {
    let all = some(Group::One, 16);
    let named = all.iter().filter(|one| matches!(one.outcome, Outcome::Right | Outcome::Class)).count();
    // four in five on the seeds that it was developed on
    assert!(named * 10 >= all.len() * 7, "{}", told(&all));
}

#[test]
fn cross_masses_on_springs_are_named() {
    let flexible = |seed: &u64| group(*seed) == Group::One && axis(*seed, 0).terms[0].kind == Kind::Flexible;
    let seeds: Vec<u64> = (0..4000).filter(flexible).take(6).collect();
    let all: Vec<Scored> = seeds.into_par_iter().filter_map(scored).collect();
    let named = all.iter().filter(|one| one.outcome == Outcome::Right).count();
    assert!(all.len() >= 5 && named * 4 >= all.len() * 3, "{}", told(&all));
}

#[test]
fn cross_a_ripple_that_drives_its_loop_is_not_friction() {
    let all = some(Group::Swamped, 6);
    let named = all.iter().filter(|one| one.outcome == Outcome::Right).count();
    assert!(named * 3 >= all.len() * 2, "{}", told(&all));
}
