//! Task `cost`: what a step takes on a board: instructions, flash, state, stack.

use super::boards::{self, Board};
use super::{emulator, gates, image};
use crate::elf::{self, Image, Reach};
use anyhow::{Context, Result, bail};
use serde_json::json;
use std::collections::BTreeMap;

/// Instructions of a run of steps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Count {
    pub(crate) steps: u64,
    pub(crate) min: u64,
    pub(crate) mean: f64,
    pub(crate) max: u64,
}

/// What the step takes in one number system.
#[derive(Debug, Default)]
pub(crate) struct Cost {
    /// By the name of the profile; steps with a stop event by `NAME, stop events`, those without by `NAME, other steps`.
    pub(crate) instructions: BTreeMap<String, Count>,
    pub(crate) state_bytes: u64,
    pub(crate) law_bytes: u64,
    /// State and law of an axis with effects.
    pub(crate) effects_bytes: [u64; 2],
    /// State and law of the estimator.
    pub(crate) estimator_bytes: [u64; 2],
    /// Largest relative error of another crate's function [1e-6], by name.
    pub(crate) errors_ppm: BTreeMap<String, u64>,
    /// Code that the step reaches, with the constants among it.
    pub(crate) code_bytes: u32,
    /// Constants in sections of their own: of both number systems, estimator and monitor among them.
    pub(crate) constant_bytes: u32,
    pub(crate) static_ram_bytes: u32,
    pub(crate) stack_bytes: u32,
    /// Code that the step with effects reaches, and the most stack it takes.
    pub(crate) effects_code_bytes: u32,
    pub(crate) effects_stack_bytes: u32,
    /// Code that estimator and monitor reach, and the most stack they take.
    pub(crate) aids_code_bytes: u32,
    pub(crate) aids_stack_bytes: u32,
    /// The calls of the step that take the most stack.
    pub(crate) deepest: String,
    /// Functions of the run-time library that the step calls.
    pub(crate) library: Vec<String>,
}

/// Costs on `board`, by number system.
pub(crate) fn measure(board: &Board) -> Result<BTreeMap<&'static str, Cost>> {
    let mut costs = BTreeMap::new();
    // The nominal law last: its image is left for who looks at it.
    let effects = elf::functions(&step(board, Some("effects"))?)?;
    let step = step(board, None)?;
    let functions = elf::functions(&step)?;
    for (number, [root, aids]) in gates::ROOTS {
        let (reach, aids) = (Reach::from(&functions, root)?, Reach::from(&functions, aids)?);
        let effects = Reach::from(&effects, root)?;
        let names = reach.functions.iter().flat_map(|(function, _)| &function.names);
        costs.insert(
            number,
            Cost {
                code_bytes: reach.code_bytes(),
                constant_bytes: step.section_bytes(".rodata"),
                static_ram_bytes: step.section_bytes(".data") + step.section_bytes(".bss"),
                stack_bytes: reach.stack_bytes,
                effects_code_bytes: effects.code_bytes(),
                effects_stack_bytes: effects.stack_bytes,
                aids_code_bytes: aids.code_bytes(),
                aids_stack_bytes: aids.stack_bytes,
                library: names.filter(|name| name.starts_with("__")).cloned().collect(),
                deepest: reach.deepest,
                ..Cost::default()
            },
        );
    }
    let output = emulator::run(board, &image::of(board, "cost")?)?;
    let with_effects = emulator::run(board, &image::with(board, "cost", "effects")?)?;
    for line in output.lines().chain(with_effects.lines()) {
        read_line(line, &mut costs).with_context(|| format!("from {}: `{line}`", board.name))?;
    }
    Ok(costs)
}

/// The program `step` with the nominal law or another one.
fn step(board: &Board, law: Option<&str>) -> Result<Image> {
    Image::read(&image::step(board, law).or_else(|_| image::step_that_may_panic(board, law))?)
}

