//! What the fit to one log leaves of another, which it did not see.

use gimbal_model_file::AxisModel;

use super::balance::Balance;
use super::judge::{Shrunk, by_block, shrunk};
use super::library::{NOMINAL, Shape};
use super::motion::BLOCKS;
use super::plain::nominal;
use super::ready::ready;
use super::search::Set;
use super::table::AxisLog;

/// What the fit to one log leaves of another.
pub(super) fn score(
    balance: &Balance,
    best: &Set,
    model: &AxisModel,
    name: String,
    log: AxisLog,
    notes: &mut Vec<String>,
) -> Vec<Shrunk> {
    let (_, checked, mut motion) = ready(log, model);
    motion.set_corner(balance.motion.corner);
    if Some(balance.motion.from) != checked.from {
        notes.push(format!("{name}: its motion is taken from the other column"));
    }
    if motion.stands != balance.motion.stands {
        notes.push(format!("{name}: one of the logs is at rest and the other moves; not compared"));
        return Vec::new();
    }
    motion.needed = balance.needs.at(&motion);
    (motion.middle, motion.size) = (balance.motion.middle, balance.motion.size);
    for ((name, _), own) in motion.auxiliary.iter().zip(&mut motion.references) {
        let fitted = balance.motion.auxiliary.iter().position(|(other, _)| other == name);
        *own = fitted.map_or(*own, |place| balance.motion.references[place]);
    }
    let base: Vec<Vec<f64>> = NOMINAL.iter().flat_map(|shape| shape.on_grid(&motion)).collect();
    let parameters = nominal(model);
    let effort = motion.raw(&motion.effort);
    let before: Vec<f64> =
        (0..effort.len()).map(|row| effort[row] - (0..3).map(|p| parameters[p] * base[p][row]).sum::<f64>()).collect();
    // how far apart the moments are at which effort and motion are read is each log's own
    let (_, amplitudes) = balance.fit(&best.members);
    let (of_base, mut of_effects) = amplitudes.split_at(balance.base.len());
    let mut after = before.clone();
    let less = |after: &mut Vec<f64>, column: &[f64], amplitude: f64| {
        after.iter_mut().zip(column).for_each(|(r, value)| *r -= amplitude * value);
    };
    base.iter().zip(of_base).for_each(|(column, amplitude)| less(&mut after, column, *amplitude));
    for &member in &best.members {
        let candidate = &balance.problem.candidates[member];
        let channel = match candidate.shape {
            Shape::Load { channel }
            | Shape::LoadFriction { channel }
            | Shape::LoadGain { channel }
            | Shape::LoadRipple { channel, .. } => Some(&balance.motion.auxiliary[channel].0),
            _ => None,
        };
        let there = channel.is_none_or(|name| motion.auxiliary.iter().any(|(other, _)| other == name));
        let (own, others) = of_effects.split_at(candidate.columns.len());
        of_effects = others;
        if there {
            let columns = candidate.shape.on_grid(&motion);
            columns.iter().zip(own).for_each(|(column, amplitude)| less(&mut after, column, *amplitude));
        }
    }
    let mut counts = vec![0.0; BLOCKS];
    motion.block.iter().for_each(|&block| counts[block] += 1.0);
    let unit = &model.effort_unit;
    let whole = shrunk(
        format!("effort of {name}, not fitted"),
        unit,
        &by_block(&before, &motion),
        &by_block(&after, &motion),
        &counts,
        motion.floor,
    );
    let mut all = vec![whole];
    // a load that the fitted log did not have is not the fit's to explain
    for (channel, values) in &motion.auxiliary {
        if balance.motion.auxiliary.iter().any(|(other, _)| other == channel) {
            continue;
        }
        let off = |residual: &[f64]| -> Vec<f64> {
            let rows = motion.rows.iter().zip(residual);
            rows.map(|(&row, r)| if values[row].abs() < 1e-9 { *r } else { 0.0 }).collect()
        };
        let mut counts = vec![0.0; BLOCKS];
        for (&row, &block) in motion.rows.iter().zip(&motion.block) {
            counts[block] += if values[row].abs() < 1e-9 { 1.0 } else { 0.0 };
        }
        all.push(shrunk(
            format!("effort of {name}, not fitted, {channel} off"),
            unit,
            &by_block(&off(&before), &motion),
            &by_block(&off(&after), &motion),
            &counts,
            motion.floor,
        ));
    }
    all
}
