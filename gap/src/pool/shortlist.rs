//! Which sets are fitted to all logs: what every log's own search speaks for, every effect that all logs together
//! promise something of, and the best of these with one more.

use gimbal_model_file::Tolerance;

use super::climb::{Fitted, climb};
use super::extend::{Promise, library, promises};
use super::material::Material;
use super::set::Effects;
use super::sharing::fitted;
use super::weigh::weigh;
use crate::diagnose::Diagnosis;
use crate::fit::{Point, Tried};

/// Sets of the logs' own searches, effects by themselves, extensions of the best.
const OWN_SETS: usize = 6;
const SINGLES: usize = 4;
const EXTENSIONS: usize = 3;
/// Least probability that a log gives a set that it asks the others about.
const PROBABLE: f64 = 0.05;

/// All that was fitted.
pub(super) struct Found {
    pub(super) null: Fitted,
    pub(super) fits: Vec<Fitted>,
    /// Every effect by itself, by linear equations.
    pub(super) promises: Vec<Promise>,
}

/// Fits the nominal parameters alone, then set after set.
pub(super) fn found(
    materials: &mut [Material],
    diagnoses: &[Diagnosis],
    tolerance: &Tolerance,
    mut step: impl FnMut(),
) -> Option<Found> {
    let null = nominal(materials)?;
    step();
    let library = library(materials);
    let singles = promises(materials, &null, &library);
    step();
    let mut fits: Vec<Fitted> = Vec::new();
    for tried in own_sets(materials, diagnoses) {
        try_set(materials, &null, &tried, &mut fits);
        step();
    }
    for promise in singles.iter().filter(|promise| promise.is_enough()).take(SINGLES) {
        extend(materials, &null, promise, &mut fits);
        step();
    }
    // the best with one more, and once more where that is better
    for size in 1..3 {
        let weighed = weigh(materials, &null, &fits, &[], tolerance);
        let worth = |index: &usize| weighed[*index].nats - weighed[*index].cost;
        let best = (0..fits.len()).max_by(|a, b| worth(a).total_cmp(&worth(b)));
        let Some(best) = best.filter(|&index| fits[index].effects.names.len() == size) else { break };
        if worth(&best) < 0.0 {
            break;
        }
        let from = fits[best].clone();
        for promise in
            promises(materials, &from, &library).iter().filter(|promise| promise.is_enough()).take(EXTENSIONS)
        {
            extend(materials, &from, promise, &mut fits);
            step();
        }
    }
    let null = from_there(materials, null, &fits);
    Some(Found { null, fits, promises: singles })
}

/// The best fit may have found a way down that the nominal parameters missed: they start there once more.
fn from_there(materials: &[Material], null: Fitted, fits: &[Fitted]) -> Fitted {
    let Some(best) = fits.iter().max_by(|a, b| a.worth().total_cmp(&b.worth())) else { return null };
    let without = |point: &Point| Point { values: Vec::new(), ..point.clone() };
    let starts = vec![best.points.iter().map(without).collect()];
    match climb(materials, &null.effects, &null.own, starts) {
        Some(again) if again.worth() > null.worth() => again,
        _ => null,
    }
}

/// The nominal parameters alone, from the middle of what the logs found each by itself.
fn nominal(materials: &[Material]) -> Option<Fitted> {
    let alone: Vec<&Tried> = materials.iter().filter_map(|material| material.asked.tried.first()).collect();
    let count = alone.first()?.shifts.len();
    let mean = |place: usize| alone.iter().map(|own| own.shifts[place]).sum::<f64>() / alone.len() as f64;
    let shifts: Vec<f64> = (0..count).map(mean).collect();
    let point = |own: &&Tried| Point { values: Vec::new(), shifts: shifts.clone(), state: own.state.clone() };
    let apart = |own: &&Tried| Point { values: Vec::new(), shifts: own.shifts.clone(), state: own.state.clone() };
    let effects = Effects::none(materials.len());
    fitted(materials, &effects, vec![alone.iter().map(point).collect()], &[alone.iter().map(apart).collect()])
}

