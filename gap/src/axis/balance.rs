//! The balance of an axis: what the effort is, over what the nominal model needs, and every effect that could fill it.

use gimbal_model_file::AxisModel;

use super::floor::floor_left;
use super::judge::BEYOND;
use super::library::{NOMINAL, Shape, rms};
use super::motion::Motion;
use super::plain::{Needs, columns as columns_of, nominal, nominally, rounded, tolerated_shifts};
use super::play::plays;
use super::regress::Grams;
use super::resonance::modes;
use super::search::{Candidate, LEAST_SHARE, Problem, Set};
use super::slip::Slip;
use super::tried::shapes;
use super::waves::waves;

/// A column must keep this share of its power beside the nominal parameters, and this much through the band.
const LEAST_KEPT: f64 = 1e-4;
const LEAST_PASSED: f64 = 0.02;
/// One that hangs on the effort must keep this much beside all that the effort needed is of: it is the effort in disguise
/// where the axis slips one way only.
const LEAST_ITS_OWN: f64 = 0.01;
/// And no more than this share of its deviation may be noise of the motion.
const MOST_NOISE: f64 = 0.4;
/// Effort and motion are read at moments apart: by so much [s], or this share of a row.
const APART_S: f64 = 1.5e-4;
const APART_ROWS: f64 = 0.5;
/// Effects that need this share of the effort are looked at as what other effects hang on, too.
const MUCH_NEEDED: f64 = 0.1;
/// A gap is one from this power over that of noise on.
const NOTABLE: f64 = 1.5;

/// One log's balance.
#[derive(Debug)]
pub(super) struct Balance {
    pub(super) motion: Motion,
    /// Effort less nominal model, on the grid.
    pub(super) target: Vec<f64>,
    /// Effort on the grid.
    pub(super) effort: Vec<f64>,
    /// What the effort needed is of.
    pub(super) needs: Needs,
    pub(super) columns: Vec<Vec<f64>>,
    /// What stands in every balance: the nominal parameters, and moments of reading apart where the motion shows them.
    pub(super) base: Vec<Shape>,
    pub(super) problem: Problem,
    /// Effects that this motion cannot show.
    pub(super) hidden: Vec<&'static str>,
    /// Whether effort and rate have one sign throughout: a dead zone is then friction.
    pub(super) dead_zone_is_friction: bool,
}

impl Balance {
    /// The balance in which effects and friction's corner were found, and those effects. Effort and motion that seem to be
    /// read further apart than they are have an effect to show.
    pub(super) fn searched(motion: Motion, model: &AxisModel) -> (Self, Set) {
        let (balance, set) = Self::with_its_corner(motion.clone(), model);
        if balance.reads_as_one(&set) {
            return (balance, set);
        }
        Self::with_its_corner(Motion { apart: false, ..motion }, model)
    }

    /// Whether the moments of reading are no further apart beside a set than they may be.
    fn reads_as_one(&self, set: &Set) -> bool {
        let (_, amplitudes) = self.fit(&set.members);
        self.base.len() == NOMINAL.len() || amplitudes[NOMINAL.len()].abs() <= 2.0 * apart_s(&self.motion)
    }

    /// An effect that the nominal parameters lack may look like a rounder corner of friction: where another one leaves less
    /// beside what is found, all is looked for once more.
    fn with_its_corner(motion: Motion, model: &AxisModel) -> (Self, Set) {
        let (balance, set) = Self::with_either_corner(&motion, model);
        // plain least squares have the nominal parameters already
        let added = |shape: &&Shape| **shape != Shape::Scale && !NOMINAL.contains(shape) && !shape.hangs_on_effort();
        let shapes = set.members.iter().map(|&member| &balance.problem.candidates[member].shape);
        let found: Vec<Shape> = shapes.filter(added).cloned().collect();
        if found.is_empty() {
            return (balance, set);
        }
        let beside = rounded(motion, &found);
        let as_round = beside.0.corner == balance.motion.corner;
        if as_round && beside.1.share_of_effects(&beside.0) < MUCH_NEEDED {
            return (balance, set);
        }
        let again = Self::new(beside, model, &found);
        again.or_nearer(model, (balance, set))
    }

