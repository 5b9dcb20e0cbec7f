//! A motion and its effort by the nominal parameters alone: a first look, before any effect.

use gimbal_model_file::AxisModel;

use super::library::{NOMINAL, Shape, rms};
use super::motion::{Corner, Motion};
use super::refine::golden;
use super::regress::Grams;

/// Rate up to which friction may come up to its level, along a line and along a hyperbolic tangent, over the fastest; steps of
/// it; and what a rounder corner must leave at most of the root mean square.
const WIDEST_LINE: f64 = 0.03;
const WIDEST_SMOOTH: f64 = 0.05;
const ROUNDER: f64 = 1.25;
const ROUNDED: f64 = 0.9;

/// Nominal parameters.
pub(super) fn nominal(model: &AxisModel) -> [f64; 3] {
    [model.inertia, model.viscous, model.coulomb]
}

/// How well they are known, relative.
pub(super) fn tolerances(model: &AxisModel) -> [f64; 3] {
    [model.tolerance.inertia, model.tolerance.viscous, model.tolerance.coulomb]
}

/// How far each may be off.
pub(super) fn tolerated_shifts(model: &AxisModel) -> [f64; 3] {
    let (parameters, tolerances) = (nominal(model), tolerances(model));
    std::array::from_fn(|place| tolerances[place] * parameters[place])
}

/// What a motion needs of effort: the nominal parameters and a constant; where something else acts on the axis, gravity for
/// one, all that was found.
#[derive(Debug, Clone)]
pub(super) struct Needs {
    parameters: [f64; 4],
    effects: Vec<(Shape, Vec<f64>)>,
}

impl Needs {
    /// Friction alone.
    pub(super) fn friction(coulomb: f64) -> Self {
        Self { parameters: [0.0, 0.0, coulomb, 0.0], effects: Vec::new() }
    }

    /// The effort, at every row.
    pub(super) fn at(&self, motion: &Motion) -> Vec<f64> {
        let [inertia, viscous, coulomb, constant] = self.parameters;
        let mut needed: Vec<f64> = (0..motion.q.len())
            .map(|i| inertia * motion.a[i] + viscous * motion.v[i] + coulomb * motion.s[i] + constant)
            .collect();
        for (shape, amplitudes) in &self.effects {
            for (column, amplitude) in shape.columns(motion).iter().zip(amplitudes) {
                needed.iter_mut().zip(column).for_each(|(sum, value)| *sum += amplitude * value);
            }
        }
        needed
    }

    /// Share of it that is the effects', by root mean square.
    pub(super) fn share_of_effects(&self, motion: &Motion) -> f64 {
        let effects = Self { parameters: [0.0; 4], effects: self.effects.clone() };
        rms(&effects.at(motion)) / rms(&self.at(motion)).max(1e-300)
    }
}

/// The parameters of a motion by plain least squares, with a constant, and the root mean square of what they leave: a
/// first look, and what effects of the effort hang on.
pub(super) fn plain(motion: &Motion) -> ([f64; 4], f64) {
    let (needs, rest) = nominally(motion);
    (needs.parameters, rest)
}

/// Columns of the nominal parameters, of a constant and of effects.
pub(super) fn columns(motion: &Motion, beside: &[Shape]) -> Vec<Vec<f64>> {
    let mut columns: Vec<Vec<f64>> = NOMINAL.iter().flat_map(|shape| shape.on_grid(motion)).collect();
    columns.push(vec![1.0; motion.rows.len()]);
    columns.extend(beside.iter().flat_map(|shape| shape.on_grid(motion)));
    columns
}

fn fitted(motion: &Motion, beside: &[Shape], effort: &[f64]) -> (Needs, f64) {
    let groups: Vec<Vec<Vec<f64>>> = beside.iter().map(|shape| shape.on_grid(motion)).collect();
    let widths: Vec<usize> = groups.iter().map(Vec::len).collect();
    let mut columns = columns(motion, &[]);
    columns.extend(groups.into_iter().flatten());
    let grams = Grams::new(&columns, effort, &motion.block);
    let all: Vec<usize> = (0..columns.len()).collect();
    let fit = grams.fit(&all);
    let rest = (grams.square_of_fit(&all) / effort.len().max(1) as f64).sqrt();
    let acts = beside.iter().any(|shape| shape.block() == "disturbance");
    let mut amplitudes = fit[4..].iter().copied();
    let own = |(shape, width): (&Shape, usize)| (shape.clone(), amplitudes.by_ref().take(width).collect());
    let effects = if acts { beside.iter().zip(widths).map(own).collect() } else { Vec::new() };
    (Needs { parameters: [fit[0], fit[1], fit[2], fit[3]], effects }, rest)
}

/// How plain least squares explain a motion without effects, and what they leave.
pub(super) fn nominally(motion: &Motion) -> (Needs, f64) {
    fitted(motion, &[], &motion.raw(&motion.effort))
}

/// The motion with the friction that comes up to its level along the corner that explains most beside effects, and how plain
/// least squares explain it then: an axis that creeps to rest has less than all of it, and how much is no effect. Wider than
/// the least only where that leaves a good deal less.
pub(super) fn rounded(mut motion: Motion, beside: &[Shape]) -> (Motion, Needs, f64) {
    let effort = motion.raw(&motion.effort);
    let (sharp, sharp_rest) = fitted(&motion, beside, &effort);
    if motion.stands {
        return (motion, sharp, sharp_rest);
    }
    let (as_it_was, quiet, fastest) = (motion.corner, motion.quiet, motion.fastest);
    let mut left = |corner: Corner| {
        motion.set_corner(corner);
        fitted(&motion, beside, &effort)
    };
    let best =
        [(Corner::Line as fn(f64) -> Corner, WIDEST_LINE), (Corner::Smooth, WIDEST_SMOOTH)].map(|(along, widest)| {
            let rates = std::iter::successors(Some(ROUNDER * quiet), |rate| Some(ROUNDER * rate));
            let mut rest = |rate: f64| left(along(rate)).1;
            let tried = rates.take_while(|rate| *rate < widest * fastest).map(|rate| (rate, rest(rate)));
            let coarse = tried.min_by(|a, b| a.1.total_cmp(&b.1))?;
            let corner = along(golden(coarse.0 / ROUNDER, coarse.0 * ROUNDER, &mut rest));
            let (needs, rest) = left(corner);
            Some((corner, needs, rest))
        });
    let best = best.into_iter().flatten().min_by(|a, b| a.2.total_cmp(&b.2));
    let best = best.filter(|(.., rest)| *rest < ROUNDED * sharp_rest).unwrap_or((as_it_was, sharp, sharp_rest));
    let (corner, needs, rest) = best;
    motion.set_corner(corner);
    (motion, needs, rest)
}

/// Root mean square of what the nominal model leaves.
pub(super) fn nominal_rest(motion: &Motion, model: &AxisModel) -> f64 {
    let base: Vec<Vec<f64>> = NOMINAL.iter().flat_map(|shape| shape.on_grid(motion)).collect();
    let (effort, parameters) = (motion.raw(&motion.effort), nominal(model));
    let rest = |row: usize| effort[row] - (0..3).map(|place| parameters[place] * base[place][row]).sum::<f64>();
    rms(&(0..effort.len()).map(rest).collect::<Vec<_>>())
}
