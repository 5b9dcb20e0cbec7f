//! Verdict, probabilities, parameters with errors, and how far the gap shrinks on blocks that were not fitted.

use gimbal_model_file::AxisModel;

use super::balance::{Balance, nominal};
use super::library::{NOMINAL, Shape};
use super::motion::Motion;
use super::regress::Draws;
use super::search::{LEAST_OF_REST, Set};
use crate::judge::Verdict;

/// Draws of the bootstrap.
const DRAWS: usize = 200;
/// A nominal parameter is an effect from this many tolerances on.
pub(super) const BEYOND: f64 = 1.15;
/// Share of the gap that may be left over by what explains it.
const LEFT: f64 = 0.03;
/// Sets within this share of what is left are not told apart, and what is left counts as this share of all at least.
const SAME: f64 = 0.05;
const LEAST_SAME: f64 = 0.05;
/// What is left makes an unknown effect as likely as not at this share.
const HALF_LEFT: f64 = 0.25;
/// Sets that leave nothing are wrong this often, on simulated axes of which some have what the library lacks.
const EVEN_SO: f64 = 0.1;
/// Kinds of effect that a log may well show at once, and what each further one leaves of the probability of the set.
const SURE_KINDS: usize = 2;
const EACH_KIND: f64 = 0.6;
/// A fit that leaves more than this of a log that it did not see explains a part.
const CARRIED: f64 = 0.2;
/// From this probability of something unknown on nothing is explained.
const UNEXPLAINED: f64 = 0.6;
/// Share of the gap that is a trifle.
const TRIFLE: f64 = 0.01;
/// A gap is one from this power over the floor on.
const NOTABLE: f64 = 1.5;

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Standard error, by bootstrap over blocks.
    pub std: f64,
    /// Unit.
    pub unit: String,
}

/// An effect that is named.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Its name.
    pub effect: String,
    /// Its block.
    pub block: &'static str,
    /// Marginal probability.
    pub probability: f64,
    /// Parameters.
    pub parameters: Vec<Parameter>,
    /// Share of the gap that it takes away.
    pub removes: f64,
    /// Where it shows: `effort` (the balance), `control law` or `columns`.
    pub shows_in: &'static str,
}

/// A set of effects.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranked {
    /// Names, in alphabetical order, each once.
    pub effects: Vec<String>,
    /// Probability of the set.
    pub probability: f64,
}

/// Before and after, of one signal of one log.
#[derive(Debug, Clone, PartialEq)]
pub struct Shrunk {
    /// Signal, and the log where it is another one.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Root mean square of the residual of the nominal model.
    pub before: f64,
    /// With the effects.
    pub after: f64,
    /// What noise leaves.
    pub noise_floor: f64,
    /// Share of the gap gone.
    pub reduction_percent: f64,
    /// Its interval.
    pub ci95_percent: [f64; 2],
}

/// What is decided on a balance.
#[derive(Debug)]
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    pub(super) found: Vec<Found>,
    pub(super) ranking: Vec<Ranked>,
    pub(super) alternatives: Vec<Ranked>,
    pub(super) unknown_probability: f64,
    pub(super) shrunk: Shrunk,
    /// Drawn amplitudes of the set's columns, for bands of confidence.
    pub(super) drawn: Vec<Vec<f64>>,
}

/// Before and after from squared errors of blocks, with an interval by bootstrap over blocks.
pub(super) fn shrunk(name: String, unit: &str, before: &[f64], after: &[f64], counts: &[f64], floor: f64) -> Shrunk {
    let closed = |times: &[f64]| {
        let sum = |squares: &[f64]| squares.iter().zip(times).map(|(s, t)| s * t).sum::<f64>();
        let rows: f64 = counts.iter().zip(times).map(|(c, t)| c * t).sum::<f64>().max(1.0);
        let (before, after) = (sum(before) / rows, sum(after) / rows);
        // what is below the floor is noise: no gap is closed there
        let noise = floor.powi(2).min(after);
        // an effort within the noise has no gap to close
        let gone = if before > floor.powi(2).max(1e-300) { 1.0 - (after - noise) / (before - noise) } else { 0.0 };
        (before.sqrt(), after.sqrt(), 100.0 * gone)
    };
    let all: Vec<f64> = vec![1.0; counts.len()];
    let (whole_before, whole_after, reduction_percent) = closed(&all);
    let mut draws = Draws::new();
    let mut drawn: Vec<f64> = (0..1000).map(|_| closed(&draws.draw(counts)).2).collect();
    drawn.sort_by(f64::total_cmp);
    Shrunk {
        name,
        unit: unit.to_owned(),
        before: whole_before,
        after: whole_after,
        noise_floor: floor,
        reduction_percent,
        ci95_percent: [drawn[24], drawn[974]],
    }
}