    /// The balance with the corner that leaves least, or with a sharp one where effects explain more: friction that goes on to
    /// rise with a power of the rate looks like a round corner.
    fn with_either_corner(motion: &Motion, model: &AxisModel) -> (Self, Set) {
        let mut round = Self::new(rounded(motion.clone(), &[]), model, &[]);
        let of_round = round.search(model);
        if round.motion.corner == motion.corner || round.problem.effects(&of_round.members) == 0 {
            return (round, of_round);
        }
        let (needs, rest) = nominally(motion);
        let sharp = Self::new((motion.clone(), needs, rest), model, &[]);
        sharp.or_nearer(model, (round, of_round))
    }

    /// This balance and what it shows, or another that explains as much with fewer effects, or more.
    fn or_nearer(mut self, model: &AxisModel, other: (Self, Set)) -> (Self, Set) {
        let own = self.search(model);
        if self.problem.key(&own) < other.0.problem.key(&other.1) { (self, own) } else { other }
    }

    /// Makes the balance and every column, friction's corner as it is beside some effects.
    fn new((mut motion, found, rest): (Motion, Needs, f64), model: &AxisModel, beside: &[Shape]) -> Self {
        let needs = if motion.stands { Needs::friction(model.coulomb) } else { found };
        motion.needed = needs.at(&motion);
        motion.size = rms(&motion.needed).max(1e-30);
        let needed_of = (!beside.is_empty()).then(|| columns_of(&motion, beside));
        let mut base: Vec<Shape> = NOMINAL.to_vec();
        let mut columns: Vec<Vec<f64>> = base.iter().flat_map(|shape| shape.on_grid(&motion)).collect();
        let effort = motion.raw(&motion.effort);
        let parameters = nominal(model);
        let target: Vec<f64> = (0..effort.len())
            .map(|row| effort[row] - (0..3).map(|place| parameters[place] * columns[place][row]).sum::<f64>())
            .collect();
        if motion.apart {
            let apart = Shape::Lag.on_grid(&motion);
            if shows(&Shape::Lag, &apart, &motion, model) {
                base.push(Shape::Lag);
                columns.extend(apart);
            }
        }
        let mut candidates: Vec<Candidate> = Vec::new();
        let mut hidden: Vec<&'static str> = Vec::new();
        let mut tried = shapes(&motion);
        let parameters_alone = &columns[..NOMINAL.len()];
        tried.extend(waves(&motion, &target, parameters_alone));
        if !motion.stands {
            tried.extend(modes(&motion, &target, parameters_alone));
            if stands_out(&target, &motion) {
                tried.extend(plays(&motion, &target, parameters_alone));
            }
        }
        tried.retain(|shape| !model.trusts(shape.effect()));
        let made: Vec<(Shape, Vec<Vec<f64>>)> = {
            use rayon::prelude::*;
            tried
                .into_par_iter()
                .map(|shape| {
                    let grid = shape.on_grid(&motion);
                    (shape, grid)
                })
                .collect()
        };
        for (shape, grid) in made {
            if !shows(&shape, &grid, &motion, model) {
                hidden.push(shape.effect());
                continue;
            }
            let start = columns.len();
            columns.extend(grid);
            candidates.push(Candidate { shape, columns: (start..columns.len()).collect() });
        }
        let made_dead = candidates.iter().any(|candidate| candidate.shape == Shape::DeadZone);
        let mut grams = Grams::new(&columns, &target, &motion.block);
        candidates.retain(|candidate| {
            let released = candidate.shape == Shape::Scale || NOMINAL.contains(&candidate.shape);
            let parameters: Vec<usize> = (0..NOMINAL.len()).collect();
            let kept = candidate.columns.iter().map(|&column| grams.keeps(column, &parameters)).fold(0.0, f64::max);
            let disguised = needed_of.as_ref().filter(|_| candidate.shape.hangs_on_effort()).is_some_and(|others| {
                let own = candidate.columns.iter().map(|&column| columns[column].clone());
                own.map(|column| kept_of(column, others, &motion)).fold(0.0, f64::max) < LEAST_ITS_OWN
            });
            let shows = released || kept > LEAST_KEPT && !disguised;
            if !shows {
                hidden.push(candidate.shape.effect());
            }
            shows
        });
        let dead = |candidate: &Candidate| candidate.shape == Shape::DeadZone;
        let dead_zone_is_friction = made_dead && !candidates.iter().any(dead);
        hidden.sort_unstable();
        hidden.dedup();
        hidden.retain(|effect| !candidates.iter().any(|candidate| candidate.shape.effect() == *effect));
        set_priors(&mut grams, model, &base, rest, &motion, 0);
        let floor_square = motion.floor.powi(2) * target.len() as f64;
        let effort_square = effort.iter().map(|u| u * u).sum();
        let slip = Slip::new(&motion, parameters, &columns, &candidates);
        let problem = Problem {
            base: (0..base.len()).collect(),
            candidates,
            grams,
            floor_square,
            effort_square,
            least_share: LEAST_SHARE,
            nominal: Some(parameters),
            slip,
            travel: motion.travel,
            within: within(model),
        };
        Self { motion, target, effort, needs, columns, base, problem, hidden, dead_zone_is_friction }
    }

