//! A set of effects fitted to the outputs themselves: Gauss-Newton on predictions, nominal parameters and beginning
//! along with it.

use std::borrow::Cow;

use gimbal_plant::{Bound, Effect};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::normal::{products, slices, solve};
use super::problem::{STATE_STEP, difference, remembered_rows, residual};
use super::{Problem, Set};
use crate::library::apply;
use crate::simulate::{Begin, Physics, Prediction, predict};

/// Most iterations.
const ITERATIONS: usize = 12;
const QUICK_ITERATIONS: usize = 5;
/// How often sensitivities to the nominal parameters are taken anew.
const REFRESHES: usize = 2;
/// Share of the excess that is put down to the equations being linearised, as noise, while a fit is under way.
const LINEARISED: f64 = 0.002;
/// Step of a sensitivity to a value, in its logarithm or over its size.
const STEP: f64 = 2e-3;
/// Standard deviation of the logarithm of a parameter that is not a size.
const SHAPE_SIGMA: f64 = 1.2;

/// A set of effects, fitted.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Candidates, as the set had them.
    pub set: Set,
    /// Their names.
    pub effects: Vec<&'static str>,
    /// Values of each effect.
    pub values: Vec<Vec<f64>>,
    /// Standard errors of the values.
    pub errors: Vec<Vec<f64>>,
    /// Shifts of the nominal parameters.
    pub shifts: Vec<f64>,
    /// Where the run begins.
    pub begin: Begin,
    /// The platform as fitted.
    pub physics: Physics,
    /// What it predicts.
    pub prediction: Prediction,
    /// Whitened residual.
    pub residual: Vec<f64>,
    /// Square of the whitened residual.
    pub square: f64,
    /// Square of the shifts over their priors.
    pub prior: f64,
    /// What the evidence has beside both: volume of the parameters, cost of the search [nats].
    pub volume: f64,
    /// Sensitivities to the values at the end, whitened, with the values' places.
    pub sensitivities: Vec<Vec<f64>>,
}

/// One value that is fitted beside the nominal parameters.
#[derive(Debug, Clone, Copy)]
struct Free {
    effect: usize,
    value: usize,
    /// Fitted in its logarithm.
    log: bool,
    sigma: f64,
    center: f64,
}

