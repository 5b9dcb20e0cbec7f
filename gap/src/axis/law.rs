//! The control law, where the model file knows it: what the controller gave, over what its law says.
//!
//! ```text
//! output = Kp (reference - position) + Kv (rate reference - rate) + what was added
//! ```
//!
//! Here stand what never shows in the balance: loads and compensations that are added to the output, and gains that
//! are not those of the model. The rate is the one that is logged, for the loop sees no other.

use gimbal_model_file::AxisModel;
use gimbal_model_file::axis::{Controller, Output};

use super::columns::Checked;
use super::judge::{Found, Parameter, Shrunk, deviation, label, parameters, shrunk};
use super::library::{Shape, rms};
use super::motion::Motion;
use super::regress::{Draws, Grams};
use super::search::{Candidate, Problem};
use super::slip::Slip;
use super::table::AxisLog;

/// What the law shows.
#[derive(Debug, Default)]
pub(super) struct Law {
    pub(super) found: Vec<Found>,
    pub(super) shrunk: Option<Shrunk>,
    /// What it leaves with all that is named, over the output.
    pub(super) left: f64,
    pub(super) words: Vec<String>,
}

/// Waves kept from the search.
const KEPT_WAVES: usize = 8;
/// A gain is another one from this many tolerances on.
const BEYOND: f64 = 1.15;
/// An output is at its limit from this share of it on.
const AT_LIMIT: f64 = 0.995;
/// Share of what is left at known gains that free ones may leave, to be believed.
const FREED: f64 = 0.25;
/// Rows that a law must be held against, at least.
const LEAST_ROWS: usize = 200;
/// Share of the rows of slip that may be of the other way, where it is one way.
const OTHER_WAY: f64 = 0.02;
/// Share of the output below which a law is as good as any.
const NOISE: f64 = 1e-3;

/// Errors that the law multiplies, on the grid, and its gains.
fn errors(log: &AxisLog, controller: &Controller, m: &Motion) -> Option<Vec<(&'static str, f64, Vec<f64>)>> {
    let mut errors = Vec::new();
    if controller.position_gain != 0.0 {
        let (reference, position) = (log.position_reference.as_ref()?, log.position.as_ref()?);
        let error: Vec<f64> = reference.iter().zip(position).map(|(r, q)| r - q).collect();
        errors.push(("position_gain", controller.position_gain, m.raw(&error)));
    }
    if controller.velocity_gain != 0.0 {
        let rate = match &log.velocity {
            Some(velocity) => m.raw(velocity),
            None => m.smoothed(&m.v),
        };
        let reference = log.velocity_reference.as_ref().map_or_else(|| vec![0.0; rate.len()], |r| m.raw(r));
        let error = reference.iter().zip(&rate).map(|(r, v)| r - v).collect();
        errors.push(("velocity_gain", controller.velocity_gain, error));
    }
    (!errors.is_empty()).then_some(errors)
}

/// Leaves out the rows at which the output is at its limit, with what smoothing reaches: no law holds there.
fn free_rows(m: &mut Motion, output: &[f64], model: &AxisModel, controller: &Controller) {
    let limit = match controller.output {
        Output::Command => controller.limit,
        Output::Effort => controller.limit.or(model.effort_limit),
    };
    let Some(limit) = limit else { return };
    let mut free = vec![true; output.len()];
    let reach = m.whole.half();
    for (row, _) in output.iter().enumerate().filter(|(_, value)| value.abs() >= AT_LIMIT * limit) {
        free[row.saturating_sub(reach)..(row + reach + 1).min(output.len())].fill(false);
    }
    let kept = m.rows.iter().zip(&m.block).filter(|(row, _)| free[**row]);
    (m.rows, m.block) = kept.map(|(row, block)| (*row, *block)).unzip();
}

/// Whether the axis slips one way only while a channel is on: what it adds by the sign of the rate is then what it adds.
fn slips_one_way(m: &Motion, channel: usize) -> bool {
    let directions = m.pick(&m.s).into_iter().zip(m.pick(&m.auxiliary[channel].1)).filter(|(_, on)| *on != 0.0);
    let (ahead, back) = directions.fold((0_usize, 0), |(ahead, back), (direction, _)| {
        (ahead + usize::from(direction > 0.0), back + usize::from(direction < 0.0))
    });
    ahead.min(back) as f64 <= OTHER_WAY * (ahead + back) as f64
}