/// Squares of values summed over blocks.
pub(super) fn by_block(values: &[f64], motion: &Motion) -> Vec<f64> {
    let mut squares = vec![0.0; super::motion::BLOCKS];
    for (value, &block) in values.iter().zip(&motion.block) {
        squares[block] += value * value;
    }
    squares
}

/// Nominal parameters beyond what is known of them; all of them by one factor are one effect.
fn beyond(balance: &Balance, model: &AxisModel, shifts: [f64; 3], errors: [f64; 3]) -> Vec<Shape> {
    let base = nominal(model);
    // and worth the price of an effect
    let grams = &balance.problem.grams;
    let worth = |index: usize| shifts[index].powi(2) * grams.power(index) > balance.problem.price();
    let outside: Vec<usize> =
        (0..3).filter(|&index| worth(index) && !within(model, index, shifts[index], errors[index])).collect();
    let known: Vec<usize> = (0..3).filter(|&index| base[index] > 0.0).collect();
    if outside.len() > 1
        && outside.iter().all(|index| known.contains(index))
        && !model.known_good.iter().any(|good| good == "torque_scale")
    {
        let tolerance = [model.tolerance.inertia, model.tolerance.viscous, model.tolerance.coulomb];
        let factors: Vec<(f64, f64)> = known
            .iter()
            .map(|&i| (shifts[i] / base[i], tolerance[i].powi(2) + (2.0 * errors[i] / base[i]).powi(2)))
            .collect();
        let weight: f64 = factors.iter().map(|(_, variance)| 1.0 / variance).sum();
        let mean = factors.iter().map(|(factor, variance)| factor / variance).sum::<f64>() / weight;
        if factors.iter().all(|(factor, variance)| ((1.0 + factor) / (1.0 + mean) - 1.0).powi(2) < 2.0 * variance) {
            return vec![Shape::Scale];
        }
    }
    outside.into_iter().map(|index| NOMINAL[index].clone()).collect()
}

/// Names of a set's effects, each once.
fn names(balance: &Balance, members: &[usize], model: &AxisModel) -> Vec<String> {
    let (columns, amplitudes) = balance.fit(members);
    let shifts = balance.shifts(members, &columns, &amplitudes);
    let shapes = members.iter().map(|&m| &balance.problem.candidates[m].shape);
    let mut names: Vec<String> = shapes
        .filter(|shape| !NOMINAL.contains(shape))
        .map(|shape| label(shape, &balance.motion))
        .chain(beyond(balance, model, shifts, balance.of_noise()).iter().map(|shape| shape.effect().to_owned()))
        .collect();
    names.sort();
    names.dedup();
    names
}

/// Name of an effect; channels have theirs beside it.
pub(super) fn label(shape: &Shape, motion: &Motion) -> String {
    match shape {
        Shape::Load { channel }
        | Shape::LoadFriction { channel }
        | Shape::LoadGain { channel }
        | Shape::LoadRipple { channel, .. } => {
            format!("{}:{}", shape.effect(), motion.auxiliary[*channel].0)
        }
        _ => shape.effect().to_owned(),
    }
}

impl Judged {
    /// Takes back what does not carry over: what the fit leaves of a log that it did not see is no less unknown than what
    /// it leaves of its own.
    pub(super) fn carried(&mut self, left: f64) {
        let unknown = doubt(left, 0);
        if self.verdict == Verdict::NoGap || unknown <= self.unknown_probability {
            return;
        }
        let kept = (1.0 - unknown) / (1.0 - self.unknown_probability).max(1e-9);
        self.unknown_probability = unknown;
        self.found.iter_mut().for_each(|found| found.probability *= kept);
        self.ranking.iter_mut().chain(&mut self.alternatives).for_each(|set| set.probability *= kept);
        if unknown > UNEXPLAINED {
            self.verdict = Verdict::Unexplained;
        } else if matches!(self.verdict, Verdict::Explained | Verdict::CannotTell) && left > CARRIED {
            self.verdict = Verdict::PartlyExplained;
        }
    }
}