/// Fits a set from the values given, and from the nominal parameters and the beginning of another fit; a thorough
/// one takes all sensitivities where it ends before it stops.
#[must_use]
pub fn refine(problem: &Problem, set: &Set, start: &[Vec<f64>], from: Option<&Fit>, thorough: bool) -> Fit {
    let mut values = start.to_vec();
    let mut shifts = from.map_or_else(|| vec![0.0; problem.nuisances.len()], |fit| fit.shifts.clone());
    let mut state = from.map_or_else(|| vec![0.0; problem.columns.begin], |fit| state_of(problem, fit));
    let free = free(problem, set, &values);
    let (fixed, precision) = fixed(problem, set);
    let mut now = evaluate(problem, set, &values, &shifts, &state);
    let priors = |values: &[Vec<f64>], shifts: &[f64], state: &[f64]| {
        let pull = Pull::new(problem, &precision, shifts);
        let begin: f64 = state.iter().zip(&precision).map(|(value, precision)| value * value * precision).sum();
        begin + pull.cost + shape_prior(&free, values)
    };
    let mut power = square(&now.1);
    let mut last = None;
    let limits = limits(problem, &precision);
    let mut base = Linear::of(problem);
    let mut refreshed = 0;
    for _ in 0..if thorough { ITERATIONS } else { QUICK_ITERATIONS } {
        let excess = power - problem.whitener.count() as f64;
        let temper = (LINEARISED * excess).max(1.0);
        let cost = power / temper + priors(&values, &shifts, &state);
        let columns: Vec<Vec<f64>> =
            free.iter().map(|free| sensitivity(problem, set, &values, &shifts, &state, free, &now.0)).collect();
        let (mut gram, mut drive) = base.joined(&columns, &now.1);
        let mut weights = Vec::new();
        gram /= temper;
        drive /= temper;
        for (place, value) in state.iter().enumerate() {
            drive[place] -= precision[place] * value;
        }
        for (index, free) in free.iter().enumerate() {
            let weight = 1.0 / (free.sigma * free.sigma);
            let off = value_of(free, &values) - free.center;
            drive[fixed + index] -= weight * off;
            weights.push(weight);
        }
        let equations = Equations { gram: &gram, drive: &drive, precision: &precision, weights: &weights };
        let Some(solution) = step(problem, &equations, &shifts, state.len(), &limits) else { break };
        let mut share = 1.0;
        let mut better = false;
        let mut poor = true;
        for _ in 0..4 {
            let step = &solution.coefficients * share;
            let (next_values, next_shifts, next_state) = moved(&free, &values, &shifts, &state, &step, &limits);
            let next = evaluate(problem, set, &next_values, &next_shifts, &next_state);
            let next_power = square(&next.1);
            let next_cost = next_power / temper + priors(&next_values, &next_shifts, &next_state);
            if next_cost < cost {
                better = cost - next_cost > 0.3 || (LINEARISED * excess) > 1.0 && next_power < 0.9 * power;
                // what the linear equations promised
                let promised = solution.gain * share * (2.0 - share);
                poor = cost - next_cost < 0.6 * promised && promised > 4.0;
                (values, shifts, state, now, power) = (next_values, next_shifts, next_state, next, next_power);
                break;
            }
            share *= 0.3;
        }
        last = Some((solution, columns));
        if thorough && (poor || !better && refreshed == 0) && refreshed < REFRESHES {
            refreshed += 1;
            base = Linear::fresh(problem, set, &values, &shifts, &state, &now.0);
        } else if !better {
            break;
        }
    }
    let prior = priors(&values, &shifts, &state);
    finish(problem, set, &free, Parts { values, shifts, state, now, prior, last })
}

/// Normal equations of a step, but for the pull of the priors of the nominal parameters.
struct Equations<'a> {
    gram: &'a DMatrix<f64>,
    drive: &'a DVector<f64>,
    /// Of the beginning and the nominal parameters.
    precision: &'a [f64],
    /// Precisions of the rest.
    weights: &'a [f64],
}

/// Which walls the step ends behind decides which pull: solved until that stands.
fn step(
    problem: &Problem,
    equations: &Equations,
    shifts: &[f64],
    state: usize,
    limits: &[f64],
) -> Option<super::Solution> {
    let mut ahead = shifts.to_vec();
    let mut held: Vec<Option<f64>> = vec![None; shifts.len()];
    let mut solution = None;
    for _ in 0..6 {
        let pull = Pull::ahead(problem, equations.precision, shifts, &ahead);
        let mut drive = equations.drive.clone();
        let mut curvature = pull.curvature.clone();
        for (place, slope) in pull.slope.iter().enumerate() {
            drive[state + place] -= slope;
            if let Some(limit) = held[place] {
                let hold = 1e6 * curvature[place];
                drive[state + place] += hold * (limit - shifts[place]);
                curvature[place] += hold;
            }
        }
        let weights: Vec<f64> = equations.precision[..state]
            .iter()
            .chain(&curvature)
            .copied()
            .chain(equations.weights.iter().copied())
            .collect();
        let chosen: Vec<usize> = (0..weights.len()).collect();
        let Some(found) = solve(equations.gram, &drive, &chosen, &weights) else { break };
        let next: Vec<f64> =
            shifts.iter().enumerate().map(|(place, shift)| shift + found.coefficients[state + place]).collect();
        let mut same = next
            .iter()
            .zip(&ahead)
            .zip(&problem.nuisances)
            .all(|((next, ahead), nuisance)| ahead.abs() > nuisance.tolerance || next.abs() <= nuisance.tolerance);
        for (place, next) in next.iter().enumerate() {
            if held[place].is_none() && next.abs() > limits[place] {
                held[place] = Some(limits[place].copysign(*next));
                same = false;
            }
        }
        solution = Some(found);
        // a wall that was met stays for this step
        for ((ahead, next), nuisance) in ahead.iter_mut().zip(next).zip(&problem.nuisances) {
            if ahead.abs() <= nuisance.tolerance {
                *ahead = next;
            }
        }
        if same {
            break;
        }
    }
    solution
}

