//! The effects of a log, drawn and sized, and what its answer says of them.

use super::bench::Bench;
use super::drift::Drift;
use super::setting::{Columns, Setting};
use super::{AnswerEffect, Kind};
use crate::detect::{DETECTABLE, Projection};
use crate::draw::Draw;
use crate::effects::{BEYOND, Effect, World, library_names};

/// How often effects are drawn for one log before it is drawn anew.
const TRIES: usize = 40;

fn names_for(kind: Kind, columns: Columns) -> Vec<&'static str> {
    if kind == Kind::Beyond {
        return BEYOND.to_vec();
    }
    // without the rate about x nobody can see what it does
    library_names().filter(|name| columns.cross || *name != "cross_axis_coupling").collect()
}

/// Draws effects until all of them can have their size; none where a log has to be drawn anew.
pub(super) fn choose(
    kind: Kind,
    setting: &Setting,
    bench_of: &dyn Fn(&[&str]) -> (World, Drift),
    multiples: (f64, f64),
    draw: &mut Draw,
) -> Option<(World, Drift, Vec<AnswerEffect>)> {
    let names = names_for(kind, setting.columns);
    for _ in 0..TRIES {
        let mut drawn: Vec<&'static str> = Vec::new();
        while drawn.len() < kind.effects() {
            let name = draw.pick(&names);
            if !drawn.contains(&name) {
                drawn.push(name);
            }
        }
        let (base, drift) = bench_of(&drawn);
        let bench = Bench::new(
            &setting.scene,
            &base,
            &setting.nominal,
            &drift,
            &setting.noise,
            &setting.columns.channels(),
            &mut draw.fork(),
        );
        if let Some((world, answers)) = size_all(&bench, &drawn, multiples, draw) {
            return Some((world, drift, answers));
        }
    }
    None
}

fn size_all(
    bench: &Bench<'_>,
    drawn: &[&'static str],
    multiples: (f64, f64),
    draw: &mut Draw,
) -> Option<(World, Vec<AnswerEffect>)> {
    let projection = bench.projection();
    let mut world = bench.base.clone();
    let mut effects = Vec::new();
    for name in drawn {
        let effect = Effect::draw(name, draw);
        let detectable = bench.detectable_size(&effect, &projection)?;
        let range = effect.range();
        let most = (range.largest / detectable).min(multiples.1);
        if most < 1.05 * multiples.0 {
            return None;
        }
        let size = (detectable * draw.log_uniform(multiples.0, most)).max(range.small);
        effect.apply(size, &bench.scale, &mut world);
        effects.push((effect, size, detectable));
    }
    if !bench.works(&world) {
        return None;
    }
    let answers = answers(bench, &effects, &world);
    Some((world, answers))
}

fn answers(bench: &Bench<'_>, effects: &[(Effect, f64, f64)], world: &World) -> Vec<AnswerEffect> {
    if effects.is_empty() {
        return Vec::new();
    }
    let projection = bench.projection();
    let by_itself: Vec<(Vec<f64>, Projection)> = effects
        .iter()
        .map(|(effect, size, _)| {
            let (with, without) = bench.beyond(effect, *size);
            bench.left_by_moving(&with, &without, &projection, &[])
        })
        .collect();
    let by_power: Vec<Option<f64>> = effects.iter().map(|(effect, size, _)| bench.by_power(effect, *size)).collect();
    let d_by_itself = |place: usize| {
        let (difference, projection) = &by_itself[place];
        by_power[place].unwrap_or_else(|| projection.left_of(difference))
    };
    // what cannot be seen has no need of what it could be taken for
    let faint = effects.len() == 1 && d_by_itself(0) < DETECTABLE;
    let tangents = if faint { Vec::new() } else { bench.tangents() };
    let changes: Vec<Vec<f64>> = if effects.len() == 1 {
        Vec::new()
    } else {
        effects.iter().map(|(effect, size, _)| bench.change(effect, *size)).collect()
    };
    effects
        .iter()
        .enumerate()
        .map(|(place, (effect, size, detectable))| {
            let others = || changes.iter().enumerate().filter(|(index, _)| *index != place);
            let beside: Vec<&[f64]> = others().map(|(_, column)| &column[..]).collect();
            let (marginal, projection) = if effects.len() == 1 {
                by_itself[place].clone()
            } else {
                let mut without = bench.base.clone();
                for (index, (other, other_size, _)) in effects.iter().enumerate() {
                    let size = if index == place { Bench::no_gap(effect, *size) } else { *other_size };
                    if size > 0.0 {
                        other.apply(size, &bench.scale, &mut without);
                    }
                }
                bench.left_by_moving(world, &without, &projection, &beside)
            };
            let among: Vec<&(&str, Vec<f64>)> = tangents.iter().filter(|(name, _)| *name != effect.name).collect();
            // below the detectable size nothing can be told from anything
            let seen = projection.left_with(&marginal, &beside) >= DETECTABLE;
            let equivalents = among
                .iter()
                .filter(|(_, column)| {
                    if !seen {
                        return false;
                    }
                    let mut free = beside.clone();
                    free.push(column);
                    projection.left_with(&marginal, &free) < DETECTABLE
                })
                .map(|(name, _)| (*name).to_owned())
                .collect();
            let mut all: Vec<&[f64]> = among.iter().map(|(_, column)| &column[..]).collect();
            all.extend(&beside);
            let of = |d: f64| by_power[place].unwrap_or(d);
            AnswerEffect {
                name: effect.name.to_owned(),
                block: crate::effects::block_of(effect.name).to_owned(),
                parameters: effect.parameters(*size, &bench.scale),
                size: *size,
                detectable_size: *detectable,
                multiple: size / detectable,
                d: d_by_itself(place),
                d_beside_others: of(projection.left_with(&marginal, &beside)),
                d_beyond_library: of(projection.left_with(&marginal, &all)),
                equivalents,
            }
        })
        .collect()
}