/// Judges the best set.
pub(super) fn judge(balance: &Balance, best: &Set, model: &AxisModel) -> Judged {
    let problem = &balance.problem;
    let (columns, amplitudes) = balance.fit(&best.members);
    let mut draws = Draws::new();
    let mut drawn = Vec::new();
    let mut times = Vec::new();
    for _ in 0..DRAWS {
        let draw = draws.draw(&problem.grams.counts);
        drawn.extend(problem.grams.fit_drawn(&columns, &draw));
        times.push(draw);
    }
    let before = by_block(&balance.target, &balance.motion);
    let shrunk = shrunk(
        "effort".to_owned(),
        &model.effort_unit,
        &before,
        &best.held_out,
        &problem.grams.counts,
        balance.motion.floor,
    );
    let (ranking, unknown_probability) = rank(balance, best, &times, &shrunk, model);
    let contribution = |member: usize| -> f64 {
        let mut sum = vec![0.0; balance.target.len()];
        for &column in &problem.candidates[member].columns {
            let amplitude = columns.iter().position(|c| *c == column).map_or(0.0, |place| amplitudes[place]);
            sum.iter_mut().zip(&balance.columns[column]).for_each(|(s, value)| *s += amplitude * value);
        }
        sum.iter().map(|value| value * value).sum()
    };
    let mut powers: Vec<f64> = best.members.iter().map(|&member| contribution(member)).collect();
    let shifts = balance.shifts(&best.members, &columns, &amplitudes);
    let shifted: Vec<Vec<f64>> =
        drawn.iter().map(|d: &Vec<f64>| balance.shifts(&best.members, &columns, d).to_vec()).collect();
    let errors = [0, 1, 2].map(|index| deviation(&shifted, index));
    let unsure: [f64; 3] = std::array::from_fn(|index| errors[index] + balance.of_noise()[index]);
    let outside = beyond(balance, model, shifts, unsure);
    for (place, &member) in best.members.iter().enumerate() {
        // what frees a parameter is told as the parameter
        if NOMINAL.contains(&balance.problem.candidates[member].shape) {
            powers[place] = 0.0;
        }
    }
    let of_shift = |indices: &[usize]| -> f64 {
        let sum = |row: usize| indices.iter().map(|&i| shifts[i] * balance.columns[i][row]).sum::<f64>();
        (0..balance.target.len()).map(|row| sum(row).powi(2)).sum()
    };
    let indices = |shape: &Shape| -> Vec<usize> {
        NOMINAL.iter().position(|nominal| nominal == shape).map_or_else(|| (0..3).collect(), |index| vec![index])
    };
    let all: f64 =
        (powers.iter().sum::<f64>() + outside.iter().map(|shape| of_shift(&indices(shape))).sum::<f64>()).max(1e-300);
    let gone = (shrunk.reduction_percent / 100.0).clamp(0.0, 1.0);
    let marginal = |effect: &str| -> f64 {
        let with = ranking.iter().filter(|set| set.effects.iter().any(|name| name == effect));
        with.map(|set| set.probability).fold(0.0, |sum, p| sum + p).clamp(0.0, 1.0)
    };
    let mut found: Vec<Found> = Vec::new();
    for (place, &member) in best.members.iter().enumerate() {
        let shape = &problem.candidates[member].shape;
        let at: Vec<usize> = problem.candidates[member]
            .columns
            .iter()
            .filter_map(|column| columns.iter().position(|c| c == column))
            .collect();
        let own: Vec<f64> = at.iter().map(|&place| amplitudes[place]).collect();
        let samples: Vec<Vec<f64>> = drawn.iter().map(|d| at.iter().map(|&place| d[place]).collect()).collect();
        if NOMINAL.contains(shape) {
            continue;
        }
        let parameters = parameters(shape, &own, &samples, model, &balance.motion);
        let effect = label(shape, &balance.motion);
        let probability = marginal(&effect);
        let removes = (powers[place] / all * gone).clamp(0.0, 1.0);
        found.push(Found { effect, block: shape.block(), probability, parameters, removes, shows_in: "effort" });
    }
    for shape in &outside {
        let parameters = if let [index] = indices(shape)[..] {
            let samples: Vec<Vec<f64>> = shifted.iter().map(|s| vec![s[index]]).collect();
            parameters(shape, &[shifts[index]], &samples, model, &balance.motion)
        } else {
            let base = nominal(model);
            let known: Vec<usize> = (0..3).filter(|&i| base[i] > 0.0).collect();
            let weight = |i: usize| (base[i] / errors[i].max(1e-6 * base[i])).powi(2);
            let weights: f64 = known.iter().map(|&i| weight(i)).sum();
            let mean = |s: &[f64]| known.iter().map(|&i| weight(i) * s[i] / base[i]).sum::<f64>() / weights;
            let samples: Vec<Vec<f64>> = shifted.iter().map(|s| vec![mean(s)]).collect();
            parameters(shape, &[mean(&shifts)], &samples, model, &balance.motion)
        };
        let effect = shape.effect().to_owned();
        let (probability, removes) = (marginal(&effect), of_shift(&indices(shape)) / all * gone);
        found.push(Found { effect, block: shape.block(), probability, parameters, removes, shows_in: "effort" });
    }
    found.sort_by(|a, b| b.removes.total_cmp(&a.removes));
    let own = names(balance, &best.members, model);
    let own_probability = ranking.iter().find(|set| set.effects == own).map_or(0.0, |set| set.probability);
    let mut alternatives: Vec<Ranked> = ranking
        .iter()
        .filter(|set| {
            set.effects != own
                && set.probability > 0.1 * own_probability
                && !own.iter().all(|name| set.effects.contains(name))
                && !set.effects.iter().all(|name| own.contains(name))
        })
        .cloned()
        .collect();
    // what differs in a trifle alone is told by the probability of the trifle
    alternatives.retain(|set| {
        let misses = |found: &&Found| found.removes >= TRIFLE && !set.effects.contains(&found.effect);
        found.iter().any(|found| misses(&found))
    });
    let gap = (shrunk.before / shrunk.noise_floor.max(1e-300)).powi(2) > NOTABLE;
    let left = (shrunk.after.powi(2) - shrunk.noise_floor.powi(2)).max(0.0);
    let there = (shrunk.before.powi(2) - shrunk.noise_floor.powi(2)).max(1e-300);
    let verdict = if found.is_empty() {
        if gap && left > 0.5 * there && !tolerated(balance, model) { Verdict::Unexplained } else { Verdict::NoGap }
    } else if unknown_probability > UNEXPLAINED {
        Verdict::Unexplained
    } else if left > LEFT * there && left > NOTABLE * shrunk.noise_floor.powi(2) {
        Verdict::PartlyExplained
    } else if alternatives.is_empty() {
        Verdict::Explained
    } else {
        Verdict::CannotTell
    };
    if verdict == Verdict::NoGap {
        alternatives.clear();
    }
    Judged { verdict, found, ranking, alternatives, unknown_probability, shrunk, drawn }
}