/// Waves over the position that stand out of a residual while a channel is on.
fn waves(m: &Motion, channel: usize, rest: &[f64]) -> Vec<Shape> {
    let (q, v) = (m.pick(&m.q), m.pick(&m.v));
    let on = m.pick(&m.auxiliary[channel].1);
    let sigma_s = m.period_s * m.whole_sigma();
    let mut found: Vec<(f64, f64)> = m
        .wave_numbers()
        .into_iter()
        .map(|k| {
            let (mut re, mut im, mut power) = (0.0, 0.0, 1e-300);
            for i in (0..q.len()).filter(|&i| on[i] != 0.0) {
                let wave = on[i] * (-0.5 * (k * v[i] * sigma_s).powi(2)).exp();
                let (sin, cos) = (k * q[i]).sin_cos();
                re += wave * rest[i] * cos;
                im += wave * rest[i] * sin;
                power += wave * wave;
            }
            ((re * re + im * im) / power, k)
        })
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
        .iter()
        .take(KEPT_WAVES)
        .map(|(_, wave_number)| Shape::LoadRipple { channel, wave_number: *wave_number })
        .collect()
}

/// Holds the law against the log, as it is and with its columns mended: the loop may have the one or the other.
pub(super) fn law_of(log: &AxisLog, checked: &Checked, model: &AxisModel, motion: &Motion) -> Law {
    let as_it_is = law(log, model, motion);
    if checked.faults.is_empty() {
        return as_it_is;
    }
    let mended = law(&checked.mended(log), model, motion);
    if mended.shrunk.is_some() && mended.left < as_it_is.left { mended } else { as_it_is }
}