impl Fit {
    /// Logarithm of the evidence when the residual counts `1 / temper`, up to what all fits of the log share.
    #[must_use]
    pub fn evidence(&self, temper: f64) -> f64 {
        -0.5 * self.square / temper - 0.5 * self.prior + self.volume
    }
}

impl Fit {
    /// Whether the size of a member of the set is zero within three standard errors.
    #[must_use]
    pub fn is_idle(&self, place: usize) -> bool {
        let sizes = gimbal_plant::Effect::from_name(self.effects[place]).map_or(1, Effect::sizes);
        self.values[place].iter().zip(&self.errors[place]).take(sizes).all(|(value, error)| value.abs() < 3.0 * error)
    }
}

/// The prediction of a fit whose parameters are corrected by leaving blocks out: one step of Gauss-Newton.
#[must_use]
pub fn refit(problem: &Problem, fit: &Fit, out: &[usize]) -> Prediction {
    let (fixed, precision) = fixed(problem, &fit.set);
    let rows = fit.residual.len();
    // the beginning is the log's own and stays
    let begin = problem.columns.begin;
    let mut columns = slices(&problem.whitened[begin..fixed]);
    columns.extend(slices(&fit.sensitivities));
    let free = free(problem, &fit.set, &fit.values);
    let pull = Pull::new(problem, &precision, &fit.shifts);
    let mut weights = pull.curvature;
    weights.extend(free.iter().map(|free| 1.0 / (free.sigma * free.sigma)));
    let n = columns.len();
    let (mut gram, mut drive) = (DMatrix::zeros(n, n), DVector::zeros(n));
    for block in (0..super::BLOCKS).filter(|block| !out.contains(block)) {
        let range = block * rows / super::BLOCKS..(block + 1) * rows / super::BLOCKS;
        gram += products(&columns, &columns, range.clone());
        drive += products(&columns, &[&fit.residual], range).column(0);
    }
    let excess = fit.square - problem.whitener.count() as f64;
    let temper = (LINEARISED * excess).max(1.0);
    gram /= temper;
    drive /= temper;
    for (place, slope) in pull.slope.iter().enumerate() {
        drive[place] -= slope;
    }
    let chosen: Vec<usize> = (0..n).collect();
    let Some(solution) = solve(&gram, &drive, &chosen, &weights) else { return fit.prediction.clone() };
    let limits = vec![f64::MAX; fit.shifts.len()];
    let mut step = DVector::zeros(begin + n);
    step.rows_mut(begin, n).copy_from(&solution.coefficients);
    let state = state_of(problem, fit);
    let (values, shifts, state) = moved(&free, &fit.values, &fit.shifts, &state, &step, &limits);
    evaluate(problem, &fit.set, &values, &shifts, &state).0
}

/// Takes the sensitivities to the nominal parameters where a fit ended.
pub(crate) fn rebase(problem: &mut Problem, fit: &Fit) {
    let state = state_of(problem, fit);
    let linear = Linear::fresh(problem, &fit.set, &fit.values, &fit.shifts, &state, &fit.prediction);
    let columns = linear.columns.into_owned();
    problem.replace(columns);
}

/// What one effect of a fit contributes, whitened.
#[must_use]
pub fn without(problem: &Problem, fit: &Fit, place: usize) -> Vec<f64> {
    let mut set = fit.set.clone();
    let mut values = fit.values.clone();
    let index = set.0.remove(place);
    values.remove(place);
    let mut shifts = fit.shifts.clone();
    for release in problem.candidates[index].releases {
        if let Some(nuisance) = problem.nuisances.iter().position(|nuisance| nuisance.name == *release) {
            shifts[nuisance] = 0.0;
        }
    }
    let physics = physics(problem, &set, &values, &shifts);
    let prediction = predict(&physics, &problem.record.inputs, &fit.begin, usize::MAX);
    problem.whiten(difference(problem.record, &fit.prediction, &prediction, 1.0))
}