/// Whether what is left is small beside what the tolerance of the parameters alone allows.
fn tolerated(balance: &Balance, model: &AxisModel) -> bool {
    let motion = &balance.motion;
    let sizes = [&motion.a, &motion.v, &motion.s].map(|values| super::library::rms(&motion.pick(values)));
    let tolerance = [model.tolerance.inertia, model.tolerance.viscous, model.tolerance.coulomb];
    let allowed: f64 = (0..3).map(|p| (tolerance[p] * nominal(model)[p] * sizes[p]).powi(2)).sum();
    let rest = super::library::rms(&balance.residual(&[]));
    rest.powi(2) < allowed.max(2.0 * motion.floor.powi(2))
}

/// Whether a shift lies within what is known of the parameter.
fn within(model: &AxisModel, index: usize, shift: f64, error: f64) -> bool {
    let tolerance = [model.tolerance.inertia, model.tolerance.viscous, model.tolerance.coulomb][index];
    shift.abs() - error <= BEYOND * tolerance * nominal(model)[index]
}

pub(super) fn deviation(samples: &[Vec<f64>], place: usize) -> f64 {
    let count = samples.len().max(2) as f64;
    let mean = samples.iter().map(|s| s[place]).sum::<f64>() / count;
    (samples.iter().map(|s| (s[place] - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt()
}

/// Parameters of an effect with their names and units.
pub(super) fn parameters(
    shape: &Shape,
    own: &[f64],
    samples: &[Vec<f64>],
    model: &AxisModel,
    motion: &Motion,
) -> Vec<Parameter> {
    let unit = |power: u32| model.parameter_unit(power);
    let effort = model.effort_unit.clone();
    let length = model.motion.unit();
    let new = |name: &str, value: f64, std: f64, unit: String| Parameter { name: name.to_owned(), value, std, unit };
    let amplitude = |name: &str, unit: String| new(name, own[0], deviation(samples, 0), unit);
    let one = || "1".to_owned();
    let mut told = match shape {
        Shape::Inertia | Shape::Viscous | Shape::Coulomb => {
            let index = NOMINAL.iter().position(|nominal| nominal == shape).unwrap_or(0);
            let base = nominal(model)[index];
            let unit = [unit(2), unit(1), effort][index].clone();
            let mut told = vec![new("value", base + own[0], deviation(samples, 0), unit)];
            if base > 0.0 {
                told.push(new("relative_change", own[0] / base, deviation(samples, 0) / base, one()));
            }
            told
        }
        Shape::Ripple { .. }
        | Shape::MotorRipple { .. }
        | Shape::PositionFriction { .. }
        | Shape::LoadRipple { .. } => {
            let size = |s: &[f64]| s[0].hypot(s[1]);
            let sizes: Vec<Vec<f64>> = samples.iter().map(|s| vec![size(s)]).collect();
            let unit = if matches!(shape, Shape::MotorRipple { .. }) { one() } else { effort };
            let phase = own[1].atan2(own[0]);
            let phases: Vec<Vec<f64>> = samples
                .iter()
                .map(|s| {
                    let turn = s[1].atan2(s[0]) - phase;
                    vec![turn.sin().atan2(turn.cos())]
                })
                .collect();
            vec![
                new("amplitude", size(own), deviation(&sizes, 0), unit),
                new("phase_rad", phase, deviation(&phases, 0), "rad".to_owned()),
            ]
        }
        Shape::Scale | Shape::LoadDependence => vec![amplitude("relative", one())],
        Shape::Lag | Shape::RateDelay => vec![amplitude("time_s", "s".to_owned())],
        Shape::Quadratic => vec![amplitude("coefficient", format!("{effort} s2/{length}2"))],
        Shape::ViscousCurve { .. } => vec![amplitude("coefficient", format!("{effort} (s/{length})^exponent"))],
        Shape::ViscousDrift { .. } => vec![amplitude("change", unit(1))],
        Shape::Spring => {
            let slack: Vec<Vec<f64>> = samples.iter().map(|s| vec![-s[1] / s[0]]).collect();
            vec![
                amplitude("stiffness", unit(0)),
                new("neutral", motion.middle - own[1] / own[0], deviation(&slack, 0), length.to_owned()),
            ]
        }
        Shape::FrictionTaper => vec![amplitude("stiffness", unit(0))],
        Shape::Flexible => vec![amplitude("coefficient", unit(4))],
        Shape::Backlash { .. } => vec![
            amplitude("inertia_unloaded", unit(2)),
            new("friction_unloaded", own[1], deviation(samples, 1), effort),
        ],
        Shape::LoadGain { .. } => vec![amplitude("relative_per_unit", one())],
        Shape::Load { .. } | Shape::LoadFriction { .. } => {
            vec![amplitude("gain", format!("{effort} per unit"))]
        }
        _ => vec![amplitude("amplitude", effort)],
    };
    if matches!(shape, Shape::Load { .. })
        && let Some(first) = told.first_mut()
    {
        first.value *= model.load_direction;
    }
    for (name, value) in shape.numbers() {
        let (name, value, unit) = match name {
            "wave_number" if motion.rotary => ("waves_per_turn", value, one()),
            "wave_number" => ("wave_length", std::f64::consts::TAU / value, length.to_owned()),
            "rate" => (name, value, format!("{length}/s")),
            "displacement" | "width" => (name, value, length.to_owned()),
            "time_constant" => ("time_constant_s", value, "s".to_owned()),
            _ => (name, value, one()),
        };
        told.push(new(name, value, 0.0, unit));
    }
    told
}

/// Probability that it is something else, by what is left and by how many kinds of effect it took. With thirty kinds
/// at hand, a set of many fits almost anything: each beyond the second is half as likely to be there as to make up for
/// something that the library lacks.
pub(super) fn doubt(left: f64, kinds: usize) -> f64 {
    let of_rest = if left <= LEFT { EVEN_SO } else { (left / (left + HALF_LEFT)).max(EVEN_SO) };
    let known = (1.0 - of_rest) * (0..kinds.saturating_sub(SURE_KINDS)).fold(1.0, |known, _| known * EACH_KIND);
    (1.0 - known).clamp(0.005, 0.98)
}

/// Probabilities of sets: how often each is the best when blocks are drawn anew.
fn rank(balance: &Balance, best: &Set, times: &[Vec<f64>], shrunk: &Shrunk, model: &AxisModel) -> (Vec<Ranked>, f64) {
    let mut sets = balance.problem.beside(best);
    sets.push(best.clone());
    sets.sort_by(|a, b| a.square().total_cmp(&b.square()));
    let mut kinds: Vec<(Vec<String>, Vec<Set>)> = Vec::new();
    for set in sets {
        let names = names(balance, &set.members, model);
        match kinds.iter_mut().find(|(other, _)| *other == names) {
            Some((_, sets)) if sets.len() < 3 => sets.push(set),
            Some(_) => {}
            None => kinds.push((names, vec![set])),
        }
    }
    let rows: f64 = balance.problem.grams.counts.iter().sum::<f64>().max(1.0);
    let floor_square = balance.problem.floor_square;
    // an effect more must earn half of what it must in the search
    let each = balance.problem.price().max(0.5 * LEAST_OF_REST * (best.square() - floor_square).max(0.0));
    let cost = |set: &Set| each * balance.problem.effects(&set.members) as f64;
    // sets that differ in a small share of what is left, which no effect explains, are not told apart by it
    let same = SAME * (best.square() - floor_square).max(LEAST_SAME * best.square()).max(1e-300);
    let costs: Vec<Vec<f64>> = kinds.iter().map(|(_, sets)| sets.iter().map(cost).collect()).collect();
    let mut wins = vec![0.0; kinds.len()];
    for times in times {
        let drawn: f64 = balance.problem.grams.counts.iter().zip(times).map(|(c, t)| c * t).sum::<f64>().max(1.0);
        let score = |(set, cost): (&Set, &f64)| {
            let square: f64 = set.held_out.iter().zip(times).map(|(s, t)| s * t).sum();
            square * rows / drawn + cost
        };
        let scores: Vec<f64> = kinds
            .iter()
            .zip(&costs)
            .map(|((_, sets), costs)| sets.iter().zip(costs).map(score).fold(f64::MAX, f64::min))
            .collect();
        let least = scores.iter().copied().fold(f64::MAX, f64::min);
        let weights: Vec<f64> = scores.iter().map(|score| (-(score - least) / same).exp()).collect();
        let sum: f64 = weights.iter().sum();
        wins.iter_mut().zip(&weights).for_each(|(wins, weight)| *wins += weight / sum);
    }
    let left = (shrunk.after.powi(2) - shrunk.noise_floor.powi(2)).max(0.0)
        / (shrunk.before.powi(2) - shrunk.noise_floor.powi(2)).max(1e-300);
    let kinds_named = names(balance, &best.members, model).len();
    let unknown = if kinds_named == 0 { 0.0 } else { doubt(left, kinds_named) };
    let total = wins.iter().sum::<f64>() + 1.0;
    let mut ranking: Vec<Ranked> = kinds
        .into_iter()
        .zip(wins)
        .filter(|(_, wins)| *wins > 0.5)
        .map(|((effects, _), wins)| Ranked { effects, probability: wins / total * (1.0 - unknown) })
        .collect();
    ranking.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let sum: f64 = ranking.iter().map(|set| set.probability).sum();
    (ranking, 1.0 - sum)
}