/// `cost PROFILE NUMBER STEPS MIN MEAN_MILLI MAX`, `cost-events` and `cost-others` the same, `size NUMBER STATE LAW`,
/// `size-effects` and `size-estimator` the same, `error NAME NUMBER PPM`.
fn read_line(line: &str, costs: &mut BTreeMap<&'static str, Cost>) -> Result<()> {
    let words: Vec<&str> = line.split_whitespace().collect();
    match words.as_slice() {
        ["size", number, state, law] => {
            let cost = costs.get_mut(*number).context("an unknown number system")?;
            (cost.state_bytes, cost.law_bytes) = (state.parse()?, law.parse()?);
        }
        [kind @ ("size-effects" | "size-estimator"), number, state, law] => {
            let cost = costs.get_mut(*number).context("an unknown number system")?;
            let bytes = if *kind == "size-effects" { &mut cost.effects_bytes } else { &mut cost.estimator_bytes };
            *bytes = [state.parse()?, law.parse()?];
        }
        ["error", name, number, ppm] => {
            let cost = costs.get_mut(*number).context("an unknown number system")?;
            cost.errors_ppm.insert((*name).to_owned(), ppm.parse()?);
        }
        [kind @ ("cost" | "cost-events" | "cost-others"), profile, number, steps, min, mean_milli, max] => {
            let name = match *kind {
                "cost" => (*profile).to_owned(),
                "cost-events" => format!("{profile}, stop events"),
                _ => format!("{profile}, other steps"),
            };
            let mean = mean_milli.parse::<f64>()? / 1000.0;
            let count = Count { steps: steps.parse()?, min: min.parse()?, mean, max: max.parse()? };
            costs.get_mut(*number).context("an unknown number system")?.instructions.insert(name, count);
        }
        _ => bail!("not a line of costs"),
    }
    Ok(())
}

pub(crate) fn print(board: &str, as_json: bool) -> Result<()> {
    let board = boards::by_name(board)?;
    let costs = measure(&board)?;
    if as_json {
        println!("{}", to_json(&board, &costs)?);
    } else {
        print!("{}", super::budget::text(&board, &costs)?);
    }
    Ok(())
}

/// `flash_bytes`, `state_bytes` and `stack_bytes` are those of f32; each number system has its own beside its counts.
fn to_json(board: &Board, costs: &BTreeMap<&str, Cost>) -> Result<serde_json::Value> {
    let mut instructions = serde_json::Map::new();
    for (number, cost) in costs {
        let row = |count: &Count| json!({"min": count.min, "mean": count.mean, "max": count.max});
        let mut rows = serde_json::Map::new();
        for (profile, count) in &cost.instructions {
            let name = if profile == "flight" { "step".to_owned() } else { profile.replace([',', ' ', '-'], "_") };
            rows.insert(name.replace("__", "_"), row(count));
        }
        instructions.insert((*number).to_owned(), rows.into());
    }
    let f32 = costs.get("f32").context("no costs of f32")?;
    let sizes: serde_json::Map<_, _> = costs
        .iter()
        .map(|(number, cost)| {
            let sizes = json!({
                "flash_bytes": cost.code_bytes + cost.constant_bytes, "state_bytes": cost.state_bytes,
                "law_bytes": cost.law_bytes, "effects_code_bytes": cost.effects_code_bytes,
                "effects_stack_bytes": cost.effects_stack_bytes, "effects_state_bytes": cost.effects_bytes[0],
                "effects_law_bytes": cost.effects_bytes[1], "estimator_monitor_code_bytes": cost.aids_code_bytes,
                "estimator_monitor_stack_bytes": cost.aids_stack_bytes, "estimator_state_bytes": cost.estimator_bytes[0],
                "estimator_law_bytes": cost.estimator_bytes[1], "stack_bytes": cost.stack_bytes,
                "static_ram_bytes": cost.static_ram_bytes,
            });
            ((*number).to_owned(), sizes)
        })
        .collect();
    Ok(json!({
        "target": board.target, "board": board.name, "core": board.core,
        "instructions": instructions, "sizes": sizes,
        "flash_bytes": f32.code_bytes + f32.constant_bytes,
        "state_bytes": f32.state_bytes,
        "stack_bytes": f32.stack_bytes,
    }))
}