    /// Searches, takes the priors from what is then left, refines the shapes, and searches again. Nothing is found in what
    /// is no more than noise.
    fn search(&mut self, model: &AxisModel) -> Set {
        let mut best = self.problem.search(Vec::new());
        for _ in 0..2 {
            let residual = self.residual(&best.members);
            self.motion.floor = floor_left(&self.motion, &residual);
            self.problem.floor_square = self.motion.floor.powi(2) * residual.len() as f64;
            let rest = rms(&residual);
            let lag = correlation(&residual);
            set_priors(&mut self.problem.grams, model, &self.base, rest, &self.motion, lag);
            self.refine(&best.members);
            best = self.problem.search(best.members);
        }
        if self.has_gap() { best } else { self.problem.set(Vec::new()) }
    }

    /// Whether the nominal model leaves more than noise.
    pub(super) fn has_gap(&self) -> bool {
        stands_out(&self.target, &self.motion)
    }

    /// Amplitudes of a set's columns.
    pub(super) fn fit(&self, members: &[usize]) -> (Vec<usize>, Vec<f64>) {
        let columns = self.problem.columns(members);
        let amplitudes = self.problem.grams.fit(&columns);
        (columns, amplitudes)
    }

    /// Shift of each nominal parameter by amplitudes of a set's columns.
    pub(super) fn shifts(&self, members: &[usize], columns: &[usize], amplitudes: &[f64]) -> [f64; 3] {
        let mut shifts = [amplitudes[0], amplitudes[1], amplitudes[2]];
        for &member in members {
            let candidate = &self.problem.candidates[member];
            if let Some(index) = NOMINAL.iter().position(|nominal| *nominal == candidate.shape) {
                let own = columns.iter().position(|column| *column == candidate.columns[0]);
                shifts[index] += own.map_or(0.0, |place| amplitudes[place]);
            }
        }
        // a taper has its level somewhere on the travel
        for &member in members {
            let candidate = &self.problem.candidates[member];
            if candidate.shape == Shape::FrictionTaper {
                let own = columns.iter().position(|column| *column == candidate.columns[0]);
                let reach = own.map_or(0.0, |place| 0.5 * amplitudes[place].abs() * self.motion.travel);
                shifts[2] -= shifts[2].clamp(-reach, reach);
            }
        }
        shifts
    }

