//! A set of effects fitted to all logs at once: parabolas about where each log stands, the least of their sum, and on
//! from there as long as the true squares fall.

use nalgebra::DVector;
use rayon::prelude::*;

use super::joint::{Joint, Local, prior_cost, solve};
use super::material::Material;
use super::parameters::{Parameter, parameters};
use super::set::Effects;
use crate::fit::{Free, Goes, Hypothesis, Linear, Outcome, Point, linearised};
use crate::judge::pieces;

const ITERATIONS: usize = 10;
/// A step that promises less is not taken; one that brought less is the last [nats, twice].
const NOTHING: f64 = 0.05;
const LITTLE: f64 = 0.3;
/// What a step must promise for sensitivities to the nominal parameters to be taken anew.
const WORTH: f64 = 2.0;
/// Shares of a step that are tried.
const SHARES: [f64; 4] = [1.0, 0.5, 0.2, 0.04];
/// Longest step of a logarithm.
const FARTHEST: f64 = 1.0;

/// A set fitted to all logs.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub(super) effects: Effects,
    pub(super) parameters: Vec<Parameter>,
    /// Which parameters are each log's own.
    pub(super) own: Vec<bool>,
    /// Where each log stands.
    pub(super) points: Vec<Point>,
    /// Square of each log's residual over its temper, and half of it piece by piece.
    pub(super) squares: Vec<f64>,
    /// What the priors cost there, twice in nats as the squares.
    pub(super) prior: f64,
    pub(super) pieces: Vec<Vec<f64>>,
    /// The logs' parabolas there, and their least.
    pub(super) locals: Vec<Local>,
    pub(super) joint: Joint,
    /// Logarithm of the evidence, up to what all fits share [nats].
    pub(super) evidence: f64,
}

/// All logs under one set.
struct Climb<'a> {
    materials: &'a [Material<'a>],
    hypotheses: Vec<Hypothesis<'a>>,
    linears: Vec<Linear<'a>>,
    parameters: Vec<Parameter>,
    own: &'a [bool],
}

/// Fits a set from points of each log, the values that are shared equal among them; of
/// several such points, from those of least cost.
pub(super) fn climb(
    materials: &[Material],
    effects: &Effects,
    own: &[bool],
    starts: Vec<Vec<Point>>,
) -> Option<Fitted> {
    let hypotheses = hypotheses(materials, effects);
    let parameters = parameters(hypotheses.first()?);
    let linears = materials.iter().map(|material| Linear::of(&material.problem)).collect();
    let mut climb = Climb { materials, hypotheses, linears, parameters, own };
    let (points, outcomes) = climb.up(climb.cheapest(starts)?)?;
    let locals = climb.locals(&points, &outcomes, |log, _| materials[log].asked.temper);
    let joint = solve(&locals, &climb.parameters, own)?;
    let squares: Vec<f64> =
        outcomes.iter().zip(materials).map(|(outcome, material)| outcome.square / material.asked.temper).collect();
    let x = climb.coordinates(&points);
    let search = effects.searched(own, &climb.parameters, materials.len());
    let prior = climb.prior(&x);
    let evidence = -0.5 * (squares.iter().sum::<f64>() + prior) + joint.volume - search;
    let half = |(outcome, material): (&Outcome, &Material)| {
        pieces(&outcome.residual).iter().map(|piece| piece / material.asked.temper).collect()
    };
    let pieces = outcomes.iter().zip(materials).map(half).collect();
    let parameters = climb.parameters;
    let effects = effects.clone();
    Some(Fitted { effects, parameters, own: own.to_vec(), points, squares, prior, pieces, locals, joint, evidence })
}

/// The set in every log.
pub(super) fn hypotheses<'a>(materials: &'a [Material], effects: &'a Effects) -> Vec<Hypothesis<'a>> {
    let both = materials.iter().zip(&effects.sets);
    both.map(|(material, set)| Hypothesis::new(&material.problem, set, &effects.start)).collect()
}