/// How far the beginning of a fit is from the first guess.
fn state_of(problem: &Problem, fit: &Fit) -> Vec<f64> {
    fit.begin.state.iter().zip(&problem.begin.state).take(problem.columns.begin).map(|(a, b)| a - b).collect()
}

struct Parts {
    values: Vec<Vec<f64>>,
    shifts: Vec<f64>,
    state: Vec<f64>,
    now: (Prediction, Vec<f64>),
    prior: f64,
    last: Option<(super::Solution, Vec<Vec<f64>>)>,
}

fn finish(problem: &Problem, set: &Set, free: &[Free], parts: Parts) -> Fit {
    let Parts { mut values, shifts, state, now, prior, last } = parts;
    let mut errors: Vec<Vec<f64>> = values.iter().map(|values| vec![0.0; values.len()]).collect();
    let mut volume = f64::NEG_INFINITY;
    let mut sensitivities = Vec::new();
    if let Some((solution, columns)) = last {
        let fixed = problem.columns.begin + problem.columns.nuisances;
        for (index, free) in free.iter().enumerate() {
            let sigma = solution.covariance[(fixed + index, fixed + index)].max(0.0).sqrt();
            errors[free.effect][free.value] =
                if free.log { sigma * values[free.effect][free.value].abs() } else { sigma };
        }
        for (effect, &index) in set.0.iter().enumerate() {
            for (place, release) in problem.candidates[index].releases.iter().enumerate() {
                if let Some(nuisance) = problem.nuisances.iter().position(|nuisance| nuisance.name == *release) {
                    let column = problem.columns.begin + nuisance;
                    let own = &problem.nuisances[nuisance];
                    let sigma = solution.covariance[(column, column)].max(0.0).sqrt();
                    values[effect][place] = own.change(shifts[nuisance]);
                    errors[effect][place] = own.change(shifts[nuisance] + sigma) - values[effect][place];
                }
            }
        }
        let (_, precision) = self::fixed(problem, set);
        volume = solution.evidence - 0.5 * solution.gain - Pull::new(problem, &precision, &shifts).walls;
        sensitivities = columns;
    }
    for &index in &set.0 {
        volume -= (problem.candidates[index].siblings as f64).ln();
    }
    let begin = begin(problem, &state);
    let physics = physics(problem, set, &values, &shifts);
    let square = square(&now.1);
    Fit {
        set: set.clone(),
        effects: set.0.iter().map(|&index| problem.candidates[index].effect).collect(),
        values,
        errors,
        shifts,
        begin,
        physics,
        prediction: now.0,
        residual: now.1,
        square,
        prior,
        volume,
        sensitivities,
    }
}

/// The platform with a set of effects and shifted parameters.
fn physics(problem: &Problem, set: &Set, values: &[Vec<f64>], shifts: &[f64]) -> Physics {
    let mut physics = problem.base.clone();
    for (nuisance, shift) in problem.nuisances.iter().zip(shifts) {
        nuisance.shift(&mut physics, *shift);
    }
    for (&index, values) in set.0.iter().zip(values) {
        let candidate = &problem.candidates[index];
        if candidate.releases.is_empty() {
            apply(candidate.effect, values, &mut physics);
        }
    }
    physics
}

fn begin(problem: &Problem, state: &[f64]) -> Begin {
    let mut begin = problem.begin.clone();
    for (place, shift) in begin.state.iter_mut().zip(state) {
        *place += shift;
    }
    begin
}

fn evaluate(
    problem: &Problem,
    set: &Set,
    values: &[Vec<f64>],
    shifts: &[f64],
    state: &[f64],
) -> (Prediction, Vec<f64>) {
    let physics = physics(problem, set, values, shifts);
    let prediction = predict(&physics, &problem.record.inputs, &begin(problem, state), usize::MAX);
    let whitened = problem.whiten(residual(problem.record, &prediction));
    (prediction, whitened)
}