    /// How far noise of the motion may shift inertia and viscous friction: it is in the column and, through the loop, in
    /// the effort. By Cauchy and Schwarz the shift is no more than
    ///
    /// ```text
    /// abs(shift) <= sigma_noise (rms left + floor) / var(column)
    /// ```
    pub(super) fn of_noise(&self) -> [f64; 3] {
        let rows = self.target.len().max(1) as f64;
        let noise = [self.motion.acceleration_noise, self.motion.rate_noise, 0.0];
        let left = rms(&self.residual(&[])).min(2.0 * self.motion.floor) + self.motion.floor;
        std::array::from_fn(|place| {
            let beside: Vec<usize> = (0..3).filter(|other| *other != place).collect();
            let grams = &self.problem.grams;
            let variance = grams.power(place) * grams.keeps(place, &beside) / rows;
            noise[place] * left / variance.max(1e-300)
        })
    }

    /// What a set leaves, on the grid.
    pub(super) fn residual(&self, members: &[usize]) -> Vec<f64> {
        let (columns, amplitudes) = self.fit(members);
        let mut residual = self.target.clone();
        for (&column, amplitude) in columns.iter().zip(&amplitudes) {
            residual.iter_mut().zip(&self.columns[column]).for_each(|(r, value)| *r -= amplitude * value);
        }
        residual
    }
}

/// Whether a balance is more than noise.
fn stands_out(target: &[f64], motion: &Motion) -> bool {
    rms(target).powi(2) > NOTABLE * motion.floor.max(1e-300).powi(2)
}

/// Share of its power that a column keeps beside others.
fn kept_of(column: Vec<f64>, others: &[Vec<f64>], motion: &Motion) -> f64 {
    let all = [others, &[column]].concat();
    let beside: Vec<usize> = (0..others.len()).collect();
    Grams::new(&all, &all[others.len()], &motion.block).keeps(others.len(), &beside)
}

/// Whether a column passes the band, and is no noise of the motion: that regresses on that of the acceleration.
fn shows(shape: &Shape, grid: &[Vec<f64>], motion: &Motion, model: &AxisModel) -> bool {
    let whole = shape.columns(motion).iter().map(|column| rms(&motion.pick(column))).fold(0.0, f64::max);
    let through = grid.iter().map(|column| rms(column)).fold(0.0, f64::max);
    through > LEAST_PASSED * whole && through > 0.0 && noise_of(shape, motion, model) <= MOST_NOISE * through
}

/// Noise that the motion brings into a column of its higher derivatives.
fn noise_of(shape: &Shape, motion: &Motion, model: &AxisModel) -> f64 {
    match shape {
        Shape::Lag => model.inertia * motion.derivative_noise(3),
        Shape::Flexible => motion.derivative_noise(4),
        _ => 0.0,
    }
}

/// Shifts of the nominal parameters that are none.
fn within(model: &AxisModel) -> Vec<f64> {
    tolerated_shifts(model).map(|shift| BEYOND * shift).to_vec()
}

/// Rows over which a residual is correlated.
pub(super) fn correlation(residual: &[f64]) -> usize {
    let mean = residual.iter().sum::<f64>() / residual.len().max(1) as f64;
    let power: f64 = residual.iter().map(|r| (r - mean).powi(2)).sum();
    (1..200.min(residual.len() / 4).max(2))
        .find(|&lag| {
            let product: f64 = residual.iter().zip(&residual[lag..]).map(|(a, b)| (a - mean) * (b - mean)).sum();
            product < 0.2 * power
        })
        .unwrap_or(200)
}

/// By how much effort and motion are read apart, as a standard deviation.
fn apart_s(motion: &Motion) -> f64 {
    APART_S.max(APART_ROWS * motion.period_s)
}

/// Priors of what stands in every balance: tolerances of the nominal parameters, and moments of reading apart, against the
/// noise as correlated as it is.
fn set_priors(grams: &mut Grams, model: &AxisModel, base: &[Shape], rest: f64, motion: &Motion, lag: usize) {
    let variance = rest.max(motion.floor).powi(2) * (1 + 2 * lag) as f64;
    for (place, deviation) in tolerated_shifts(model).into_iter().chain([apart_s(motion)]).enumerate().take(base.len())
    {
        let known = 1e9 * grams.power(place).max(1e-300);
        grams.precision[place] = if deviation > 0.0 { (variance / (deviation * deviation)).min(known) } else { known };
    }
}