/// Holds the law against the log.
#[allow(clippy::too_many_lines, reason = "one chain from the law to its words")]
fn law(log: &AxisLog, model: &AxisModel, motion: &Motion) -> Law {
    let Some(controller) = &model.controller else { return Law::default() };
    let not_held = |why: &str| Law {
        words: vec![format!("the control law is not held against this log: {why}")],
        ..Law::default()
    };
    if motion.stands {
        return not_held("the axis stands");
    }
    let columns = &model.columns;
    let lost = columns.position_reference.is_some() && log.position_reference.is_none()
        || columns.velocity_reference.is_some() && log.velocity_reference.is_none();
    let (output, unit) = match (controller.output, &log.command, &model.columns.command) {
        (Output::Command, Some(command), Some(source)) => (command, source.unit.clone()),
        (Output::Effort, ..) => (&log.effort, model.effort_unit.clone()),
        _ => return not_held("its output, the command, is not in this file"),
    };
    let mut m = motion.clone();
    free_rows(&mut m, output, model, controller);
    if m.rows.len() < LEAST_ROWS {
        return not_held(&format!("{} rows of slip below the limit, and {LEAST_ROWS} are needed", m.rows.len()));
    }
    let Some(errors) = errors(log, controller, &m).filter(|_| !lost) else {
        return not_held("what it follows, its reference, is not in this file");
    };
    let given = m.raw(output);
    let rows = given.len();
    let said: Vec<f64> = (0..rows).map(|row| errors.iter().map(|(_, gain, error)| gain * error[row]).sum()).collect();
    let target: Vec<f64> = given.iter().zip(&said).map(|(u, law)| u - law).collect();
    m.needed = vec![0.0; m.q.len()];
    let mut columns: Vec<Vec<f64>> = errors.iter().map(|(_, _, error)| error.clone()).collect();
    let base: Vec<usize> = (0..columns.len()).collect();
    let mut shapes = if model.trusts("command_bias") { Vec::new() } else { vec![Shape::Constant] };
    for channel in 0..m.auxiliary.len() {
        shapes.extend([Shape::Load { channel }, Shape::LoadFriction { channel }]);
        let mean = target.iter().sum::<f64>() / rows.max(1) as f64;
        let rest: Vec<f64> = target.iter().map(|value| value - mean).collect();
        shapes.extend(waves(&m, channel, &rest));
    }
    let mut candidates = Vec::new();
    for shape in shapes {
        let start = columns.len();
        columns.extend(shape.on_grid(&m));
        candidates.push(Candidate { shape, columns: (start..columns.len()).collect() });
    }
    // a rate that the loop has later than the log
    if controller.velocity_gain != 0.0 && !model.trusts("velocity_delay") {
        let late: Vec<f64> = m.smoothed(&m.a).iter().map(|a| controller.velocity_gain * a).collect();
        candidates.push(Candidate { shape: Shape::RateDelay, columns: vec![columns.len()] });
        columns.push(late);
    }
    let mut grams = Grams::new(&columns, &target, &m.block);
    let lag = 1 + 2 * super::balance::correlation(&target);
    for (place, (_, gain, _)) in errors.iter().enumerate() {
        let variance = rms(&target).powi(2).max((NOISE * rms(&given)).powi(2)) * lag as f64;
        grams.precision[place] = variance / (controller.tolerance * gain).powi(2);
    }
    let floor = NOISE * rms(&given);
    let problem = Problem {
        base,
        candidates,
        grams,
        floor_square: floor.powi(2) * rows as f64,
        effort_square: given.iter().map(|u| u * u).sum(),
        // a load hides nothing here: what it leaves is as well known as it is
        least_share: 0.0,
        nominal: None,
        slip: Slip::default(),
        travel: f64::INFINITY,
        within: errors.iter().map(|(_, gain, _)| BEYOND * controller.tolerance * gain.abs()).collect(),
    };
    let mut problem = problem;
    let mut best = problem.search(Vec::new());
    // what is known of the gains weighs against what is then left
    for _ in 0..2 {
        let variance = (best.square() / rows.max(1) as f64).max((NOISE * rms(&given)).powi(2)) * lag as f64;
        for (place, (_, gain, _)) in errors.iter().enumerate() {
            problem.grams.precision[place] = variance / (controller.tolerance * gain).powi(2);
        }
        best = problem.search(best.members);
    }
    // gains that are far off hold the law where it is: free, they must leave a small part of that
    let held = std::mem::replace(&mut problem.grams.precision, vec![0.0; columns.len()]);
    let free = problem.search(Vec::new());
    let better = |free: f64, held: f64| free - problem.floor_square < FREED * (held - problem.floor_square);
    if better(free.square(), best.square()) && !model.trusts("loop_gain") {
        best = free;
    } else {
        problem.grams.precision = held;
    }
    let set = problem.columns(&best.members);
    let fit = problem.grams.fit(&set);
    let mut draws = Draws::new();
    let times: Vec<Vec<f64>> = (0..200).map(|_| draws.draw(&problem.grams.counts)).collect();
    let drawn: Vec<Vec<f64>> = times.iter().filter_map(|times| problem.grams.fit_drawn(&set, times)).collect();
    let before = super::judge::by_block(&target, &m);
    let shrunk = shrunk("control law".to_owned(), &unit, &before, &best.held_out, &problem.grams.counts, floor);
    let mut law = Law::default();
    law.words.push(format!(
        "the control law leaves {:.3e} {unit} rms of an output of {:.3e} {unit} rms, {:.3e} with what is named below",
        shrunk.before,
        rms(&given),
        shrunk.after
    ));
    for (place, (name, gain, _)) in errors.iter().enumerate() {
        let error = deviation(&drawn, place);
        let found = gain + fit[place];
        law.words.push(format!("{name} {found:.5} +- {error:.1e} (model {gain:.5})"));
        if fit[place].abs() - error > BEYOND * controller.tolerance * gain.abs() {
            let new = |name: &str, value: f64, std: f64, unit: &str| Parameter {
                name: name.to_owned(),
                value,
                std,
                unit: unit.to_owned(),
            };
            let of = if *name == "position_gain" {
                model.motion.unit().to_owned()
            } else {
                format!("{}/s", model.motion.unit())
            };
            law.found.push(Found {
                effect: "loop_gain".to_owned(),
                block: "servo",
                probability: 0.95,
                parameters: vec![
                    new(name, found, error, &format!("{unit}/({of})")),
                    new("relative_change", fit[place] / gain, error / gain.abs(), "1"),
                ],
                removes: 0.0,
                shows_in: "control law",
            });
        }
    }
    for (place, &member) in best.members.iter().enumerate() {
        let shape = &problem.candidates[member].shape;
        let at: Vec<usize> =
            problem.candidates[member].columns.iter().filter_map(|c| set.iter().position(|s| s == c)).collect();
        let own: Vec<f64> = at.iter().map(|&place| fit[place]).collect();
        let samples: Vec<Vec<f64>> = drawn.iter().map(|d| at.iter().map(|&place| d[place]).collect()).collect();
        let mut parameters = parameters(shape, &own, &samples, model, &m);
        for parameter in &mut parameters {
            parameter.unit = parameter.unit.replace(&model.effort_unit, &unit);
        }
        let mut without = best.members.clone();
        without.remove(place);
        let without = problem.set(without);
        let wins = times
            .iter()
            .filter(|times| {
                let of = |squares: &[f64]| squares.iter().zip(times.iter()).map(|(s, t)| s * t).sum::<f64>();
                of(&without.held_out) > of(&best.held_out)
            })
            .count();
        let channel = |channel: usize| &m.auxiliary[channel].0;
        let effect = match shape {
            Shape::Constant => "command_bias".to_owned(),
            Shape::LoadFriction { channel: c } => format!("compensation:{}", channel(*c)),
            _ => label(shape, &m),
        };
        if let Shape::Load { channel: c } | Shape::LoadFriction { channel: c } = shape
            && slips_one_way(&m, *c)
        {
            law.words.push(format!(
                "the axis slips one way while `{}` is on: a load and a compensation of friction are one there",
                channel(*c)
            ));
        }
        let gain = (without.square() - best.square()) / before.iter().sum::<f64>().max(1e-300);
        law.found.push(Found {
            effect,
            block: "servo",
            probability: wins as f64 / (times.len() + 1) as f64,
            parameters,
            removes: gain.clamp(0.0, 1.0),
            shows_in: "control law",
        });
    }
    law.left = shrunk.after / rms(&given).max(1e-300);
    law.shrunk = Some(shrunk);
    law
}