fn sensitivity(
    problem: &Problem,
    set: &Set,
    values: &[Vec<f64>],
    shifts: &[f64],
    state: &[f64],
    free: &Free,
    now: &Prediction,
) -> Vec<f64> {
    let mut moved = values.to_vec();
    let value = &mut moved[free.effect][free.value];
    let step = if free.log {
        *value *= STEP.exp();
        STEP
    } else {
        let step = STEP * value.abs().max(free.sigma);
        *value += step;
        step
    };
    let physics = physics(problem, set, &moved, shifts);
    let prediction = predict(&physics, &problem.record.inputs, &begin(problem, state), usize::MAX);
    problem.whiten(difference(problem.record, &prediction, now, step))
}

/// The values that are fitted on their own.
fn free(problem: &Problem, set: &Set, start: &[Vec<f64>]) -> Vec<Free> {
    let mut all = Vec::new();
    for (effect, &index) in set.0.iter().enumerate() {
        let candidate = &problem.candidates[index];
        let Some(entry) = Effect::from_name(candidate.effect).filter(|_| candidate.releases.is_empty()) else {
            continue;
        };
        for (value, parameter) in entry.parameters().iter().enumerate() {
            let log = parameter.bound != Bound::Any && start[effect][value] > 0.0;
            let size = value < entry.sizes();
            let own = start[effect][value];
            let spread = 0.5 * parameter.low.abs().max(parameter.high.abs());
            let free = if log {
                Free { effect, value, log, sigma: SHAPE_SIGMA, center: own.ln() }
            } else if size {
                Free { effect, value, log, sigma: spread.max(own.abs()), center: 0.0 }
            } else {
                // cycles and phases move little from where they were found
                let sigma = if parameter.unit == "rad" { 1.0 } else { 0.02 * own.abs().max(1.0) };
                Free { effect, value, log, sigma, center: own }
            };
            all.push(free);
        }
    }
    all
}

fn value_of(free: &Free, values: &[Vec<f64>]) -> f64 {
    let value = values[free.effect][free.value];
    if free.log { value.ln() } else { value }
}

fn shape_prior(free: &[Free], values: &[Vec<f64>]) -> f64 {
    free.iter().map(|free| ((value_of(free, values) - free.center) / free.sigma).powi(2)).sum()
}

/// Number of columns of beginning and nominal parameters, and their precisions under the set.
fn fixed(problem: &Problem, set: &Set) -> (usize, Vec<f64>) {
    let fixed = problem.columns.begin + problem.columns.nuisances;
    let (_, precision) = problem.chosen(&set.0);
    (fixed, precision[..fixed].to_vec())
}

/// How far nominal parameters may go: little beyond their tolerance, or as far as a release lets them.
fn limits(problem: &Problem, precision: &[f64]) -> Vec<f64> {
    let released = |place: usize| 1.0 / precision[problem.columns.begin + place].sqrt();
    let of = |(place, nuisance): (usize, &crate::library::Nuisance)| {
        if released(place) > 1.01 * nuisance.sigma { (6.0 * released(place)).min(0.8) } else { 4.0 * nuisance.sigma }
    };
    problem.nuisances.iter().enumerate().map(of).collect()
}

/// The priors of the nominal parameters at their shifts; a released one has a plain one.
pub(crate) struct Pull {
    /// Half the slope of the cost.
    pub(crate) slope: Vec<f64>,
    /// Half its curvature.
    pub(crate) curvature: Vec<f64>,
    /// Cost of all.
    pub(crate) cost: f64,
    /// What walls add to the logarithm of the precision [nats].
    pub(crate) walls: f64,
}

impl Pull {
    pub(crate) fn new(problem: &Problem, precision: &[f64], shifts: &[f64]) -> Self {
        Self::ahead(problem, precision, shifts, shifts)
    }