/// What the logs' own searches speak for, the largest sum of their probabilities first, with all parts of it.
fn own_sets(materials: &[Material], diagnoses: &[Diagnosis]) -> Vec<Tried> {
    let mut sums: Vec<(Vec<&'static str>, f64)> = Vec::new();
    for material in materials {
        let Some(decision) = &diagnoses[material.log].decision else { continue };
        for set in decision.ranking.iter().filter(|set| set.probability > PROBABLE) {
            let mut names = set.effects.clone();
            names.retain(|name| !crate::judge::READ_OFF.contains(name));
            match sums.iter_mut().find(|(other, _)| *other == names) {
                Some((_, sum)) => *sum += set.probability,
                None => sums.push((names, set.probability)),
            }
        }
    }
    sums.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut wanted: Vec<Vec<&'static str>> = Vec::new();
    for (names, _) in sums.into_iter().take(OWN_SETS) {
        let parts = names.iter().map(|name| vec![*name]).chain([names.clone()]);
        for part in parts.filter(|part| !part.is_empty()) {
            if !wanted.contains(&part) {
                wanted.push(part);
            }
        }
    }
    wanted.sort_by_key(Vec::len);
    wanted.iter().filter_map(|names| clearest(materials, names)).collect()
}

/// The fit of a set in the log that gained most from it.
fn clearest(materials: &[Material], names: &[&'static str]) -> Option<Tried> {
    let of = |material: &Material| {
        let null = material.asked.tried.first()?.square;
        let own = material.asked.tried.iter().find(|tried| tried.effects() == names)?;
        Some((null - own.square, own.clone()))
    };
    materials.iter().filter_map(of).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, own)| own)
}

/// Fits a set that a log's own search found.
fn try_set(materials: &mut [Material], null: &Fitted, tried: &Tried, fits: &mut Vec<Fitted>) {
    let effects = Effects::new(materials, &tried.candidates, &tried.values, Some(tried.shifts.clone()));
    add(materials, null, &effects, fits);
}

/// Fits a set with one effect more.
fn extend(materials: &mut [Material], from: &Fitted, promise: &Promise, fits: &mut Vec<Fitted>) {
    let candidates = from.effects.sets[0].0.iter().map(|&index| materials[0].problem.candidates[index].clone());
    let candidates: Vec<_> = candidates.chain([promise.candidate.clone()]).collect();
    let values: Vec<Vec<f64>> = from.points[0].values.iter().chain([&promise.values]).cloned().collect();
    let mut effects = Effects::new(materials, &candidates, &values, None);
    // what the search cost stays
    for (name, nats) in from.effects.names.iter().zip(&from.effects.search) {
        if let Some(place) = effects.names.iter().position(|other| other == name) {
            effects.search[place] = *nats;
        }
    }
    add(materials, from, &effects, fits);
}

/// Fits a set unless it was fitted.
fn add(materials: &[Material], from: &Fitted, effects: &Effects, fits: &mut Vec<Fitted>) {
    if fits.iter().any(|other| other.effects.names == effects.names) {
        return;
    }
    let begun = |shifts: &dyn Fn(&Point) -> Vec<f64>| -> Vec<Point> {
        let point =
            |point: &Point| Point { values: effects.start.clone(), shifts: shifts(point), state: point.state.clone() };
        from.points.iter().map(point).collect()
    };
    let first = from.points[0].shifts.clone();
    let mut starts = vec![begun(&|_| first.clone())];
    starts.extend(effects.shifts.clone().map(|shifts| begun(&|_| shifts.clone())));
    let apart: Option<Vec<Point>> =
        materials.iter().zip(&from.points).map(|(material, at)| own(material, effects, at)).collect();
    let apart: Vec<Vec<Point>> = apart.into_iter().collect();
    fits.extend(fitted(materials, effects, starts, &apart));
}

/// Where a log's own search had a set, the nominal parameters as they are elsewhere.
fn own(material: &Material, effects: &Effects, at: &Point) -> Option<Point> {
    let tried = material.asked.tried.iter().find(|tried| tried.effects() == effects.names)?;
    let mut order: Vec<usize> = (0..tried.candidates.len()).collect();
    order.sort_by_key(|&place| tried.candidates[place].effect);
    let mut point = Point {
        values: order.iter().map(|&p| tried.values[p].clone()).collect(),
        shifts: at.shifts.clone(),
        state: at.state.clone(),
    };
    for release in tried.candidates.iter().flat_map(|candidate| candidate.releases) {
        if let Some(place) = material.problem.nuisance(release) {
            point.shifts[place] = tried.shifts[place];
        }
    }
    Some(point)
}