impl Climb<'_> {
    /// Points of least cost, under the noise of each log's own fit.
    fn cheapest(&self, mut starts: Vec<Vec<Point>>) -> Option<Vec<Point>> {
        if starts.len() < 2 {
            return starts.pop();
        }
        let tempers: Vec<f64> = self.materials.iter().map(|material| material.asked.temper).collect();
        let cost = |points: &Vec<Point>| self.cost(points, &self.evaluated(points), &tempers);
        let costs: Vec<f64> = starts.iter().map(cost).collect();
        let best = (0..starts.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b]))?;
        Some(starts.swap_remove(best))
    }

    /// From points to where nothing falls any more.
    fn up(&mut self, mut points: Vec<Point>) -> Option<(Vec<Point>, Vec<Outcome>)> {
        let mut outcomes = self.evaluated(&points);
        let mut fresh = false;
        for _ in 0..ITERATIONS {
            let locals = self.locals(&points, &outcomes, |log, square| {
                linearised(&self.materials[log].problem, square).max(self.materials[log].asked.temper)
            });
            let tempers: Vec<f64> = locals.iter().map(|local| local.temper).collect();
            let cost = self.cost(&points, &outcomes, &tempers);
            let joint = solve(&locals, &self.parameters, self.own)?;
            let promised = cost - joint.cost;
            if promised < NOTHING {
                break;
            }
            let steps: Vec<DVector<f64>> = joint.x.iter().zip(&locals).map(|(to, local)| to - &local.at).collect();
            let most = self.most(&steps);
            let tried = SHARES.iter().find_map(|share| {
                let next: Vec<Point> = (0..points.len())
                    .map(|log| {
                        placed(&self.hypotheses[log], &points[log], &(&locals[log].at + share * most * &steps[log]))
                    })
                    .collect();
                let outcomes = self.evaluated(&next);
                let gained = cost - self.cost(&next, &outcomes, &tempers);
                (gained > 0.0).then_some((next, outcomes, gained))
            });
            match tried {
                Some((next, next_outcomes, gained)) => {
                    (points, outcomes) = (next, next_outcomes);
                    if gained < 0.5 * promised && promised > 2.0 * WORTH && !fresh {
                        self.refresh(&points, &outcomes);
                        fresh = true;
                    } else if gained < LITTLE {
                        break;
                    }
                }
                None if !fresh && promised > WORTH => {
                    self.refresh(&points, &outcomes);
                    fresh = true;
                }
                None => break,
            }
        }
        Some((points, outcomes))
    }

    /// Sensitivities to the beginning and the nominal parameters where the logs stand.
    fn refresh(&mut self, points: &[Point], outcomes: &[Outcome]) {
        self.linears = self
            .hypotheses
            .iter()
            .zip(points)
            .zip(outcomes)
            .map(|((hypothesis, point), outcome)| Linear::fresh(hypothesis, point, &outcome.prediction))
            .collect();
    }

    fn evaluated(&self, points: &[Point]) -> Vec<Outcome> {
        self.hypotheses.par_iter().zip(points).map(|(hypothesis, point)| hypothesis.evaluate(point)).collect()
    }

    /// The parabola of each log about where it stands.
    fn locals(&self, points: &[Point], outcomes: &[Outcome], temper: impl Fn(usize, f64) -> f64 + Sync) -> Vec<Local> {
        let local = |log: usize| {
            let (hypothesis, point, outcome) = (&self.hypotheses[log], &points[log], &outcomes[log]);
            let sensitivities = hypothesis.sensitivities(point, &outcome.prediction);
            let (gram, drive) = self.linears[log].joined(&sensitivities, &outcome.residual);
            let begin = hypothesis.precision[..point.state.len()].to_vec();
            let square = outcome.square;
            Local::new(coordinates(hypothesis, point), begin, gram, &drive, square, temper(log, square))
        };
        (0..points.len()).into_par_iter().map(local).collect()
    }

    fn coordinates(&self, points: &[Point]) -> Vec<DVector<f64>> {
        self.hypotheses.iter().zip(points).map(|(hypothesis, point)| coordinates(hypothesis, point)).collect()
    }

    fn prior(&self, x: &[DVector<f64>]) -> f64 {
        let begins: Vec<&[f64]> = self
            .hypotheses
            .iter()
            .map(|hypothesis| &hypothesis.precision[..hypothesis.problem.columns.begin])
            .collect();
        prior_cost(x, &begins, &self.parameters, self.own)
    }

    fn cost(&self, points: &[Point], outcomes: &[Outcome], tempers: &[f64]) -> f64 {
        let squares: f64 = outcomes.iter().zip(tempers).map(|(outcome, temper)| outcome.square / temper).sum();
        squares + self.prior(&self.coordinates(points))
    }

    /// Share of steps that no logarithm goes too far with.
    fn most(&self, steps: &[DVector<f64>]) -> f64 {
        let mut farthest: f64 = FARTHEST;
        for (hypothesis, step) in self.hypotheses.iter().zip(steps) {
            let fixed = hypothesis.fixed();
            for (place, _) in hypothesis.free.iter().enumerate().filter(|(_, free)| free.log) {
                farthest = farthest.max(step[fixed + place].abs());
            }
        }
        FARTHEST / farthest
    }
}

/// The point at coordinates, nominal parameters no further than they may go.
pub(super) fn placed(hypothesis: &Hypothesis, from: &Point, x: &DVector<f64>) -> Point {
    let (begin, fixed) = (from.state.len(), hypothesis.fixed());
    let mut point = from.clone();
    for (place, state) in point.state.iter_mut().enumerate() {
        *state = x[place];
    }
    for ((place, shift), limit) in point.shifts.iter_mut().enumerate().zip(&hypothesis.limits) {
        *shift = x[begin + place].clamp(-limit, *limit);
    }
    for (place, free) in hypothesis.free.iter().enumerate() {
        let value = x[fixed + place];
        point.values[free.effect][free.value] = match free {
            Free { log: true, .. } => value.exp(),
            Free { goes: Goes::Within, .. } => value.clamp(-1.0, 1.0),
            Free { .. } => value,
        };
    }
    point
}

/// Beginning, shifts, free values of a point.
pub(super) fn coordinates(hypothesis: &Hypothesis, point: &Point) -> DVector<f64> {
    let values = hypothesis.free.iter().map(|free| {
        let value = point.values[free.effect][free.value];
        if free.log { value.ln() } else { value }
    });
    DVector::from_iterator(
        hypothesis.fixed() + hypothesis.free.len(),
        point.state.iter().chain(&point.shifts).copied().chain(values),
    )
}