    /// The same with the walls that stand at other shifts, those that a step ends at.
    fn ahead(problem: &Problem, precision: &[f64], shifts: &[f64], ahead: &[f64]) -> Self {
        let mut pull = Self { slope: Vec::new(), curvature: Vec::new(), cost: 0.0, walls: 0.0 };
        for (place, (nuisance, shift)) in problem.nuisances.iter().zip(shifts).enumerate() {
            let own = precision[problem.columns.begin + place];
            let flat = 1.0 / (nuisance.sigma * nuisance.sigma);
            let released = own < 0.98 * flat;
            let (slope, curvature, cost) =
                if released { (own * shift, own, own * shift * shift) } else { nuisance.prior(*shift, ahead[place]) };
            pull.slope.push(slope);
            pull.curvature.push(curvature);
            pull.cost += cost;
            if !released {
                pull.walls += 0.5 * (curvature / flat).ln();
            }
        }
        pull
    }
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

/// Sensitivities to the beginning and to the nominal parameters, and their Gram matrix.
struct Linear<'a> {
    columns: Cow<'a, [Vec<f64>]>,
    gram: DMatrix<f64>,
}

impl<'a> Linear<'a> {
    /// Those of the nominal platform.
    fn of(problem: &'a Problem) -> Self {
        let fixed = problem.columns.begin + problem.columns.nuisances;
        let gram = problem.gram.view((0, 0), (fixed, fixed)).into_owned();
        Self { columns: Cow::Borrowed(&problem.whitened[..fixed]), gram }
    }

    /// Those of the platform as it is fitted now.
    fn fresh(
        problem: &Problem,
        set: &Set,
        values: &[Vec<f64>],
        shifts: &[f64],
        state: &[f64],
        now: &Prediction,
    ) -> Self {
        let inputs = &problem.record.inputs;
        let fixed = problem.columns.begin + problem.columns.nuisances;
        let column = |place: usize| {
            let (mut shifts, mut state) = (shifts.to_vec(), state.to_vec());
            let step = if place < state.len() {
                let step = STATE_STEP * problem.sigma[place];
                state[place] += step;
                step
            } else {
                let step = problem.nuisances[place - state.len()].step;
                shifts[place - state.len()] += step;
                step
            };
            // what changes at the beginning alone dies away
            let rows = if place < 9 { remembered_rows(problem.record) } else { usize::MAX };
            let moved = predict(&physics(problem, set, values, &shifts), inputs, &begin(problem, &state), rows);
            problem.whiten(difference(problem.record, &moved, now, step))
        };
        let columns: Vec<Vec<f64>> = (0..fixed).into_par_iter().map(column).collect();
        let gram = products(&slices(&columns), &slices(&columns), 0..problem.whitener.rows());
        Self { columns: Cow::Owned(columns), gram }
    }

    /// Normal equations of these columns and others.
    fn joined(&self, others: &[Vec<f64>], residual: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let fixed = self.columns.len();
        let more = others.len();
        let mut columns = slices(&self.columns);
        columns.extend(slices(others));
        let mut right = slices(others);
        right.push(residual);
        let fresh = products(&columns, &right, 0..residual.len());
        let mut gram = DMatrix::zeros(fixed + more, fixed + more);
        gram.view_mut((0, 0), (fixed, fixed)).copy_from(&self.gram);
        gram.columns_mut(fixed, more).copy_from(&fresh.columns(0, more));
        gram.view_mut((fixed, 0), (more, fixed)).copy_from(&fresh.view((0, 0), (fixed, more)).transpose());
        (gram, fresh.column(more).into_owned())
    }
}

fn moved(
    free: &[Free],
    values: &[Vec<f64>],
    shifts: &[f64],
    state: &[f64],
    step: &DVector<f64>,
    limits: &[f64],
) -> (Vec<Vec<f64>>, Vec<f64>, Vec<f64>) {
    let mut next = values.to_vec();
    let fixed = state.len() + shifts.len();
    for (index, free) in free.iter().enumerate() {
        let step = step[fixed + index];
        let value = &mut next[free.effect][free.value];
        if free.log {
            *value *= step.clamp(-1.0, 1.0).exp();
        } else {
            *value += step;
        }
    }
    let state_next = state.iter().enumerate().map(|(index, value)| value + step[index]).collect();
    let shifts_next = shifts
        .iter()
        .enumerate()
        .map(|(index, value)| (value + step[state.len() + index]).clamp(-limits[index], limits[index]))
        .collect();
    (next, shifts_next, state_next)
}
